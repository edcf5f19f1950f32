#include "viewer/debugger/line.hpp"

#include <fmt/format.h>

#include <fmt/ranges.h>
#include <cctype>

#include <algorithm>

#include "engine/core/error.hpp"
#include "viewer/debugger/line_words.hpp"
#include "viewer/debugger/panel_line.hpp"
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
  want(words, 1, 2, verb == "step" ? "step [N]" : "back [N]");
  return TransportLine{verb == "step" ? TransportLine::step : TransportLine::back,
                       words.size() == 2 ? static_cast<int>(number(words[1], 1, 1e7, true)) : 1};
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
      std::vector<std::string> bodies;
      for (const BodyRecord& body : names.record.bodies) bodies.emplace_back(body.name);
      s.kind = Selection::body;
      s.index = static_cast<int>(find(words[2], "body", bodies));
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
  const std::vector<std::string> own = {"step",  "back", "seek", "play",  "pause", "select",
                                        "panel", "ui",   "shot", "plots", "quit"};
  std::vector<std::string> verbs = command_verbs();
  const std::size_t commands = verbs.size();
  verbs.insert(verbs.end(), own.begin(), own.end());
  std::size_t verb = find(words[0], "command", verbs);
  if (verb < commands) return parse_command(words, names.rows, false);
  verb -= commands;
  if (verb < 5) return parse_transport(words);
  if (verb == 5) return parse_select(words, names);
  if (verb == 6) return parse_panel(line, words, names.rows, names.figures);
  if (verb == 7) return parse_input(line, words);
  if (verb == 10) return want(words, 1, 1, "quit"), QuitLine{};
  const bool is_shot = verb == 8;
  const std::string ending = is_shot ? ".png" : ".csv";
  want(words, 2, 2, is_shot ? "shot FILE" : "plots FILE");
  if (!words[1].text.ends_with(ending))
    words[1].refuse(fmt::format("'{}'", words[1].text), fmt::format("a file name that ends in {} is wanted", ending),
                    "add " + ending);
  return FileLine{is_shot ? FileLine::shot : FileLine::plots, std::string(words[1].text)};
}

}  // namespace impinge
