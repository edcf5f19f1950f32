#include "viewer/controller/script.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

#include "engine/core/error.hpp"
#include "engine/core/utf8.hpp"
#include "engine/io/file.hpp"
#include "engine/io/paths.hpp"
#include "engine/io/standard_input.hpp"
#include "viewer/controller/act_command.hpp"

namespace impinge {

namespace {

constexpr int kMostFrames = 100'000'000;
constexpr std::uint64_t kMostBytes = 16u << 20;

// the value at fraction t of a ramp; exact at both ends
ParameterValue mix(const ParameterValue& from, const ParameterValue& to, double t) {
  if (t <= 0.0) return from;
  if (t >= 1.0) return to;
  const auto between = [t](double a, double b) { return a + (b - a) * t; };
  if (const auto* a = std::get_if<Vec3>(&from)) {
    const Vec3& b = std::get<Vec3>(to);
    return Vec3(between(a->x(), b.x()), between(a->y(), b.y()), between(a->z(), b.z()));
  }
  if (const auto* a = std::get_if<std::int64_t>(&from))
    return static_cast<std::int64_t>(std::llround(between(double(*a), double(std::get<std::int64_t>(to)))));
  return between(std::get<double>(from), std::get<double>(to));
}

// from the first word's start to the last word's end
PlacedText spanning(std::span<const PlacedText> words, const PlacedText& line) {
  const auto begin = static_cast<std::size_t>(words.front().text.data() - line.text.data());
  const auto end = static_cast<std::size_t>(words.back().text.data() + words.back().text.size() - line.text.data());
  return line.part(begin, end - begin);
}

std::string unquoted(std::string_view word) {
  if (word.size() >= 2 && (word.front() == '"' || word.front() == '\'') && word.back() == word.front())
    word = word.substr(1, word.size() - 2);
  return std::string(word);
}

}  // namespace

std::string_view without_comment(std::string_view line) {
  char quote = '\0';
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (quote != '\0')
      quote = c == quote ? '\0' : quote;
    else if (c == '"' || c == '\'')
      quote = c;
    else if (c == '#')
      return line.substr(0, i);
  }
  return line;
}

std::vector<std::string> read_lines(const std::filesystem::path& path) {
  const std::string file = path == "-" ? standard_input(kMostBytes) : read_file(path, kMostBytes);
  check_utf8(path.string(), file);
  const std::string_view text = without_byte_order_mark(file);
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    std::string line(text.substr(begin, end - begin));
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.size() > 8192)
      throw InputError(fmt::format("{}:{}:1: a line of {} bytes; at most 8192 are taken; shorten it", path.string(),
                                   lines.size() + 1, line.size()));
    if (const std::size_t bad = line.find('\0'); bad != std::string::npos)
      throw InputError(fmt::format("{}:{}:{}: a zero byte; a text file is wanted; check the path", path.string(),
                                   lines.size() + 1, bad + 1));
    lines.push_back(std::move(line));
    begin = end + 1;
  }
  return lines;
}

Script::Script(const std::string& name, const std::filesystem::path& folder, const std::vector<std::string>& lines,
               const ParameterSet& rows, const ExpressionWords& words, bool pictures_may_be_missing)
    : pictures_may_be_missing_(pictures_may_be_missing) {
  int number = 0;
  for (const std::string& line : lines) read_line({without_comment(line), &name, ++number, 1}, folder, rows, words);
}

int Script::read_frame(const PlacedText& word) {
  int frame = 0;
  const auto [end, error] = std::from_chars(word.text.data(), word.text.data() + word.text.size(), frame);
  if (error != std::errc() || end != word.text.data() + word.text.size() || frame < 0 || frame > kMostFrames)
    word.refuse(fmt::format("'{}'", word.text), fmt::format("a frame number from 0 to {} is wanted", kMostFrames),
                word.text.find("..") != std::string_view::npos ? "write from A to B for several frames" : "mend it");
  last_frame_ = std::max(last_frame_, frame);
  return frame;
}

std::pair<int, int> Script::read_frames(const PlacedText& first, const PlacedText& last, const char* what) {
  const std::pair<int, int> frames{read_frame(first), read_frame(last)};
  if (frames.second < frames.first)
    last.refuse(fmt::format("frame {} after frame {}", frames.second, frames.first),
                fmt::format("{} ends at or after its start", what), "swap the frames");
  return frames;
}

