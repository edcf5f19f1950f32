// A place in a scene text that moves forward and knows its line and column.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

#include "engine/core/error.hpp"
#include "engine/core/utf8.hpp"

namespace impinge {

class TomlCursor {
 public:
  /// Line, and character in it, both from 1.
  struct Spot {
    int line = 1, column = 1;
  };

  TomlCursor(const std::string& name, std::string_view text) : prefix_(name + ":"), text_(text) {}

  bool at_end() const { return at_ >= text_.size(); }
  /// The character there, or so many bytes further on; NUL, which no text may hold, beyond the end.
  char peek(std::size_t ahead = 0) const { return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0'; }
  bool starts_with(std::string_view words) const { return text_.substr(at_, words.size()) == words; }
  std::string_view rest() const { return text_.substr(at_); }

  void skip(std::size_t bytes = 1) { at_ += bytes; }  ///< within the line
  void skip_blanks() {
    while (peek() == ' ' || peek() == '\t') ++at_;
  }
  bool at_line_end() const { return peek() == '\n' || (peek() == '\r' && peek(1) == '\n'); }
  void skip_line_end() {
    at_ += peek() == '\r' ? 2 : 1;
    ++line_;
    counted_ = at_;
    column_ = 1;
  }
  /// A remark, if one begins here, up to the line's end.
  void skip_remark() {
    if (peek() != '#') return;
    for (; !at_end() && !at_line_end(); ++at_) refuse_control();
  }
  /// Only a tab is allowed of the characters that are none.
  void refuse_control() const {
    const auto c = static_cast<unsigned char>(peek());
    if ((c < 0x20 && c != '\t') || c == 0x7F) fail(fmt::format("a control character, U+{:04X}", c));
  }

  Spot spot() const {
    for (; counted_ < at_; ++counted_) column_ += (static_cast<unsigned char>(text_[counted_]) & 0xC0) != 0x80;
    return {line_, column_};
  }
  std::string place(Spot spot) const {
    const fmt::format_int line(spot.line), column(spot.column);
    std::string out;
    out.reserve(prefix_.size() + line.size() + column.size() + 1);
    return out.append(prefix_).append(line.data(), line.size()).append(1, ':').append(column.data(), column.size());
  }
  std::string place() const { return place(spot()); }

  [[noreturn]] void fail_at(Spot spot, const std::string& reason) const {
    throw InputError(
        fmt::format("{}: broken TOML ({}); TOML 1.0 is wanted; mend the line", place(spot), shortened(reason, 200)));
  }
  [[noreturn]] void fail(const std::string& reason) const { fail_at(spot(), reason); }
  /// What stands there, for a message: "the line's end", "'x'".
  std::string found() const {
    if (at_end()) return "the file's end";
    if (at_line_end()) return "the line's end";
    const std::string_view here = rest();
    std::size_t length = 1;
    while (length < here.size() && (static_cast<unsigned char>(here[length]) & 0xC0) == 0x80) ++length;
    const auto c = static_cast<unsigned char>(here[0]);
    return c < 0x20 || c == 0x7F ? fmt::format("U+{:04X}", c) : fmt::format("'{}'", here.substr(0, length));
  }

 private:
  std::string prefix_;
  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 1;
  // how far the line's characters are counted: each once, however often a place is asked for
  mutable std::size_t counted_ = 0;
  mutable int column_ = 1;
};

}  // namespace impinge
