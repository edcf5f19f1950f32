#include "engine/io/scene/toml_prescan.hpp"

#include <fmt/format.h>

#include "engine/core/error.hpp"

namespace impinge {

void prescan_toml(const std::string& name, std::string_view text) {
  if (text.size() > kMostTomlBytes)
    throw InputError(fmt::format("{}:1:1: a file of {} bytes; at most {} are taken; split the scene", name, text.size(),
                                 kMostTomlBytes));
  int line = 1, depth = 0;
  std::size_t begin = 0;
  std::string_view quote;  // the mark that ends the text we are in, empty outside
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (i - begin > kMostTomlLine)
      throw InputError(fmt::format("{}:{}:1: a line of more than {} bytes; shorter lines are wanted; break it", name,
                                   line, kMostTomlLine));
    if (c == '\n') {
      ++line;
      begin = i + 1;
      if (quote.size() == 1) quote = {};  // a one-line text that isn't closed: the parser will say so
      continue;
    }
    if (!quote.empty()) {
      if (c == '\\' && quote[0] == '"')
        ++i;
      else if (text.substr(i, quote.size()) == quote)
        i += quote.size() - 1, quote = {};
      if (i < text.size() && text[i] == '\n') --i;  // an escaped line end still ends the line
      continue;
    }
    if (c == '#') {
      const std::size_t end = text.find('\n', i);
      const std::size_t stop = end == std::string_view::npos ? text.size() : end;
      if (stop - begin > kMostTomlLine) continue;  // counted byte by byte, so that the limit above speaks
      i = stop - 1;
    } else if (c == '"' || c == '\'') {
      const std::string_view three = c == '"' ? std::string_view("\"\"\"") : std::string_view("'''");
      quote = text.substr(i, 3) == three ? three : three.substr(0, 1);
      i += quote.size() - 1;
    } else if (c == '[' || c == '{') {
      if (++depth > kMostTomlDepth)
        throw InputError(fmt::format("{}:{}:{}: brackets nested deeper than {}; flatter values are wanted; unfold them",
                                     name, line, i - begin + 1, kMostTomlDepth));
    } else if ((c == ']' || c == '}') && depth > 0) {
      --depth;
    }
  }
}

}  // namespace impinge
