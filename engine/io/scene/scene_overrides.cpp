#include "engine/io/scene/scene_overrides.hpp"

#include <fmt/format.h>

#include <map>
#include <optional>

#include "engine/core/parameter.hpp"
#include "engine/io/scene/scene_values.hpp"

namespace impinge {

namespace {

/// The bodies of a scene's tree by their names, which no override can change.
class BodyTables {
 public:
  explicit BodyTables(const TomlNode& root) {
    const TomlEntry* bodies = root.find("body");
    if (bodies == nullptr) return;
    for (std::size_t i = 0; i < bodies->value.items.size(); ++i) {
      const TomlEntry* entry = bodies->value.items[i].find("name");
      if (entry == nullptr) continue;
      names_.push_back(entry->value.string);
      by_name_.emplace(entry->value.string, i);
    }
  }
  TomlNode& named(TomlNode& root, const std::string& name, const std::string& place) const {
    if (const auto it = by_name_.find(name); it != by_name_.end()) return root.find("body")->value.items[it->second];
    const std::string near = nearest_word(name, names_);
    refuse(place, fmt::format("there is no body '{}'", name),
           names_.empty() ? "the scene has no bodies" : "bodies: " + some_of(names_),
           near.empty() ? "name one of the scene's" : fmt::format("did you mean '{}'?", near));
  }

 private:
  std::vector<std::string> names_;
  std::map<std::string, std::size_t> by_name_;
};

void apply_override(TomlNode& root, std::optional<BodyTables>& bodies, const std::string& text) {
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
    if (!bodies) bodies.emplace(root);
    node = &bodies->named(root, keys[1], place);
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

}  // namespace

void apply_overrides(TomlNode& root, const std::vector<std::string>& texts) {
  std::optional<BodyTables> bodies;
  for (const std::string& text : texts) apply_override(root, bodies, text);
}

}  // namespace impinge