void Script::read_line(const PlacedText& line, const std::filesystem::path& folder, const ParameterSet& rows,
                       const ExpressionWords& conditions) {
  const std::vector<PlacedText> words = split_words(line);
  if (words.empty()) return;
  for (const PlacedText& word : words)
    if (rows.renamed(word.text) != nullptr) former_paths_.emplace_back(word.text);
  const PlacedText& first = words[0];
  if (first.text == "at") {
    if (words.size() < 3)
      first.refuse("'at' without a frame and a command", "at K COMMAND is wanted",
                   "write at 40 set contact.friction 0.5");
    const int frame = read_frame(words[1]);
    for (Command& command : parse_command(std::span(words).subspan(2), rows, frame == 0))
      timed_.push_back({frame, frame, std::move(command), false, {}, {}, line.line, words.back().place()});
    if (words.size() > 3)
      for (auto made = timed_.rbegin(); made != timed_.rend() && made->line == line.line; ++made)
        made->place = words[3].place();
  } else if (first.text == "from") {
    read_ramp(words, rows);
  } else if (first.text == "expect") {
    read_expect(line, words, folder, conditions);
  } else if (first.text == "break") {
    if (words.size() < 3 || words[1].text != "when")
      first.refuse("'break' without 'when' and a condition", "break when CONDITION is wanted",
                   "write break when contacts > 100");
    breaks_.push_back({Expression(spanning(std::span(words).subspan(2), line), conditions), first.place()});
  } else {
    const std::string near = nearest_word(first.text, {"at", "from", "expect", "break"});
    const bool command = std::find(command_verbs().begin(), command_verbs().end(), first.text) != command_verbs().end();
    first.refuse(fmt::format("'{}'", first.text), "a line starts with at, from, expect or break",
                 command ? "put 'at K' before it"
                 : is_debugger_verb(first.text)
                     ? fmt::format("'{}' is a line of impinge debug --script; leave it out", first.text)
                 : near.empty() ? "mend the line"
                                : fmt::format("did you mean '{}'?", near));
  }
}

void Script::read_ramp(std::span<const PlacedText> words, const ParameterSet& rows) {
  const char* usage = "from A to B ramp PATH VALUE VALUE is wanted";
  if (words.size() < 8) words[0].refuse("an incomplete ramp", usage, "write from 50 to 80 ramp contact.friction 0 0.8");
  if (words[2].text != "to") words[2].refuse(fmt::format("'{}'", words[2].text), usage, "write 'to' here");
  if (words[4].text != "ramp") words[4].refuse(fmt::format("'{}'", words[4].text), usage, "write 'ramp' here");
  const auto [first, last] = read_frames(words[1], words[3], "a ramp");
  const std::vector<const Parameter*> found = find_rows(words[5], rows, first == 0 && last == 0);
  const Parameter& row = *found.front();
  if (row.kind != ParameterKind::real && row.kind != ParameterKind::integer && row.kind != ParameterKind::vector3)
    words[5].refuse(fmt::format("'{}' is no number", row.path), "numbers and vectors can be ramped", "use set");
  // two values, or the six numbers of two vectors
  const std::span<const PlacedText> rest = words.subspan(6);
  const std::size_t each = row.kind == ParameterKind::vector3 && rest.size() == 6 ? 3 : 1;
  if (rest.size() != 2 * each)
    rest.back().refuse(fmt::format("{} values", rest.size()), "a ramp has two, vectors in brackets", "mend the line");
  const auto value = [&](std::size_t begin) {
    const char* end = rest[begin + each - 1].text.data() + rest[begin + each - 1].text.size();
    try {
      ParameterValue end_of_ramp =
          parse_value(row, {rest[begin].text.data(), static_cast<std::size_t>(end - rest[begin].text.data())});
      if (std::holds_alternative<std::string>(end_of_ramp))  // the word of a row that may be left open
        throw InputError(fmt::format("'{}' for {}; a ramp goes from number to number", rest[begin].text, row.path));
      return end_of_ramp;
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: {}; change the value", rest[begin].place(), error.what()));
    }
  };
  for (const Parameter* each_row : found)
    timed_.push_back({first, last, SetCommand{each_row->path, {}, rest[0].place()}, true, value(0), value(each),
                      words[5].line, words[5].place()});
}

