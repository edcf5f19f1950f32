#include "engine/io/scene/scene_copies.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/core/error.hpp"
#include "engine/core/parameter.hpp"
#include "engine/geometry/rotation.hpp"
#include "engine/io/scene/scene_body.hpp"
#include "engine/io/scene/scene_values.hpp"

namespace impinge {
namespace {

constexpr std::size_t kMostCopies = 100'000;

Vec3 position_of(const TomlNode& body, const std::string& what) {
  const TomlEntry* entry = body.find("position");
  return entry == nullptr ? Vec3(Vec3::Zero()) : scene_vector(entry->value, what + ".position", kLength);
}

TomlNode vector_node(const Vec3& v, const std::string& place) {
  TomlNode node;
  node.kind = TomlNode::array;
  node.place = place;
  for (int a = 0; a < 3; ++a) {
    TomlNode number;
    number.kind = TomlNode::real;
    number.number = v[a];
    number.place = place;
    node.items.push_back(number);
  }
  return node;
}

void give(TomlNode& body, const std::string& key, TomlNode value) {
  if (TomlEntry* entry = body.find(key)) {
    entry->place = value.place;
    entry->value = std::move(value);
  } else {
    const std::string place = value.place;
    body.entries.push_back({key, place, std::move(value)});
  }
}

/// A grid: the body itself is its first.
std::vector<TomlNode> grid_of(const TomlNode& table, const TomlNode& body, const std::string& what) {
  check_keys(table, what + ".copies", {"count", "spacing"});
  const TomlEntry *count = table.find("count"), *spacing = table.find("spacing");
  if (count == nullptr || spacing == nullptr)
    refuse(table.place, fmt::format("{}.copies has no {}", what, count == nullptr ? "count" : "spacing"),
           "count = [nx, ny, nz] and spacing = [x, y, z] in metres are wanted", "add it");
  const Vec3 n = scene_vector(count->value, what + ".copies.count", {1.0, static_cast<double>(kMostCopies)});
  const Vec3 step = scene_vector(spacing->value, what + ".copies.spacing", kLength);
  if (n != n.array().floor().matrix() || n.prod() > static_cast<double>(kMostCopies))
    refuse(count->value.place, fmt::format("{}.copies.count makes {} bodies", what, shortest(n.prod())),
           fmt::format("whole numbers are wanted, {} bodies at most", kMostCopies), "use fewer");
  const Vec3 first = position_of(body, what);
  std::vector<TomlNode> placements;
  for (int k = 0; k < static_cast<int>(n.z()); ++k)
    for (int j = 0; j < static_cast<int>(n.y()); ++j)
      for (int i = 0; i < static_cast<int>(n.x()); ++i) {
        if (i + j + k == 0) continue;
        TomlNode placement;
        placement.place = table.place;
        give(placement, "position", vector_node(first + step.cwiseProduct(Vec3(i, j, k)), table.place));
        placements.push_back(std::move(placement));
      }
  return placements;
}

std::vector<TomlNode> placements_of(const TomlNode& node, const TomlNode& body, const std::string& what) {
  if (node.kind == TomlNode::table) return grid_of(node, body, what);
  if (node.kind != TomlNode::array)
    refuse(node.place, fmt::format("{}.copies is {}", what, toml_kind_name(node)),
           "a list of placements, or { count, spacing }, is wanted",
           "write copies = [ { position = [1, 0, 0] }, ... ]");
  if (node.items.size() > kMostCopies)
    refuse(node.place, fmt::format("{}.copies has {} entries", what, node.items.size()),
           fmt::format("at most {} are taken", kMostCopies), "use fewer");
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    const std::string name = fmt::format("{}.copies[{}]", what, i);
    check_keys(scene_table(node.items[i], name), name,
               {"name", "position", "rotation", "velocity", "angular_velocity"});
    if (node.items[i].find("position") == nullptr)
      refuse(node.items[i].place, name + " has no position", "position = [x, y, z] is wanted", "add it");
  }
  return node.items;
}

/// Regions are places in the world: a copy elsewhere is held at the same nodes.
std::shared_ptr<const DeformableDescription> held_at_nodes(const BodyDescription& pattern) {
  auto own = std::make_shared<DeformableDescription>(*pattern.deformable);
  const Pose file{rotation_from_degrees(pattern.rotation), pattern.position};
  for (NodeRegion& region : own->fixed) {
    if (!region.motion.empty())
      throw InputError(
          fmt::format("a copy of '{}', whose held nodes move on a path of their own; a body whose nodes are held where "
                      "they are, or free, is wanted; name another one",
                      pattern.name));
    NodeRegion nodes;
    nodes.kind = NodeRegion::list;
    for (std::size_t i = 0; i < own->mesh.vertices.size(); ++i)
      if (region.contains(static_cast<int>(i), file.apply(own->mesh.vertices[i])))
        nodes.nodes.push_back(static_cast<int>(i));
    region = std::move(nodes);
  }
  return own;
}

BodyDescription pattern_of(const Scene& scene, std::span<const Act> before, const std::string& name) {
  for (std::size_t i = 0; i < before.size(); ++i)
    if (before[i].body == name) return describe_added(scene, before.first(i), before[i]);
  for (const TomlNode& table : scene.bodies)
    if (table.find("name")->value.string == name) return read_body(table, *scene.files);
  throw InternalError("no body to copy: " + name);
}

}  // namespace

void expand_copies(TomlNode& root) {
  TomlEntry* bodies = root.find("body");
  if (bodies == nullptr || bodies->value.kind != TomlNode::array) return;
  std::vector<TomlNode> all;
  for (TomlNode& body : bodies->value.items) {
    const TomlEntry *copies = body.find("copies"), *name = body.find("name");
    if (copies == nullptr || name == nullptr || name->value.kind != TomlNode::text) {
      all.push_back(std::move(body));  // its reader says what is missing
      continue;
    }
    const std::string own = name->value.string;
    const std::vector<TomlNode> placements = placements_of(copies->value, body, "body." + own);
    std::erase_if(body.entries, [](const TomlEntry& entry) { return entry.key == "copies"; });
    all.push_back(body);
    for (std::size_t i = 0; i < placements.size(); ++i) {
      TomlNode copy = body;
      TomlNode named = copy.find("name")->value;
      named.string = fmt::format("{}_{}", own, i + 2);
      give(copy, "name", std::move(named));
      for (const TomlEntry& entry : placements[i].entries) give(copy, entry.key, entry.value);
      all.push_back(std::move(copy));
    }
  }
  bodies->value.items = std::move(all);
}

BodyDescription describe_added(const Scene& scene, std::span<const Act> before, const Act& act) {
  BodyDescription body = pattern_of(scene, before, act.like);
  if (body.deformable && !body.deformable->fixed.empty()) body.deformable = held_at_nodes(body);
  body.name = act.body;
  body.position = act.vector;
  if (act.axis.norm() > 0.0) body.rotation = degrees_from_rotation(turn_of(act) * rotation_from_degrees(body.rotation));
  body.velocity = act.velocity;
  body.angular_velocity.setZero();
  return body;
}

}  // namespace impinge
