// Where in a script something stands, for messages.
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace impinge {

/// A piece of one line that knows its place. `file` is "console" and the like where there is no file.
struct PlacedText {
  std::string_view text;
  const std::string* file = nullptr;
  int line = 1, column = 1;

  /// The piece from `begin` on, `count` characters long, at its own place.
  PlacedText part(std::size_t begin, std::size_t count = std::string_view::npos) const;
  std::string place() const;  ///< "file:line:column"
  /// Throws InputError `place: found; allowed; remedy`.
  [[noreturn]] void refuse(const std::string& found, const std::string& allowed, const std::string& remedy) const;
};

/// Words between blanks; a bracketed list such as `[0, -20, 0]` and a quoted text are one word each.
std::vector<PlacedText> split_words(const PlacedText& line);

/// Whether a line of a script, or of the debugger, names one of them.
bool names_one_of(const std::string& line, const std::set<std::string>& bodies);

}  // namespace impinge
