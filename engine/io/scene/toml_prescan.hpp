// What must hold before a text is read as TOML: UTF-8 throughout, and bounded in size and in length of line.
#pragma once

#include <string>
#include <string_view>

namespace impinge {

inline constexpr std::size_t kMostTomlBytes = 32u << 20;
inline constexpr std::size_t kMostTomlLine = 64u << 10;  ///< bytes
/// Levels a value may lie deep: each open bracket and brace, each part of a dotted key and of a table's head is one, the
/// list that [[...]] adds to is one more.
inline constexpr int kMostTomlDepth = 64;

/// The text without a byte order mark. Throws InputError `name:line:column: ...` if it is not UTF-8, a limit is
/// passed, or it is a tar. Columns count characters, not bytes, from 1.
std::string_view prescanned_toml(const std::string& name, std::string_view text);

}  // namespace impinge
