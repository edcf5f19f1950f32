#include "engine/io/scene/toml_prescan.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/core/error.hpp"
#include "engine/core/utf8.hpp"

namespace impinge {

std::string_view prescanned_toml(const std::string& name, std::string_view text) {
  if (text.size() > kMostTomlBytes)
    throw InputError(fmt::format("{}:1:1: a file of {} bytes; at most {} are taken; split the scene", name, text.size(),
                                 kMostTomlBytes));
  check_utf8(name, text);
  int line = 1;
  for (std::size_t begin = 0; begin < text.size(); ++line) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    if (end - begin > kMostTomlLine)
      throw InputError(fmt::format("{}:{}:1: a line of more than {} bytes; shorter lines are wanted; break it", name,
                                   line, kMostTomlLine));
    begin = end + 1;
  }
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.substr(0, 3) == kByteOrderMark) text.remove_prefix(3);
  return text;
}

}  // namespace impinge
