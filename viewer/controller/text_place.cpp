#include "viewer/controller/text_place.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/core/error.hpp"

namespace impinge {

PlacedText PlacedText::part(std::size_t begin, std::size_t count) const {
  return {text.substr(begin, count), file, line, column + static_cast<int>(begin)};
}

std::string PlacedText::place() const { return fmt::format("{}:{}:{}", *file, line, column); }

void PlacedText::refuse(const std::string& found, const std::string& allowed, const std::string& remedy) const {
  throw InputError(fmt::format("{}: {}; {}; {}", place(), found, allowed, remedy));
}

std::vector<PlacedText> split_words(const PlacedText& line) {
  std::vector<PlacedText> words;
  const std::string_view text = line.text;
  const auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  for (std::size_t i = 0; i < text.size();) {
    if (is_blank(text[i])) {
      ++i;
      continue;
    }
    std::size_t end = i;
    const char first = text[i];
    if (first == '[' || first == '"' || first == '\'') {
      const std::size_t close = text.find(first == '[' ? ']' : first, i + 1);
      if (close == std::string_view::npos)
        line.part(i, 1).refuse(fmt::format("'{}' is not closed", first), "its partner should follow on the line",
                               "close it");
      end = close + 1;
    } else {
      while (end < text.size() && !is_blank(text[end])) ++end;
    }
    words.push_back(line.part(i, end - i));
    i = end;
  }
  return words;
}

bool names_one_of(const std::string& line, const std::set<std::string>& bodies) {
  constexpr std::string_view kNameLetters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
  for (std::size_t begin = line.find_first_of(kNameLetters); begin != std::string::npos;) {
    const std::size_t end = std::min(line.find_first_not_of(kNameLetters, begin), line.size());
    if (bodies.contains(line.substr(begin, end - begin))) return true;
    begin = line.find_first_of(kNameLetters, end);
  }
  return false;
}

}  // namespace impinge
