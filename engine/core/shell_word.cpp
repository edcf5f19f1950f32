#include "engine/core/shell_word.hpp"

#include <algorithm>
#include <cctype>

namespace impinge {

std::string shell_word(std::string_view text) {
  constexpr std::string_view kSafe = "/._-+:,@%";
  if (!text.empty() && std::all_of(text.begin(), text.end(), [&](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) || kSafe.find(c) != std::string_view::npos;
      }))
    return std::string(text);
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace impinge
