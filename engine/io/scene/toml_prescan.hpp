// What must hold before the TOML parser may see a file: it crashes on deep nesting and hangs on huge lines.
#pragma once

#include <string>
#include <string_view>

namespace impinge {

inline constexpr std::size_t kMostTomlBytes = 32u << 20;
inline constexpr std::size_t kMostTomlLine = 64u << 10;  ///< bytes
inline constexpr int kMostTomlDepth = 64;                ///< brackets and braces open at once

/// Throws InputError `name:line:column: ...` if a limit is passed.
void prescan_toml(const std::string& name, std::string_view text);

}  // namespace impinge
