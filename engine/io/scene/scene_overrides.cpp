#include "engine/io/scene/scene_overrides.hpp"

#include <fmt/format.h>

#include "engine/core/parameter.hpp"
#include "engine/io/scene/scene_values.hpp"

namespace impinge {

namespace {

TomlNode& body_named(TomlNode& root, const std::string& name, const std::string& place) {
  std::vector<std::string> names;
  if (TomlEntry* bodies = root.find("body")) {
    for (TomlNode& body : bodies->value.items) {
      const TomlEntry* entry = body.find("name");
      if (entry == nullptr) continue;
      if (entry->value.string == name) return body;
      names.push_back(entry->value.string);
    }
  }
  const std::string near = nearest_word(name, names);
  refuse(place, fmt::format("there is no body '{}'", name),
         names.empty() ? "the scene has no bodies" : fmt::format("bodies: {}", fmt::join(names, ", ")),
         near.empty() ? "name one of the scene's" : fmt::format("did you mean '{}'?", near));
}

}  // namespace

void apply_override(TomlNode& root, const std::string& text) {
  const std::string place = "--set " + text;
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    refuse(place, "no PATH=VALUE", "a parameter's path, =, and its value are wanted",
           "write --set contact.friction=0.5");
  std::vector<std::string> keys(1);
  for (const char c : text.substr(0, equals)) {
    if (c == '.')
      keys.emplace_back();
    else
      keys.back() += c;
  }
  for (const std::string& key : keys)
    if (key.empty())
      refuse(place, "an empty name in the path", "names joined by dots are wanted", "write --set contact.friction=0.5");

  TomlNode* node = &root;
  std::size_t i = 0;
  if (keys[0] == "body") {
    if (keys.size() < 3)
      refuse(place, "no key of a body", "body.NAME.KEY=VALUE is wanted", "write --set body.crate.mass=2");
    node = &body_named(root, keys[1], place);
    i = 2;
    if (keys[2] == "name") refuse(place, "a body's name", "its other keys can be set", "rename it in the scene file");
  }
  for (; i + 1 < keys.size(); ++i) {
    TomlEntry* entry = node->find(keys[i]);
    if (entry == nullptr) {
      TomlNode table;
      table.place = place;
      node->entries.push_back({keys[i], place, table});
      entry = &node->entries.back();
    } else if (entry->value.kind != TomlNode::table) {
      refuse(place, fmt::format("'{}' is {} in the scene", keys[i], toml_kind_name(entry->value)),
             "a table is wanted there", "set it as a whole");
    }
    node = &entry->value;
  }
  TomlNode value = parse_toml_value(text.substr(equals + 1), place);
  if (TomlEntry* entry = node->find(keys.back())) {
    entry->value = std::move(value);
    entry->place = place;
  } else {
    node->entries.push_back({keys.back(), place, std::move(value)});
  }
}

}  // namespace impinge
