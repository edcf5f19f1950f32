#include "engine/io/text_lines.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "engine/core/error.hpp"
#include "engine/core/interrupt.hpp"
#include "engine/core/utf8.hpp"

namespace impinge {

namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

template <class Number>
bool read_number(std::string_view word, Number& value) {
  if (word.size() > 1 && word.front() == '+' && word[1] != '-') word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size();
}

}  // namespace

std::string quoted(std::string_view word) {
  std::string text = "'";
  for (const char c : word.substr(0, 40)) text += c >= ' ' && c != 127 ? c : '?';
  return text + (word.size() > 40 ? "...'" : "'");
}

TextLines::TextLines(std::string name, std::string_view text, char comment, char continuation)
    : name_(std::move(name)), text_(without_byte_order_mark(text)), comment_(comment), continuation_(continuation) {}

void TextLines::split(std::string_view line) {
  std::size_t i = 0;
  while (i < line.size()) {
    if (comment_ != '\0' && line[i] == comment_) return;
    if (is_blank(line[i])) {
      ++i;
      continue;
    }
    const std::size_t begin = i;
    while (i < line.size() && !is_blank(line[i]) && (comment_ == '\0' || line[i] != comment_)) ++i;
    words_.push_back(line.substr(begin, i - begin));
    columns_.push_back(begin + 1);
  }
}

bool TextLines::next() {
  if (next_line_ % 1000 == 0) check_interrupt();
  words_.clear();
  columns_.clear();
  while (words_.empty() && !text_.empty()) {
    line_ = next_line_;
    bool more = true;
    while (more && !text_.empty()) {
      const std::size_t end = text_.find('\n');
      std::string_view line = text_.substr(0, end);
      text_.remove_prefix(end == std::string_view::npos ? text_.size() : end + 1);
      ++next_line_;
      while (!line.empty() && is_blank(line.back())) line.remove_suffix(1);
      more = continuation_ != '\0' && !line.empty() && line.back() == continuation_;
      if (more) line.remove_suffix(1);
      split(line);
    }
  }
  return !words_.empty();
}

void TextLines::need(const char* what) {
  if (next()) return;
  throw InputError(
      fmt::format("{}:{}: the file ends early; {} should follow; export it again", name_, next_line_, what));
}

double TextLines::real(std::size_t i) const {
  if (i >= words_.size())
    fail(words_.size() - 1, "the line ends early", "another number should follow", "export the file again");
  double value = 0.0;
  if (!read_number(words_[i], value) || !std::isfinite(value))
    fail(i, quoted(words_[i]), "a finite number is wanted", "mend or export the file again");
  return value;
}

std::int64_t TextLines::integer(std::size_t i) const {
  if (i >= words_.size())
    fail(words_.size() - 1, "the line ends early", "another whole number should follow", "export the file again");
  std::int64_t value = 0;
  if (!read_number(words_[i], value))
    fail(i, quoted(words_[i]), "a whole number is wanted", "mend or export the file again");
  return value;
}

void TextLines::fail(std::size_t i, const std::string& found, const std::string& allowed,
                     const std::string& remedy) const {
  const std::size_t column = i < columns_.size() ? columns_[i] : 1;
  throw InputError(fmt::format("{}:{}:{}: {}; {}; {}", name_, line_, column, found, allowed, remedy));
}

}  // namespace impinge