void Script::read_expect(const PlacedText& line, std::span<const PlacedText> words, const std::filesystem::path& folder,
                         const ExpressionWords& conditions) {
  const std::size_t n = words.size();
  const bool is_range = n >= 6 && words[n - 4].text == "from" && words[n - 2].text == "to";
  if (is_range && words[1].text == "image")
    words[n - 4].refuse("frames of a picture", "expect image FILE [tolerance N] at K is wanted",
                        "write a line for each frame that has a picture");
  if (is_range) {
    const auto [first, last] = read_frames(words[n - 3], words[n - 1], "what is expected");
    expectations_.push_back(
        {first, last, Expression(spanning(words.subspan(1, n - 5), line), conditions), words[0].place()});
    return;
  }
  if (n < 4 || words[n - 2].text != "at")
    words[0].refuse("'expect' without 'at K' or 'from A to B' at its end",
                    "expect CONDITION at K, or from A to B, is wanted", "write expect contacts > 0 at 120");
  const int frame = read_frame(words[n - 1]);
  const std::span<const PlacedText> inner = words.subspan(1, n - 3);
  if (inner[0].text != "image") {
    expectations_.push_back({frame, frame, Expression(spanning(inner, line), conditions), words[0].place()});
    return;
  }
  if (inner.size() != 2 && !(inner.size() == 4 && inner[2].text == "tolerance"))
    inner[0].refuse("an incomplete 'expect image'", "expect image FILE [tolerance N] at K is wanted", "mend the line");
  ImageExpectation image{frame, folder / unquoted(inner[1].text), 3, words[0].place()};
  if (inner.size() == 4) {
    const std::string_view word = inner[3].text;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), image.tolerance);
    if (error != std::errc() || end != word.data() + word.size() || image.tolerance < 0 || image.tolerance > 255)
      inner[3].refuse(fmt::format("'{}'", word), "a tolerance from 0 to 255 is wanted", "write tolerance 3");
  }
  if (!pictures_may_be_missing_ && !is_file(image.file))
    inner[1].refuse(fmt::format("there is no file {}", image.file.string()),
                    "a PNG file relative to the script is wanted", "make the baseline, or check the path");
  images_.push_back(std::move(image));
}

void Script::check_bodies_are_there() const {
  using When = std::pair<int, std::size_t>;  // frame, and place among the lines
  std::map<std::string, When> deleted, added;
  for (std::size_t i = 0; i < timed_.size(); ++i) {
    const auto* act = std::get_if<Act>(&timed_[i].command);
    const When when(timed_[i].first, i);
    if (act != nullptr && act->verb == Act::add) added.emplace(act->body, when);
    if (act != nullptr && act->verb == Act::remove)
      if (const auto [it, is_new] = deleted.emplace(act->body, when); !is_new) it->second = std::min(it->second, when);
  }
  for (std::size_t i = 0; i < timed_.size(); ++i) {
    const Timed& timed = timed_[i];
    for (const std::string& name : acted_on(timed.command)) {
      const auto gone = deleted.find(name), comes = added.find(name);
      const auto refuse_it = [&](const std::string& why, const char* remedy) {
        throw InputError(fmt::format("{}: '{}' in frame {}, which {}; a body that is there is wanted; {}", timed.place,
                                     name, timed.last, why, remedy));
      };
      if (gone != deleted.end() && When(timed.last, i) > gone->second)
        refuse_it(fmt::format("line {} deletes in frame {}", timed_[gone->second.second].line, gone->second.first),
                  "remove the line, or delete the body later");
      if (comes != added.end() && std::holds_alternative<Act>(timed.command) && When(timed.first, i) < comes->second)
        refuse_it(fmt::format("line {} adds in frame {}", timed_[comes->second.second].line, comes->second.first),
                  "remove the line, or add the body earlier");
    }
  }
}

std::vector<const Command*> Script::commands() const {
  std::vector<const Command*> all;
  for (const Timed& timed : timed_) all.push_back(&timed.command);
  return all;
}

std::vector<Command> Script::commands_at(int frame) const {
  std::vector<Command> commands;
  for (const Timed& timed : timed_) {
    if (frame < timed.first || frame > timed.last) continue;
    commands.push_back(timed.command);
    if (!timed.ramp) continue;
    const double t = timed.last == timed.first ? 1.0 : double(frame - timed.first) / double(timed.last - timed.first);
    std::get<SetCommand>(commands.back()).value = mix(timed.from, timed.to, t);
  }
  return commands;
}

}  // namespace impinge
