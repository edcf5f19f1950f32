#include "viewer/debugger/line_words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "engine/core/error.hpp"
#include "engine/core/parameter.hpp"

namespace impinge {

namespace {

std::string remedy(std::string_view word, const std::vector<std::string>& names) {
  const std::string near = nearest_word(std::string(word), names);
  return near.empty() ? "use one of them" : fmt::format("did you mean '{}'?", near);
}

}  // namespace

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

double number(const PlacedText& word, double low, double high, bool whole) {
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

std::string rest(const PlacedText& line, LineWords words, std::size_t skip) {
  if (words.size() <= skip) return "";
  return std::string(words[skip].text.data(),
                     static_cast<std::size_t>(line.text.data() + line.text.size() - words[skip].text.data()));
}

}  // namespace impinge
