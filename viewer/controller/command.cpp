#include "viewer/controller/command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "engine/core/error.hpp"
#include "viewer/controller/act_command.hpp"
#include "viewer/draw/body_color.hpp"

namespace impinge {

namespace {

struct VerbRow {
  const char* name;
  int numbers;
  double low, high;
  const char* usage;
};
constexpr VerbRow kVerbs[] = {
    {"eye", 3, -1e9, 1e9, "camera eye X Y Z"},
    {"target", 3, -1e9, 1e9, "camera target X Y Z"},
    {"orbit", 2, -36000, 36000, "camera orbit YAW PITCH (degrees)"},
    {"pan", 2, -1e6, 1e6, "camera pan X Y"},
    {"zoom", 1, 1e-3, 1e3, "camera zoom FACTOR"},
    {"fov", 1, 1, 170, "camera fov DEGREES"},
    {"fit", 0, 0, 0, "camera fit"},
};

constexpr const char* kBodyVerbs[] = {"hide", "isolate", "show", "lock", "unlock", "frame", "follow", "color"};

/// Rows whose texts are names of bodies.
bool names_bodies(const std::string& path) {
  return path == "view.hidden" || path == "view.locked" || path == "view.camera.follow" || path == "view.colors";
}

std::string remedy(const std::string& near, const char* otherwise) {
  return near.empty() ? otherwise : fmt::format("did you mean '{}'?", near);
}

void check_bodies(const PlacedText& word, const std::string& path, const ParameterValue& value,
                  const ParameterSet& rows) {
  const std::vector<std::string> bodies = body_names(rows);
  if (const auto* one = std::get_if<std::string>(&value); one != nullptr && !one->empty())
    check_body(word, *one, bodies);
  if (const auto* several = std::get_if<std::vector<std::string>>(&value))
    for (const std::string& entry : *several) {
      check_body(word, name_in(entry), bodies);
      if (path == "view.colors" && !color_in(entry))
        word.refuse(fmt::format("'{}'", entry), "NAME=rrggbb is wanted", "write \"ball=e07020\", say");
    }
}

std::vector<Command> parse_set(std::span<const PlacedText> words, const ParameterSet& rows, bool first_frame) {
  if (words.size() < 3)
    words[0].refuse("'set' without a path and a value", "set PATH VALUE is wanted", "write set contact.friction 0.5");
  std::vector<Command> commands;
  const PlacedText& first = words[2];
  const char* end = words.back().text.data() + words.back().text.size();
  const std::string_view text(first.text.data(), static_cast<std::size_t>(end - first.text.data()));
  for (const Parameter* row : find_rows(words[1], rows, first_frame)) try {
      SetCommand set{row->path, parse_value(*row, text), first.place()};
      commands.emplace_back(std::move(set));
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: {}; change the value", first.place(), error.what()));
    }
  for (const Command& command : commands)
    if (const auto& set = std::get<SetCommand>(command); names_bodies(set.path))
      check_bodies(first, set.path, set.value, rows);
  return commands;
}

Command parse_bodies(std::span<const PlacedText> words, const ParameterSet& rows) {
  const auto verb = static_cast<BodiesCommand::Verb>(
      std::find(std::begin(kBodyVerbs), std::end(kBodyVerbs), words[0].text) - std::begin(kBodyVerbs));
  const bool takes_all = verb == BodiesCommand::show || verb == BodiesCommand::unlock,
             is_follow = verb == BodiesCommand::follow, is_color = verb == BodiesCommand::color;
  const std::string usage = fmt::format("{} NAME{}", words[0].text,
                                        is_follow   ? "|none"
                                        : takes_all ? "...|all"
                                        : is_color  ? "... RRGGBB|none"
                                                    : "...");
  if (words.size() < 2)
    words[0].refuse(fmt::format("'{}' without a body", words[0].text), fmt::format("{} is wanted", usage),
                    "add a body's name");
  if (is_follow && words.size() > 2)
    words[2].refuse(fmt::format("'{}' after the body", words[2].text), "one body can be followed",
                    "name that one alone");
  BodiesCommand command{verb, {}};
  if (words.size() == 2 && ((takes_all && words[1].text == "all") || (is_follow && words[1].text == "none")))
    return command;
  if (is_color) {
    const PlacedText& last = words.back();
    command.rgb = read_color(last.text);
    if (!command.rgb && last.text != "none")
      last.refuse(fmt::format("'{}' for a colour", last.text), fmt::format("{} is wanted", usage),
                  "end the line with e07020, say");
    if (words.size() < 3)
      last.refuse("'color' without a body", fmt::format("{} is wanted", usage), "add a body's name");
  }
  const std::vector<std::string> bodies = body_names(rows);
  for (const PlacedText& word : words.subspan(1, words.size() - (is_color ? 2 : 1))) {
    check_body(word, word.text, bodies);
    command.names.emplace_back(word.text);
  }
  return command;
}

Command parse_layer(std::span<const PlacedText> words, const ParameterSet& rows) {
  if (words.size() < 2)
    words[0].refuse("'layer' without a name", "layer +NAME -NAME ... is wanted", "write layer +contacts");
  const Parameter* row = rows.find("view.layers");
  if (row == nullptr) words[0].refuse("'layer' where nothing is drawn", "the other commands are allowed", "remove it");
  LayerCommand command;
  for (const PlacedText& word : words.subspan(1)) {
    const char sign = word.text[0];
    if (sign != '+' && sign != '-')
      word.refuse(fmt::format("'{}'", word.text), "+NAME or -NAME is wanted", "put + or - before the name");
    const std::string name(word.text.substr(1));
    if (std::find(row->names.begin(), row->names.end(), name) == row->names.end())
      word.part(1).refuse(fmt::format("unknown layer '{}'", name),
                          fmt::format("allowed: {}", fmt::join(row->names, ", ")),
                          remedy(nearest_word(name, row->names), "use one of them"));
    command.changes.emplace_back(name, sign == '+');
  }
  return command;
}

Command parse_camera(std::span<const PlacedText> words) {
  std::vector<std::string> names;
  for (const VerbRow& row : kVerbs) names.emplace_back(row.name);
  if (words.size() < 2)
    words[0].refuse("'camera' without a verb", fmt::format("allowed: {}", fmt::join(names, ", ")),
                    "write camera orbit 30 0");
  const auto it = std::find(names.begin(), names.end(), words[1].text);
  if (it == names.end())
    words[1].refuse(fmt::format("unknown camera verb '{}'", words[1].text),
                    fmt::format("allowed: {}", fmt::join(names, ", ")),
                    remedy(nearest_word(words[1].text, names), "use one of them"));
  const VerbRow& verb = kVerbs[it - names.begin()];
  CameraCommand command{static_cast<CameraCommand::Verb>(it - names.begin())};
  // numbers may also stand as one bracketed list
  std::vector<PlacedText> numbers(words.begin() + 2, words.end());
  if (numbers.size() == 1 && numbers[0].text.front() == '[') {
    std::string_view inner = numbers[0].text;
    std::vector<PlacedText> parts;
    for (std::size_t begin = 1; begin < inner.size();) {
      const std::size_t end = std::min(inner.find_first_of(",]", begin), inner.size());
      const std::size_t first = inner.find_first_not_of(' ', begin);
      parts.push_back(numbers[0].part(std::min(first, end), end - std::min(first, end)));
      begin = end + 1;
    }
    numbers = std::move(parts);
  }
  if (numbers.size() != static_cast<std::size_t>(verb.numbers))
    words[1].refuse(fmt::format("'camera {}' with {} numbers", verb.name, numbers.size()),
                    fmt::format("{} is wanted", verb.usage), "mend the line");
  Parameter row;
  row.path = fmt::format("camera {}", verb.name);
  row.range = {verb.low, verb.high};
  for (int i = 0; i < verb.numbers; ++i) {
    try {
      command.value[i] = std::get<double>(parse_value(row, numbers[i].text));
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: {}; change it", numbers[i].place(), error.what()));
    }
  }
  return command;
}

struct Formatter {
  std::string operator()(const SetCommand& c) const { return fmt::format("set {} {}", c.path, format_value(c.value)); }
  std::string operator()(const LayerCommand& c) const {
    std::string text = "layer";
    for (const auto& [name, on] : c.changes) text += fmt::format(" {}{}", on ? '+' : '-', name);
    return text;
  }
  std::string operator()(const CameraCommand& c) const {
    const VerbRow& verb = kVerbs[c.verb];
    std::string text = fmt::format("camera {}", verb.name);
    for (int i = 0; i < verb.numbers; ++i) text += " " + shortest(c.value[i]);
    return text;
  }
  std::string operator()(const BodiesCommand& c) const {
    if (c.names.empty())
      return fmt::format("{} {}", kBodyVerbs[c.verb], c.verb == BodiesCommand::follow ? "none" : "all");
    const std::string text = fmt::format("{} {}", kBodyVerbs[c.verb], fmt::join(c.names, " "));
    if (c.verb != BodiesCommand::color) return text;
    return text + " " + (c.rgb ? color_text(*c.rgb) : "none");
  }
  std::string operator()(const Act& act) const { return format_act(act); }
};

}  // namespace

void check_body(const PlacedText& word, std::string_view name, const std::vector<std::string>& bodies) {
  if (std::find(bodies.begin(), bodies.end(), name) != bodies.end()) return;
  word.refuse(fmt::format("unknown body '{}'", name), fmt::format("bodies: {}", some_of(bodies)),
              remedy(nearest_word(name, bodies), "use one of them"));
}

const std::vector<std::string>& debugger_verbs() {
  static const std::vector<std::string> kVerbs = {"step", "back",   "seek",  "play", "pause", "select", "panel",
                                                  "ui",   "shot",   "plots", "quit", "break", "find",   "freeze",
                                                  "why",  "bundle", "undo",  "redo", "export"};
  return kVerbs;
}

bool is_debugger_verb(std::string_view word) {
  return std::find(debugger_verbs().begin(), debugger_verbs().end(), word) != debugger_verbs().end();
}

const std::vector<std::string>& command_verbs() {
  static const std::vector<std::string> verbs = [] {
    std::vector<std::string> all = {"set", "layer", "camera"};
    all.insert(all.end(), std::begin(kBodyVerbs), std::end(kBodyVerbs));
    all.insert(all.end(), act_verbs().begin(), act_verbs().end());
    return all;
  }();
  return verbs;
}

std::vector<std::string> body_names(const ParameterSet& rows) {
  std::vector<std::string> names;
  constexpr std::string_view kBegin = "body.", kEnd = ".friction";  // which every body has
  for (const Parameter& row : rows.all()) {
    if (!row.path.starts_with(kBegin) || !row.path.ends_with(kEnd)) continue;
    std::string name = row.path.substr(kBegin.size(), row.path.size() - kBegin.size() - kEnd.size());
    if (name.find('.') == std::string::npos) names.push_back(std::move(name));
  }
  return names;
}

/// Of a body that is there a key that only other bodies have: no other body's is meant.
void refuse_key_of_body(const PlacedText& word, const ParameterSet& rows) {
  const std::size_t end = word.text.starts_with("body.") ? word.text.find('.', 5) : std::string_view::npos;
  if (end == std::string_view::npos) return;
  const std::string_view body = word.text.substr(0, end + 1), key = word.text.substr(end);
  std::vector<std::string> keys;
  bool others_have_it = false;
  for (const Parameter& row : rows.all()) {
    if (row.path.starts_with(body)) keys.push_back(row.path.substr(body.size()));
    others_have_it |= row.path.starts_with("body.") && row.path.find('.', 5) != std::string::npos &&
                      std::string_view(row.path).substr(row.path.find('.', 5)) == key;
  }
  if (keys.empty() || !others_have_it) return;
  word.refuse(
      fmt::format("'{}' has no {}, as bodies of other kinds do", body.substr(5, body.size() - 6), key.substr(1)),
      fmt::format("it has {}", fmt::join(keys, ", ")), "name one of them, or another body");
}

/// Of a body that is there but has no place or velocity to set: what changes these all the same.
bool is_motion_of_body(std::string_view path, const ParameterSet& rows) {
  const std::size_t end = path.starts_with("body.") ? path.find('.', 5) : std::string_view::npos;
  if (end == std::string_view::npos || (path.substr(end) != ".velocity" && path.substr(end) != ".position"))
    return false;
  return rows.find(std::string(path.substr(0, end)) + ".friction") != nullptr;
}

std::vector<const Parameter*> find_rows(const PlacedText& word, const ParameterSet& rows, bool first_frame) {
  const std::vector<std::string>* renamed = rows.renamed(word.text);
  std::vector<const Parameter*> found;
  for (const std::string& path : renamed == nullptr ? std::vector<std::string>{std::string(word.text)} : *renamed) {
    const Parameter* row = rows.find(path);
    if (row == nullptr) {
      refuse_key_of_body(word, rows);
      word.refuse(fmt::format("unknown parameter '{}'", word.text), "`impinge list parameters` shows what there is",
                  is_motion_of_body(word.text, rows) ? "what it does `move` and `push` change"
                                                     : remedy(rows.nearest(word.text), "use one of them"));
    }
    if (!row->set)
      word.refuse(fmt::format("'{}' can't change while running", word.text), "it is fixed with the scene",
                  "set it in the scene, or by --set");
    if (!row->live && !first_frame)
      word.refuse(fmt::format("'{}' can't change while running", word.text), "it may be set at frame 0",
                  "write at 0, or set it in the scene");
    found.push_back(row);
  }
  return found;
}

std::vector<Command> parse_command(std::span<const PlacedText> words, const ParameterSet& rows, bool first_frame) {
  const PlacedText& verb = words[0];
  if (verb.text == "set") return parse_set(words, rows, first_frame);
  if (verb.text == "layer") return {parse_layer(words, rows)};
  if (verb.text == "camera") return {parse_camera(words)};
  if (std::find(std::begin(kBodyVerbs), std::end(kBodyVerbs), verb.text) != std::end(kBodyVerbs))
    return {parse_bodies(words, rows)};
  if (std::find(act_verbs().begin(), act_verbs().end(), verb.text) != act_verbs().end())
    return {parse_act(words, rows)};
  verb.refuse(fmt::format("unknown command '{}'", verb.text),
              fmt::format("allowed: {}", fmt::join(command_verbs(), ", ")),
              remedy(nearest_word(verb.text, command_verbs()), "use one of them"));
}

std::string format_command(const Command& command) { return std::visit(Formatter{}, command); }

}  // namespace impinge
