// A TOML document as a plain tree in which every value and key knows its place. The library that parses it stays in
// toml_parse.cpp, behind checks of encoding, size, line length and depth.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace impinge {

struct TomlEntry;

struct TomlNode {
  enum Kind { boolean, integer, real, text, array, table, other };  // other: dates and times
  Kind kind = table;
  bool flag = false;
  std::int64_t whole = 0;
  double number = 0.0;
  std::string string;              ///< of a text, and the source of `other`
  std::vector<TomlNode> items;     ///< of an array
  std::vector<TomlEntry> entries;  ///< of a table, in the order of the file
  std::string place;               ///< "file:line:column", or "--set PATH=VALUE"

  bool is_number() const { return kind == integer || kind == real; }
  double as_number() const { return kind == integer ? static_cast<double>(whole) : number; }
  TomlEntry* find(std::string_view key);
  const TomlEntry* find(std::string_view key) const;
};

struct TomlEntry {
  std::string key;
  std::string place;  ///< of the key
  TomlNode value;
};

/// "a text", "an array", ...: for messages.
const char* toml_kind_name(const TomlNode& node);

/// The tree of `text`; `name` is the file's name in messages. Throws InputError `name:line:column: ...`.
TomlNode parse_toml(const std::string& name, const std::string& text);

/// Where the next comma stands that is in no parentheses; npos for none.
std::size_t find_comma(std::string_view text, std::size_t begin = 0);

/// One value as it stands right of an equals sign; text that is no TOML value is taken as a bare string. Throws
/// InputError where it is no UTF-8.
TomlNode parse_toml_value(const std::string& text, const std::string& place);

/// The value as TOML on one line; parse_toml reads it back exactly.
std::string format_toml(const TomlNode& node);
std::string toml_string(std::string_view text);

}  // namespace impinge
