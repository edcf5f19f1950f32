#include "engine/io/scene/former_paths.hpp"

#include <fmt/format.h>

#include <optional>

#include "engine/io/scene/scene_values.hpp"

namespace impinge {

namespace {

/// Takes the value at a dotted path out of the tree, if there is one.
std::optional<TomlEntry> take(TomlNode& table, std::string_view path) {
  const std::size_t dot = path.find('.');
  TomlEntry* entry = table.find(path.substr(0, dot));
  if (entry == nullptr) return std::nullopt;
  if (dot != std::string_view::npos)
    return entry->value.kind == TomlNode::table ? take(entry->value, path.substr(dot + 1)) : std::nullopt;
  if (entry->value.kind == TomlNode::table) return std::nullopt;
  TomlEntry taken = std::move(*entry);
  table.entries.erase(table.entries.begin() + (entry - table.entries.data()));
  return taken;
}

/// Puts a value at a path, with the tables on the way. Null, or the entry that is in the way.
const TomlEntry* put(TomlNode& table, std::string_view path, const TomlEntry& given) {
  const std::size_t dot = path.find('.');
  const std::string key(path.substr(0, dot));
  TomlEntry* entry = table.find(key);
  if (dot == std::string_view::npos) {
    if (entry != nullptr) return entry;
    table.entries.push_back({key, given.place, given.value});
    return nullptr;
  }
  if (entry == nullptr) {
    TomlNode below;
    below.place = given.place;
    table.entries.push_back({key, given.place, below});
    entry = &table.entries.back();
  }
  return entry->value.kind == TomlNode::table ? put(entry->value, path.substr(dot + 1), given) : entry;
}

}  // namespace

std::vector<std::string> rename_former_paths(TomlNode& root, const ParameterSet& rows) {
  std::vector<std::string> used;
  for (const auto& [former, present] : rows.former_paths()) {
    const std::optional<TomlEntry> given = take(root, former);
    if (!given) continue;
    used.push_back(former);
    for (const std::string& path : present)
      if (const TomlEntry* other = put(root, path, *given))
        refuse(given->place,
               fmt::format("{} is the former path of {}, which is given at {}", former, path, other->place),
               "a parameter once is wanted", "leave out the former path");
  }
  return used;
}

std::vector<std::string> renamed_overrides(const std::vector<std::string>& overrides, const ParameterSet& rows,
                                           std::vector<std::string>& used) {
  std::vector<std::string> renamed;
  for (const std::string& text : overrides) {
    const std::size_t equals = std::min(text.find('='), text.size());
    const std::vector<std::string>* present = rows.renamed(std::string_view(text).substr(0, equals));
    if (present == nullptr) {
      renamed.push_back(text);
      continue;
    }
    used.push_back(text.substr(0, equals));
    for (const std::string& path : *present) renamed.push_back(path + text.substr(equals));
  }
  return renamed;
}

}  // namespace impinge
