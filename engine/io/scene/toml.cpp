#include "engine/io/scene/toml.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/core/error.hpp"
#include "engine/core/parameter.hpp"
#include "engine/core/utf8.hpp"

namespace impinge {

TomlEntry* TomlNode::find(std::string_view key) {
  for (TomlEntry& entry : entries)
    if (entry.key == key) return &entry;
  return nullptr;
}
const TomlEntry* TomlNode::find(std::string_view key) const { return const_cast<TomlNode*>(this)->find(key); }

const char* toml_kind_name(const TomlNode& node) {
  constexpr const char* kNames[] = {"a boolean", "an integer", "a real number", "a text",
                                    "an array",  "a table",    "a date or time"};
  return kNames[node.kind];
}

std::size_t find_comma(std::string_view text, std::size_t begin) {
  int depth = 0;
  for (std::size_t i = begin; i < text.size(); ++i) {
    depth += text[i] == '(' ? 1 : text[i] == ')' ? -1 : 0;
    if (text[i] == ',' && depth <= 0) return i;
  }
  return std::string_view::npos;
}

TomlNode parse_toml_value(const std::string& text, const std::string& place) {
  const auto place_all = [&](auto& self, TomlNode& node) -> void {
    node.place = place;
    for (TomlNode& item : node.items) self(self, item);
    for (TomlEntry& entry : node.entries) entry.place = place, self(self, entry.value);
  };
  if (find_invalid_utf8(text) != std::string::npos)
    throw InputError(fmt::format("{}: the value is not UTF-8 ({}); text in UTF-8 is wanted; write it in UTF-8",
                                 readable_utf8(place), readable_utf8(shortened(text, 60))));
  TomlNode bare;
  bare.kind = TomlNode::text;
  bare.string = text;
  bare.place = place;
  if (text.find_first_of("\n\r") != std::string::npos) return bare;
  try {
    TomlNode root = parse_toml(place, "value = " + text + "\n");
    if (root.entries.size() != 1 || root.entries[0].value.kind == TomlNode::other) return bare;
    TomlNode node = std::move(root.entries[0].value);
    place_all(place_all, node);
    return node;
  } catch (const InputError&) {
    // a list of bare words, `[meshes, normals]`, is meant as texts
    const std::size_t n = text.size();
    if (n < 2 || text.front() != '[' || text.back() != ']' || text.find_first_of("[]{}\"'", 1) != n - 1) return bare;
    TomlNode list;
    list.kind = TomlNode::array;
    list.place = place;
    for (std::size_t begin = 1; begin < n - 1;) {
      const std::size_t end = std::min(find_comma(text, begin), n - 1);
      const std::size_t first = text.find_first_not_of(' ', begin), last = text.find_last_not_of(' ', end - 1);
      if (first >= end) return bare;
      const std::string item = text.substr(first, last - first + 1);
      // two words are no text, but for one that says NAME = EXPR
      if (item.find(' ') != std::string::npos && item.find('=') == std::string::npos) return bare;
      list.items.push_back(parse_toml_value(item, place));
      begin = end + 1;
    }
    return list;
  }
}

std::string toml_string(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      out += '\\', out += c;
    else if (c == '\n')
      out += "\\n";
    else if (c == '\t')
      out += "\\t";
    else if (c == '\r')
      out += "\\r";
    else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
      out += fmt::format("\\u{:04X}", static_cast<unsigned char>(c));
    else
      out += c;
  }
  return out + "\"";
}

std::string format_toml(const TomlNode& node) {
  switch (node.kind) {
    case TomlNode::boolean:
      return node.flag ? "true" : "false";
    case TomlNode::integer:
      return std::to_string(node.whole);
    case TomlNode::real: {
      std::string text = shortest(node.number);
      if (text.find_first_of(".enai") == std::string::npos) text += ".0";
      return text;
    }
    case TomlNode::text:
      return toml_string(node.string);
    case TomlNode::array: {
      std::vector<std::string> parts;
      for (const TomlNode& item : node.items) parts.push_back(format_toml(item));
      return fmt::format("[{}]", fmt::join(parts, ", "));
    }
    case TomlNode::table: {
      std::vector<std::string> parts;
      for (const TomlEntry& entry : node.entries)
        parts.push_back(fmt::format("{} = {}", entry.key, format_toml(entry.value)));
      return fmt::format("{{ {} }}", fmt::join(parts, ", "));
    }
    case TomlNode::other:
      break;
  }
  return toml_string(node.string);
}

}  // namespace impinge
