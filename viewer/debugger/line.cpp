#include "viewer/debugger/line.hpp"

#include <fmt/format.h>

#include <fmt/ranges.h>
#include <cctype>

#include <algorithm>

#include "engine/core/error.hpp"
#include "viewer/panels/debug/panel.hpp"

namespace impinge {
namespace {

using LineWords = std::span<const PlacedText>;

std::string remedy(std::string_view word, const std::vector<std::string>& names) {
  const std::string near = nearest_word(std::string(word), names);
  return near.empty() ? "use one of them" : fmt::format("did you mean '{}'?", near);
}

std::size_t find(const PlacedText& word, const char* what, const std::vector<std::string>& names) {
  const auto it = std::find(names.begin(), names.end(), word.text);
  if (it == names.end())
    word.refuse(fmt::format("unknown {} '{}'", what, word.text), fmt::format("allowed: {}", fmt::join(names, ", ")),
                remedy(word.text, names));
  return static_cast<std::size_t>(it - names.begin());
}

void want(LineWords words, std::size_t least, std::size_t most, const char* usage) {
  if (words.size() >= least && words.size() <= most) return;
  words[0].refuse(
      fmt::format("'{}' with {} word{} after it", words[0].text, words.size() - 1, words.size() == 2 ? "" : "s"),
      fmt::format("{} is wanted", usage), "mend the line");
}

double number(const PlacedText& word, double low, double high, bool whole = false) {
  Parameter row;
  row.path = "number";
  row.kind = whole ? ParameterKind::integer : ParameterKind::real;
  row.range = {low, high};
  try {
    const ParameterValue value = parse_value(row, word.text);
    return whole ? static_cast<double>(std::get<std::int64_t>(value)) : std::get<double>(value);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}; change it", word.place(), error.what()));
  }
}

/// Everything after the first `skip` words, as it was written.
std::string rest(const PlacedText& line, LineWords words, std::size_t skip) {
  if (words.size() <= skip) return "";
  return std::string(words[skip].text.data(),
                     static_cast<std::size_t>(line.text.data() + line.text.size() - words[skip].text.data()));
}

DebugLine parse_transport(LineWords words) {
  const std::string_view verb = words[0].text;
  if (verb == "play" || verb == "pause") {
    want(words, 1, 1, verb == "play" ? "play" : "pause");
    return TransportLine{verb == "play" ? TransportLine::play : TransportLine::pause, 0};
  }
  if (verb == "seek") {
    want(words, 2, 2, "seek FRAME");
    return TransportLine{TransportLine::seek, static_cast<int>(number(words[1], 0, 1e7, true))};
  }
  const char* usage = verb == "step" ? "step [stage|substep] [N]" : "back [stage|substep] [N]";
  TransportLine line{verb == "step" ? TransportLine::step : TransportLine::back, 1, TransportLine::frame};
  std::size_t n = 1;
  if (words.size() > 1 && std::isalpha(static_cast<unsigned char>(words[1].text[0])) != 0)
    line.unit = find(words[n++], "unit", {"substep", "stage"}) == 0 ? TransportLine::substep : TransportLine::stage;
  want(words, n, n + 1, usage);
  if (words.size() > n) line.frames = static_cast<int>(number(words[n], 1, 1e7, true));
  return line;
}

/// The words from the n-th on, as they stand in the line.
PlacedText from_word(const PlacedText& line, LineWords words, std::size_t n) {
  return line.part(static_cast<std::size_t>(words[n].text.data() - line.text.data()));
}

DebugLine parse_break(const PlacedText& line, LineWords words, const DebugNames& names) {
  const char* usage = "break when CONDITION or break off";
  want(words, 2, 1000, usage);
  if (find(words[1], "word", {"when", "off"}) == 1) return want(words, 2, 2, usage), BreakLine{};
  want(words, 3, 1000, usage);
  return BreakLine{Expression(from_word(line, words, 2), names.conditions), words[0].place()};
}

std::vector<std::string> body_names(const DebugNames& names) {
  std::vector<std::string> bodies;
  for (const BodyRecord& body : names.record.bodies) bodies.emplace_back(body.name);
  return bodies;
}

DebugLine parse_select(LineWords words, const DebugNames& names) {
  const char* usage = "select body NAME [TRIANGLE], select contact INDEX or select none";
  want(words, 2, 4, usage);
  Selection s;
  switch (find(words[1], "kind", {"none", "body", "contact"})) {
    case 0:
      want(words, 2, 2, usage);
      break;
    case 1: {
      want(words, 3, 4, usage);
      s.kind = Selection::body;
      s.index = static_cast<int>(find(words[2], "body", body_names(names)));
      if (words.size() == 4) s.triangle = static_cast<int>(number(words[3], 0, 1e9, true));
      break;
    }
    default:
      want(words, 3, 3, usage);
      s.kind = Selection::contact;
      s.index = static_cast<int>(number(words[2], 0, 1e9, true));
      if (s.index >= static_cast<int>(names.record.contacts.size()))
        words[2].refuse(fmt::format("contact {}", s.index),
                        fmt::format("frame {} has {} contacts, counted from 0", names.record.stats.frame,
                                    names.record.contacts.size()),
                        "choose another");
  }
  return SelectLine{s};
}

DebugLine parse_panel(const PlacedText& line, LineWords words, const DebugNames& names) {
  want(words, 2, 64, "panel sort|fold|unfold|plot|filter|scroll|help ...");
  PanelLine p;
  p.verb = static_cast<PanelLine::Verb>(
      find(words[1], "panel command", {"sort", "fold", "unfold", "plot", "filter", "scroll", "help"}));
  switch (p.verb) {
    case PanelLine::sort:
      want(words, 3, 4, "panel sort COLUMN [down]");
      p.name = contact_columns()[find(words[2], "column", contact_columns())];
      p.on = words.size() == 4 && find(words[3], "direction", {"up", "down"}) == 1;
      break;
    case PanelLine::fold:
    case PanelLine::unfold: {
      want(words, 3, 3, "panel fold GROUP");
      std::vector<std::string> groups;
      for (const Parameter& row : names.rows.all())
        if (std::string group = row.path.substr(0, row.path.rfind('.'));
            std::find(groups.begin(), groups.end(), group) == groups.end())
          groups.push_back(std::move(group));
      p.name = groups[find(words[2], "group", groups)];
      break;
    }
    case PanelLine::plot:
      for (const PlacedText& word : words.subspan(2)) {
        if (word.text[0] != '+' && word.text[0] != '-')
          word.refuse(fmt::format("'{}'", word.text), "+COLUMN or -COLUMN is wanted", "put + or - before the name");
        p.columns.emplace_back(names.figures[find(word.part(1), "column", names.figures)], word.text[0] == '+');
      }
      break;
    case PanelLine::filter:
      p.name = rest(line, words, 2);
      break;
    case PanelLine::scroll:
      want(words, 4, 4, "panel scroll PANEL PIXELS");
      p.name = std::string(words[2].text);
      find(words[2], "panel", panel_names());
      p.pixels = static_cast<float>(number(words[3], 0, 1e7));
      break;
    case PanelLine::help:
      want(words, 3, 3, "panel help on|off");
      p.on = find(words[2], "word", {"off", "on"}) == 1;
  }
  return p;
}

DebugLine parse_input(const PlacedText& line, LineWords words) {
  want(words, 2, 64, "ui click|drag|move|press|release|wheel|key|text|wait ...");
  InputLine i;
  i.verb = static_cast<InputLine::Verb>(
      find(words[1], "input", {"click", "drag", "move", "press", "release", "wheel", "key", "text", "wait"}));
  switch (i.verb) {
    case InputLine::click:
      want(words, 3, 3, "ui click NAME");
      i.name = std::string(words[2].text);
      break;
    case InputLine::drag:
      want(words, 4, 4, "ui drag NAME VALUE");
      i.name = std::string(words[2].text);
      i.x = number(words[3], -1e15, 1e15);
      break;
    case InputLine::move:
      want(words, 4, 4, "ui move X Y");
      i.x = number(words[2], -1e5, 1e5);
      i.y = number(words[3], -1e5, 1e5);
      break;
    case InputLine::press:
    case InputLine::release:
      want(words, 3, 3, "ui press left|right|middle");
      i.name = button_names()[find(words[2], "button", button_names())];
      break;
    case InputLine::wheel:
      want(words, 3, 3, "ui wheel STEPS");
      i.y = number(words[2], -1000, 1000);
      break;
    case InputLine::key: {
      want(words, 3, 3, "ui key NAME");
      std::string low(words[2].text);
      std::transform(low.begin(), low.end(), low.begin(),
                     [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
      const bool known = std::find(key_names().begin(), key_names().end(), low) != key_names().end();
      i.name = known ? low : key_names()[find(words[2], "key", key_names())];
      break;
    }
    case InputLine::wait:
      want(words, 3, 3, "ui wait FRAMES");
      i.x = number(words[2], 1, 1e6, true);
      break;
    case InputLine::type:
      if (words.size() < 3) words[0].refuse("'ui text' without a text", "ui text WORDS is wanted", "mend the line");
      i.name = rest(line, words, 2);
  }
  return i;
}

}  // namespace

DebugLine parse_debug_line(const PlacedText& line, const DebugNames& names) {
  const std::vector<PlacedText> all = split_words(line);
  const LineWords words(all);
  if (words.empty()) line.refuse("an empty line", "a command is wanted", "write one");
  const std::vector<std::string> verbs = {"set",  "layer", "camera", "step",   "back", "seek",
                                          "play", "pause", "select", "panel",  "ui",   "shot",
                                          "quit", "break", "find",   "freeze", "why"};
  const std::size_t verb = find(words[0], "command", verbs);
  if (verb < 3) return parse_command(words, names.rows, false);
  if (verb < 8) return parse_transport(words);
  if (verb == 8) return parse_select(words, names);
  if (verb == 9) return parse_panel(line, words, names);
  if (verb == 10) return parse_input(line, words);
  if (verb == 12) return want(words, 1, 1, "quit"), QuitLine{};
  if (verb == 13) return parse_break(line, words, names);
  if (verb == 14) {
    want(words, 2, 1000, "find CONDITION");
    return FindLine{Expression(from_word(line, words, 1), names.conditions)};
  }
  if (verb == 16) {
    want(words, 3, 3, "why NAME NAME");
    const std::vector<std::string> bodies = body_names(names);
    return WhyLine{static_cast<int>(find(words[1], "body", bodies)), static_cast<int>(find(words[2], "body", bodies))};
  }
  if (verb == 15) {
    want(words, 2, 2, "freeze FILE");
    if (!words[1].text.ends_with(".step"))
      words[1].refuse(fmt::format("'{}'", words[1].text), "a file name that ends in .step is wanted", "add .step");
    return FreezeLine{std::string(words[1].text)};
  }
  want(words, 2, 2, "shot FILE");
  if (!words[1].text.ends_with(".png"))
    words[1].refuse(fmt::format("'{}'", words[1].text), "a file name that ends in .png is wanted", "add .png");
  return ShotLine{std::string(words[1].text)};
}

void take(const PanelLine& line, PanelState& p) {
  switch (line.verb) {
    case PanelLine::sort:
      p.sort = line.name, p.descending = line.on;
      break;
    case PanelLine::fold:
      p.folded.insert(line.name);
      break;
    case PanelLine::unfold:
      p.folded.erase(line.name);
      break;
    case PanelLine::plot:
      for (const auto& [column, on] : line.columns) {
        std::erase(p.plots, column);
        if (on) p.plots.push_back(column);
      }
      break;
    case PanelLine::filter:
      p.filter = line.name;
      break;
    case PanelLine::scroll:
      p.scroll[line.name] = line.pixels;
      break;
    case PanelLine::help:
      p.help = line.on;
  }
}

}  // namespace impinge
