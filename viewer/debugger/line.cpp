#include "viewer/debugger/line.hpp"

#include <fmt/format.h>

#include <fmt/ranges.h>
#include <cctype>

#include <algorithm>

#include "engine/core/error.hpp"
#include "viewer/debugger/line_words.hpp"
#include "viewer/debugger/panel_line.hpp"
#include "viewer/export/exporter.hpp"
#include "viewer/panels/debug/ui.hpp"

namespace impinge {
namespace {

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
      want(words, 4, 5, "ui move X Y [clicked]");
      if (words.size() == 5) i.has_clicked = find(words[4], "word", {"clicked"}) == 0;
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
      want(words, 3, 4, "ui key NAME [down|up]");
      if (words.size() == 4) (find(words[3], "way", {"down", "up"}) == 0 ? i.goes_up : i.goes_down) = false;
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

/// Of a script that somebody else wrote: it names files below --out and no others.
std::string below_out(const PlacedText& word) {
  const std::filesystem::path path = std::filesystem::path(word.text).lexically_normal();
  if (path.is_absolute())
    word.refuse(fmt::format("'{}', which is not below --out", word.text), "a path from --out on is wanted",
                "leave out the first /, and choose the folder by --out");
  if (path.begin() != path.end() && *path.begin() == "..")
    word.refuse(fmt::format("'{}', which leads out of --out", word.text), "a path below --out is wanted",
                "leave out the .., and choose the folder by --out");
  return std::string(word.text);
}

}  // namespace

DebugLine parse_debug_line(const PlacedText& line, const DebugNames& names) {
  const std::vector<PlacedText> all = split_words(line);
  const LineWords words(all);
  if (words.empty()) line.refuse("an empty line", "a command is wanted", "write one");
  const std::vector<std::string>& own = debugger_verbs();
  std::vector<std::string> verbs = command_verbs();
  const std::size_t commands = verbs.size();
  verbs.insert(verbs.end(), own.begin(), own.end());
  const std::size_t at = find(words[0], "command", verbs);
  if (at < commands) return parse_command(words, names.rows, false);
  const std::string& verb = verbs[at];
  if (at < commands + 5) return parse_transport(words);
  if (verb == "select") return parse_select(words, names);
  if (verb == "panel") return parse_panel(line, words, names.rows, names.figures);
  if (verb == "ui") return parse_input(line, words);
  if (verb == "undo" || verb == "redo") return want(words, 1, 1, verb.c_str()), UndoLine{verb == "redo"};
  if (verb == "quit") return want(words, 1, 1, "quit"), QuitLine{};
  if (verb == "break") return parse_break(line, words, names);
  if (verb == "find") {
    want(words, 2, 1000, "find CONDITION");
    return FindLine{Expression(from_word(line, words, 1), names.conditions)};
  }
  if (verb == "why") {
    want(words, 3, 3, "why NAME NAME");
    const std::vector<std::string> bodies = body_names(names);
    return WhyLine{static_cast<int>(find(words[1], "body", bodies)), static_cast<int>(find(words[2], "body", bodies))};
  }
  if (verb == "export") {
    want(words, 2, 3, "export FORMAT [FOLDER]");
    std::vector<std::string> formats;
    for (const Entry<Exporter>& e : exporters()) formats.emplace_back(e.name);
    find(words[1], "format", formats);
    return ExportLine{std::string(words[1].text), words.size() > 2 ? below_out(words[2]) : "export"};
  }
  const std::string ending = verb == "shot" ? ".png" : verb == "plots" ? ".csv" : verb == "bundle" ? ".tar" : ".step";
  want(words, 2, 2, (verb + " FILE").c_str());
  if (!words[1].text.ends_with(ending))
    words[1].refuse(fmt::format("'{}'", words[1].text), fmt::format("a file name that ends in {} is wanted", ending),
                    "add " + ending);
  const std::string file = below_out(words[1]);
  if (verb == "freeze") return FreezeLine{file};
  return FileLine{verb == "shot" ? FileLine::shot : verb == "plots" ? FileLine::plots : FileLine::bundle, file};
}

}  // namespace impinge
