#include "engine/io/scene/toml_prescan.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/core/error.hpp"
#include "engine/core/utf8.hpp"

namespace impinge {

namespace {

constexpr std::size_t kTarMark = 257;  // where a tar says what it is, bytes

}  // namespace

std::string_view prescanned_toml(const std::string& name, std::string_view text) {
  if (text.size() > kMostTomlBytes)
    throw InputError(fmt::format("{}:1:1: a file of {} bytes; at most {} are taken; split the scene", name, text.size(),
                                 kMostTomlBytes));
  if (text.substr(std::min(text.size(), kTarMark), 5) == "ustar")
    throw InputError(fmt::format(
        "{}: this is a tar, as a bundle of impinge debug is one; a scene file (TOML) is wanted; impinge debug "
        "and impinge replay open a bundle, and tar xf makes a folder of it, with a run.toml",
        name));
  check_utf8(name, text);
  int line = 1;
  for (std::size_t begin = 0; begin < text.size(); ++line) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    if (end - begin > kMostTomlLine)
      throw InputError(fmt::format("{}:{}:1: a line of more than {} bytes; shorter lines are wanted; break it", name,
                                   line, kMostTomlLine));
    begin = end + 1;
  }
  return without_byte_order_mark(text);
}

}  // namespace impinge
