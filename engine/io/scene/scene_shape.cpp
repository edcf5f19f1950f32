#include "engine/io/scene/scene_shape.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/geometry/rotation.hpp"
#include "engine/io/scene/scene_sizes.hpp"
#include "engine/io/scene/scene_values.hpp"
#include "engine/shapes/shape_entry.hpp"

namespace impinge {
namespace {

constexpr std::size_t kMostPoints = 100000, kMostParts = 1000;

/// What to write where a key is missing.
std::string wanted(const ShapeKey& key) {
  switch (key.kind) {
    case ShapeKey::length:
    case ShapeKey::coordinate:
      return fmt::format("{} = a length in metres is wanted", key.name);
    case ShapeKey::lengths:
      return fmt::format("{} = [x, y, z] in metres is wanted", key.name);
    case ShapeKey::direction:
      return fmt::format("{} = [x, y, z] is wanted", key.name);
    case ShapeKey::points:
      return fmt::format("{} = [[x, y, z], ...] in metres is wanted", key.name);
    case ShapeKey::surface:
      return fmt::format("{} = \"a mesh file\" is wanted", key.name);
    case ShapeKey::parts:
      return fmt::format("{} = [{{ shape = {{ ... }}, position, rotation }}, ...] is wanted", key.name);
  }
  return {};
}

const std::vector<TomlNode>& list_of(const TomlNode& node, const std::string& what, std::size_t most) {
  if (node.kind != TomlNode::array)
    refuse(node.place, fmt::format("{} is {}", what, toml_kind_name(node)), "a list [ ... ] is wanted",
           "write it in brackets");
  if (node.items.size() > most)
    refuse(node.place, fmt::format("{} has {} entries", what, node.items.size()),
           fmt::format("at most {} are taken", most), "use fewer");
  return node.items;
}

std::vector<Vec3> read_points(const TomlNode& node, const std::string& what, double scale) {
  std::vector<Vec3> points;
  for (const TomlNode& item : list_of(node, what, kMostPoints))
    points.push_back(scale * scene_vector(item, what, kLength));
  return points;
}

std::vector<ShapePart> read_parts(const TomlNode& node, const std::string& what, double scale, SurfaceFiles& files) {
  std::vector<ShapePart> parts;
  for (const TomlNode& item : list_of(node, what, kMostParts)) {
    const std::string name = fmt::format("{}[{}]", what, parts.size());
    check_keys(scene_table(item, name), name, {"shape", "position", "rotation"});
    const TomlEntry *shape = item.find("shape"), *position = item.find("position"), *rotation = item.find("rotation");
    if (shape == nullptr) refuse(item.place, name + " has no shape", "shape = { ... } is wanted", "add it");
    ShapePart part;
    part.shape = read_shape(shape->value, name + ".shape", scale, files);
    if (position != nullptr) part.pose.position = scale * scene_vector(position->value, name + ".position", kLength);
    if (rotation != nullptr)
      part.pose.rotation = rotation_from_degrees(scene_vector(rotation->value, name + ".rotation", kAngle));
    parts.push_back(std::move(part));
  }
  return parts;
}

ShapeValues::Value read_value(const ShapeKey& key, const TomlNode& node, const std::string& what, double scale,
                              SurfaceFiles& files) {
  switch (key.kind) {
    case ShapeKey::length:
      return scene_size(node, what, scale);
    case ShapeKey::lengths: {
      if (node.kind != TomlNode::array || node.items.size() != 3)
        scene_vector(node, what, kLength);  // which refuses it
      Vec3 lengths;
      for (int i = 0; i < 3; ++i) lengths[i] = scene_size(node.items[static_cast<std::size_t>(i)], what, scale);
      return lengths;
    }
    case ShapeKey::coordinate:
      return scale * scene_real(node, what, kLength);
    case ShapeKey::direction: {
      const Vec3 n = scene_vector(node, what, kLength);
      if (!(n.norm() > 1e-9))
        refuse(node.place, what + " has no length", "a direction is wanted", "use [0, 1, 0] for a floor");
      return n;
    }
    case ShapeKey::points:
      return read_points(node, what, scale);
    case ShapeKey::surface: {
      std::vector<Vec3> points = files.load_points(node, what);
      for (Vec3& x : points) x *= scale;
      return points;
    }
    case ShapeKey::parts:
      return read_parts(node, what, scale, files);
  }
  return {};
}

SharedShape make_one(const ShapeEntry& entry, const TomlNode& table, const std::string& what, double scale,
                     SurfaceFiles& files) {
  std::vector<std::string> keys;
  for (const ShapeKey& key : entry.keys) keys.emplace_back(key.name);
  check_keys(table, what, keys);
  ShapeValues values;
  for (const ShapeKey& key : entry.keys) {
    const TomlEntry* found = table.find(key.name);
    if (found != nullptr)
      values.set(key.name, read_value(key, found->value, fmt::format("{}.{}", what, key.name), scale, files));
    else if (key.required)
      refuse(table.place, fmt::format("{} has no {}", what, key.name), wanted(key), "add it");
  }
  try {
    return entry.make(values);
  } catch (const ShapeError& error) {
    const TomlEntry* at = table.find(error.key);
    refuse(at == nullptr ? table.place : at->value.place,
           fmt::format("{}{} {}", what, at == nullptr ? "" : "." + error.key, error.found), error.allowed,
           error.remedy);
  }
}

}  // namespace

SharedShape read_shape(const TomlNode& node, const std::string& what, double scale, SurfaceFiles& files) {
  scene_table(node, what);
  std::vector<std::string> words;
  for (const ShapeEntry& entry : shape_entries())
    if (entry.make != nullptr) words.emplace_back(entry.name);
  check_keys(node, what, words);
  if (node.entries.size() != 1)
    refuse(node.place, fmt::format("{} names {} shapes", what, node.entries.size()),
           fmt::format("one of {} is wanted", fmt::join(words, ", ")), "keep one");
  const std::string& word = node.entries[0].key;
  const std::string name = what + "." + word;
  const TomlNode& table = scene_table(node.entries[0].value, name);
  const ShapeEntry& entry = shape_entries()[static_cast<std::size_t>(shape_type(word))];
  const std::pair key(format_toml(node), scale);
  if (const auto made = files.made_shapes().find(key); made != files.made_shapes().end()) return made->second;
  SharedShape shape = make_one(entry, table, name, scale, files);
  files.made_shapes().emplace(key, shape);
  return shape;
}

}  // namespace impinge
