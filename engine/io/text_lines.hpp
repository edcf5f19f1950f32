// A text file as lines of words, with the place of every word: what the readers of text formats share.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace impinge {

class TextLines {
 public:
  /// `comment` starts a remark that runs to the end of the line ('\0': there are none). A line that ends in
  /// `continuation` goes on in the next. `name` is used in messages; `text` must outlive this.
  TextLines(std::string name, std::string_view text, char comment = '\0', char continuation = '\0');

  /// Goes to the next line that has words; false at the end of the file.
  bool next();
  /// next(), or an error that says what is missing.
  void need(const char* what);

  std::size_t count() const { return words_.size(); }
  std::string_view word(std::size_t i) const { return words_[i]; }
  int line() const { return line_; }
  std::size_t bytes_left() const { return text_.size(); }

  /// Word i as a finite number, or as a whole number; an error at its place otherwise.
  double real(std::size_t i) const;
  std::int64_t integer(std::size_t i) const;

  /// Throws InputError `name:line:column: found; allowed; remedy` at word i (or at the line's first).
  [[noreturn]] void fail(std::size_t i, const std::string& found, const std::string& allowed,
                         const std::string& remedy) const;

 private:
  void split(std::string_view line);

  std::string name_;
  std::string_view text_;
  char comment_, continuation_;
  std::vector<std::string_view> words_;
  std::vector<std::size_t> columns_;
  int line_ = 0, next_line_ = 1;
};

/// What a message shows of a word: quoted, cut to a readable length, without control characters.
std::string quoted(std::string_view word);

}  // namespace impinge
