#include "engine/core/parameter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "engine/core/error.hpp"

namespace impinge {

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

namespace {

constexpr double kUnbounded = 1e15;  // the widest range: beyond it a number is a slip, not a quantity

std::string unquoted(std::string_view text) {
  text = trimmed(text);
  if (text.size() >= 2 && text.front() == text.back() && (text.front() == '"' || text.front() == '\''))
    text = text.substr(1, text.size() - 2);
  return std::string(text);
}

// `[a, b, c]`, `a, b, c` and `a b c` alike; nothing may be left out between two commas
std::optional<std::vector<std::string>> list_items(std::string_view text) {
  text = trimmed(text);
  if (!text.empty() && text.front() == '[') {
    if (text.size() < 2 || text.back() != ']') return std::nullopt;
    text = trimmed(text.substr(1, text.size() - 2));
  }
  std::vector<std::string> items;
  const bool commas = text.find(',') != std::string_view::npos;
  while (!text.empty()) {
    const std::size_t end = commas ? text.find(',') : text.find_first_of(" \t");
    const std::string_view item = trimmed(text.substr(0, end));
    if (item.empty()) return std::nullopt;
    items.push_back(unquoted(item));
    if (end == std::string_view::npos) break;
    text = trimmed(text.substr(end + 1));
  }
  return items;
}

// strict: the whole text is one number; overflow, nan and inf are not numbers here
template <class Number>
std::optional<Number> number(std::string_view text) {
  text = trimmed(text);
  if (text.size() > 1 && text.front() == '+' && text[1] != '-') text.remove_prefix(1);
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

[[noreturn]] void refuse(const Parameter& row, std::string_view found, std::string_view why = "") {
  throw InputError(fmt::format("{}{} for {}; allowed: {}", found, why, row.path, describe_allowed(row)));
}

std::string kind_of(const ParameterValue& value) {
  constexpr const char* kNames[] = {"a boolean", "an integer", "a real number", "a text", "a vector", "a list"};
  return kNames[value.index()];
}

std::string found_text(const ParameterValue& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return fmt::format("'{}'", *text);
  return format_value(value);
}

void check_number(const Parameter& row, double value, const std::string& found) {
  if (std::isnan(value)) refuse(row, found, " is not a number");
  if (!(value >= row.range.low && value <= row.range.high)) refuse(row, found, " is out of range");
}

void check_name(const Parameter& row, const std::string& name) {
  if (std::find(row.names.begin(), row.names.end(), name) != row.names.end()) return;
  const std::string near = nearest_word(name, row.names);
  refuse(row, fmt::format("'{}'", name),
         near.empty() ? " is not known" : fmt::format(" is not known (did you mean '{}'?)", near));
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  // optimal string alignment: a swap of neighbours, the commonest slip, counts once
  const std::size_t columns = b.size() + 1;
  std::vector<std::size_t> cost((a.size() + 1) * columns);
  for (std::size_t i = 0; i <= a.size(); ++i) cost[i * columns] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) cost[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      std::size_t& c = cost[i * columns + j];
      c = std::min({cost[(i - 1) * columns + j] + 1, cost[i * columns + j - 1] + 1,
                    cost[(i - 1) * columns + j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        c = std::min(c, cost[(i - 2) * columns + j - 2] + 1);
    }
  }
  return cost.back();
}

}  // namespace

Parameter& ParameterSet::add(Parameter parameter) {
  if (former_.count(parameter.path) > 0 || !index_.emplace(parameter.path, rows_.size()).second)
    throw InternalError("parameter '" + parameter.path + "' is declared twice");
  rows_.push_back(std::move(parameter));
  return rows_.back();
}

void ParameterSet::cut(std::size_t count) {
  for (; rows_.size() > count; rows_.pop_back()) index_.erase(rows_.back().path);
}

void ParameterSet::add_former_path(std::string former, std::string path) {
  if (index_.count(former) > 0) throw InternalError("parameter '" + former + "' is declared twice");
  former_[std::move(former)].push_back(std::move(path));
}

const Parameter* ParameterSet::find(std::string_view path) const {
  const auto it = index_.find(path);
  return it == index_.end() ? nullptr : &rows_[it->second];
}

const std::vector<std::string>* ParameterSet::renamed(std::string_view path) const {
  const auto it = former_.find(path);
  return it == former_.end() ? nullptr : &it->second;
}

std::string ParameterSet::note_of_former(const std::vector<std::string>& used) const {
  std::string note;
  for (const auto& [former, present] : former_)
    if (std::find(used.begin(), used.end(), former) != used.end())
      note += fmt::format("{}{} for {}", note.empty() ? "parameters have new paths: write " : ", ",
                          fmt::join(present, " and "), former);
  return note;
}

std::string ParameterSet::nearest(std::string_view path) const {
  std::vector<std::string> paths;
  for (const Parameter& row : rows_) paths.push_back(row.path);
  std::string near = nearest_word(path, paths);
  if (!near.empty()) return near;
  // the right last word under the wrong table (or none)
  const auto last = [](std::string_view p) { return p.substr(p.rfind('.') + 1); };
  for (const std::string& candidate : paths)
    if (last(candidate) == last(path)) return candidate;
  return "";
}

std::string ParameterSet::unknown_message(std::string_view path) const {
  const std::string near = nearest(path);
  return near.empty() ? fmt::format("unknown parameter '{}'; see `impinge list parameters`", path)
                      : fmt::format("unknown parameter '{}'; did you mean '{}'?", path, near);
}

ParameterValue parse_value(const Parameter& row, std::string_view text) {
  const std::string found = fmt::format("'{}'", trimmed(text));
  switch (row.kind) {
    case ParameterKind::boolean: {
      const std::string_view word = trimmed(text);
      if (word != "true" && word != "false") refuse(row, found);
      return word == "true";
    }
    case ParameterKind::integer:
      if (const auto value = number<std::int64_t>(text)) return checked_value(row, *value);
      refuse(row, found);
    case ParameterKind::real:
      if (const auto value = number<double>(text)) return checked_value(row, *value);
      if (!row.word.empty() && unquoted(text) == row.word) return row.word;
      refuse(row, found);
    case ParameterKind::vector3: {
      const auto items = list_items(text);
      if (!items || items->size() != 3) refuse(row, found);
      Vec3 v;
      for (int i = 0; i < 3; ++i) {
        const auto value = number<double>((*items)[i]);
        if (!value) refuse(row, found);
        v[i] = *value;
      }
      return checked_value(row, v);
    }
    case ParameterKind::text:
    case ParameterKind::choice:
      return checked_value(row, unquoted(text));
    case ParameterKind::text_list: {
      auto items = list_items(text);
      if (!items) refuse(row, found);
      return checked_value(row, std::move(*items));
    }
  }
  throw InternalError("a parameter of unknown kind: " + row.path);
}

ParameterValue checked_value(const Parameter& row, ParameterValue value) {
  if (row.kind == ParameterKind::real)
    if (const auto* whole = std::get_if<std::int64_t>(&value)) value = static_cast<double>(*whole);
  const std::string found = found_text(value);
  const auto wrong_kind = [&] { refuse(row, found, fmt::format(" ({}) is of the wrong type", kind_of(value))); };
  switch (row.kind) {
    case ParameterKind::boolean:
      if (!std::holds_alternative<bool>(value)) wrong_kind();
      break;
    case ParameterKind::integer:
      if (!std::holds_alternative<std::int64_t>(value)) wrong_kind();
      check_number(row, static_cast<double>(std::get<std::int64_t>(value)), found);
      break;
    case ParameterKind::real:
      if (!row.word.empty() && value == ParameterValue(row.word)) break;
      if (!std::holds_alternative<double>(value)) wrong_kind();
      check_number(row, std::get<double>(value), found);
      break;
    case ParameterKind::vector3:
      if (!std::holds_alternative<Vec3>(value)) wrong_kind();
      for (int i = 0; i < 3; ++i) check_number(row, std::get<Vec3>(value)[i], found);
      break;
    case ParameterKind::text:
      if (!std::holds_alternative<std::string>(value)) wrong_kind();
      break;
    case ParameterKind::choice:
      if (!std::holds_alternative<std::string>(value)) wrong_kind();
      check_name(row, std::get<std::string>(value));
      break;
    case ParameterKind::text_list:
      if (!std::holds_alternative<std::vector<std::string>>(value)) wrong_kind();
      if (!row.names.empty())
        for (const std::string& name : std::get<std::vector<std::string>>(value)) check_name(row, name);
      break;
  }
  return value;
}

std::string shortest(double value) {
  char buffer[32];
  const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, value);
  (void)error;  // 32 characters hold every double
  return {buffer, end};
}

std::string format_value(const ParameterValue& value) {
  struct Formatter {
    std::string operator()(bool v) const { return v ? "true" : "false"; }
    std::string operator()(std::int64_t v) const { return std::to_string(v); }
    std::string operator()(double v) const { return shortest(v); }
    std::string operator()(const std::string& v) const {
      // quoted where parse_value would otherwise trim or unquote it
      const auto edge = [](char c) { return c == ' ' || c == '\t' || c == '"' || c == '\''; };
      return v.empty() || edge(v.front()) || edge(v.back()) ? '"' + v + '"' : v;
    }
    std::string operator()(const Vec3& v) const {
      return fmt::format("[{}, {}, {}]", shortest(v.x()), shortest(v.y()), shortest(v.z()));
    }
    std::string operator()(const std::vector<std::string>& v) const { return fmt::format("[{}]", fmt::join(v, ", ")); }
  };
  return std::visit(Formatter{}, value);
}

std::string describe_allowed(const Parameter& row) {
  const auto numbers = [&](const char* what) {
    const std::string unit = row.unit.empty() ? "" : " " + row.unit;
    if (row.range.low <= -kUnbounded && row.range.high >= kUnbounded)
      return fmt::format("{}{}", what, unit.empty() ? "" : " in" + unit);
    return fmt::format("{} in [{}, {}]{}", what, shortest(row.range.low), shortest(row.range.high), unit);
  };
  switch (row.kind) {
    case ParameterKind::boolean:
      return "true or false";
    case ParameterKind::integer:
      return numbers("an integer");
    case ParameterKind::real:
      return numbers("a real number") + (row.word.empty() ? "" : " or the word " + row.word);
    case ParameterKind::vector3:
      return "[x, y, z], each " + numbers("a real number");
    case ParameterKind::text:
      return "a text";
    case ParameterKind::choice:
      return fmt::format("one of {}", fmt::join(row.names, ", "));
    case ParameterKind::text_list:
      return row.names.empty() ? "a list of texts" : fmt::format("a list of {}", fmt::join(row.names, ", "));
  }
  return "";
}

std::string some_of(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 24;
  if (names.size() <= kMost) return fmt::format("{}", fmt::join(names, ", "));
  constexpr std::size_t kShown = 20;
  return fmt::format("{} and {} more", fmt::join(names.begin(), names.begin() + kShown, ", "), names.size() - kShown);
}

std::string nearest_word(std::string_view word, const std::vector<std::string>& candidates) {
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(2, word.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    const std::size_t longer = std::max(word.size(), candidate.size()),
                      shorter = std::min(word.size(), candidate.size());
    if (longer - shorter >= best_distance) continue;  // no less than that is the distance
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < best_distance && distance < shorter) best = candidate, best_distance = distance;
  }
  return best;
}

}  // namespace impinge
