#include "engine/io/scene/toml.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <toml.hpp>

#include "engine/core/error.hpp"
#include "engine/core/parameter.hpp"
#include "engine/io/scene/toml_prescan.hpp"

namespace impinge {

namespace {

using Value = toml::basic_value<toml::discard_comments, std::map, std::vector>;

std::size_t number_of(const std::string& text) {
  return text == "line_num" || text.empty() ? 0 : std::strtoul(text.c_str(), nullptr, 10);
}

struct Place {
  std::size_t line = 1, column = 1;
  friend bool operator<(const Place& l, const Place& r) {
    return l.line != r.line ? l.line < r.line : l.column < r.column;
  }
};

class Converter {
 public:
  explicit Converter(const std::string& name) : name_(name) {}

  TomlNode node(const Value& value) const {
    TomlNode out;
    out.place = text(place(value));
    switch (value.type()) {
      case toml::value_t::boolean:
        out.kind = TomlNode::boolean, out.flag = value.as_boolean();
        break;
      case toml::value_t::integer:
        out.kind = TomlNode::integer, out.whole = value.as_integer();
        break;
      case toml::value_t::floating:
        out.kind = TomlNode::real, out.number = value.as_floating();
        break;
      case toml::value_t::string:
        out.kind = TomlNode::text, out.string = value.as_string().str;
        break;
      case toml::value_t::array:
        out.kind = TomlNode::array;
        for (const Value& item : value.as_array()) out.items.push_back(node(item));
        break;
      case toml::value_t::table:
        table(value, out);
        break;
      default:
        out.kind = TomlNode::other, out.string = "a date or time";
        break;
    }
    return out;
  }

 private:
  static Place place(const Value& value) {
    const toml::source_location where = value.location();
    return {std::max<std::size_t>(1, where.line()), std::max<std::size_t>(1, where.column())};
  }
  std::string text(const Place& at) const { return fmt::format("{}:{}:{}", name_, at.line, at.column); }

  // toml11 knows where a value stands; its key is the nearest one before it on that line
  static Place key_place(const std::string& key, const Value& value) {
    const Place at = place(value);
    const std::string line = value.location().line_str();
    const auto is_part = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-'; };
    Place best = at;
    for (std::size_t i = line.find(key); i != std::string::npos && !key.empty(); i = line.find(key, i + 1)) {
      const std::size_t end = i + key.size();
      if ((i > 0 && is_part(line[i - 1])) || (end < line.size() && is_part(line[end]))) continue;
      if (i + 1 < at.column || best.column == at.column) best.column = i + 1;
    }
    return best;
  }

  void table(const Value& value, TomlNode& out) const {
    out.kind = TomlNode::table;
    std::vector<std::pair<Place, TomlEntry>> sorted;
    for (const auto& [key, child] : value.as_table()) {
      const Place at = key_place(key, child);
      sorted.push_back({at, {key, text(at), node(child)}});
    }
    std::stable_sort(sorted.begin(), sorted.end(), [](const auto& l, const auto& r) { return l.first < r.first; });
    for (auto& [at, entry] : sorted) out.entries.push_back(std::move(entry));
  }

  std::string name_;
};

// "[error] toml::parse_table: ..." and a picture of the line: the first line without the parser's own names, and where
[[noreturn]] void refuse_syntax(const std::string& name, const toml::syntax_error& error) {
  const std::string what = error.what();
  std::string reason = what.substr(0, what.find('\n'));
  for (const char* prefix : {"[error] ", "toml::"})
    if (reason.rfind(prefix, 0) == 0) reason = reason.substr(std::string_view(prefix).size());
  if (const std::size_t colon = reason.find(": "); colon != std::string::npos && reason.find(' ') > colon)
    reason = reason.substr(colon + 2);
  if (reason.size() < 3) reason = "no valid value";

  // its location() is unreliable, the picture is right: " 3 | text" with a line of ^ or ~ below; of two pictures, the
  // first shows what was there already
  const bool twice = what.find("already") != std::string::npos;
  std::size_t line = std::max<std::size_t>(1, error.location().line()), column = 1;
  std::size_t bar = std::string::npos;
  for (std::size_t begin = 0; begin < what.size();) {
    const std::size_t end = std::min(what.find('\n', begin), what.size());
    const std::string row = what.substr(begin, end - begin);
    const std::size_t at = row.find(" | ");
    const std::size_t digits = row.find_first_of("0123456789");
    if (at != std::string::npos && digits < at && number_of(row.substr(digits)) > 0)
      line = number_of(row.substr(digits)), bar = at;
    else if (bar != std::string::npos) {
      const std::size_t mark = row.find_first_of("^~", bar);
      if (mark != std::string::npos) column = mark - bar - 2;
      if (!twice) break;
      bar = std::string::npos;
    }
    begin = end + 1;
  }
  throw InputError(fmt::format("{}:{}:{}: broken TOML ({}); TOML 1.0 is wanted; mend the line", name, line,
                               std::max<std::size_t>(1, column), reason));
}

}  // namespace

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

TomlNode parse_toml(const std::string& name, const std::string& text) {
  prescan_toml(name, text);
  try {
    std::istringstream in(text);
    return Converter(name).node(toml::parse<toml::discard_comments, std::map, std::vector>(in, name));
  } catch (const toml::syntax_error& error) {
    refuse_syntax(name, error);
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    throw InputError(fmt::format("{}:1:1: broken TOML ({}); TOML 1.0 is wanted; mend the file", name, error.what()));
  }
}

TomlNode parse_toml_value(const std::string& text, const std::string& place) {
  const auto place_all = [&](auto& self, TomlNode& node) -> void {
    node.place = place;
    for (TomlNode& item : node.items) self(self, item);
    for (TomlEntry& entry : node.entries) entry.place = place, self(self, entry.value);
  };
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
      const std::size_t end = std::min(text.find(',', begin), n - 1);
      const std::size_t first = text.find_first_not_of(' ', begin), last = text.find_last_not_of(' ', end - 1);
      if (first >= end || text.substr(first, last - first + 1).find(' ') != std::string::npos) return bare;
      list.items.push_back(parse_toml_value(text.substr(first, last - first + 1), place));
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
