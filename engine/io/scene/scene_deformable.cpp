#include "engine/io/scene/scene_deformable.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/bodies/body_keys.hpp"
#include "engine/geometry/rotation.hpp"
#include "engine/geometry/tets/quadratic_tets.hpp"
#include "engine/io/scene/scene_motion.hpp"
#include "engine/io/scene/scene_values.hpp"
#include "engine/io/scene/scene_volume.hpp"

namespace impinge {
namespace {

/// Of `material` beside the rows of materials.
const std::vector<std::string> kMaterialKeys = {"model",        "density", "damping", "damping_alpha",
                                                "damping_beta", "mass",    "element"};

std::vector<std::string> model_names() {
  std::vector<std::string> names;
  for (const auto& e : materials()) names.emplace_back(e.name);
  return names;
}

std::string choice(const TomlNode& node, const std::string& what, const std::vector<std::string>& names) {
  const std::string& word = scene_text(node, what);
  if (std::find(names.begin(), names.end(), word) != names.end()) return word;
  const std::string near = nearest_word(word, names);
  refuse(node.place, fmt::format("{} is {}", what, toml_string(word)),
         fmt::format("one of {} is allowed", fmt::join(names, ", ")),
         near.empty() ? "use one of them" : fmt::format("did you mean '{}'?", near));
}

void read_damping(const TomlNode& table, const std::string& what, RayleighDamping& damping) {
  if (const TomlEntry* entry = table.find("damping")) {
    const TomlNode& node = entry->value;
    if (node.kind != TomlNode::array || node.items.size() != 2)
      refuse(node.place, what + ".damping is not a pair", "[alpha in 1/s, beta in s] is wanted",
             "write damping = [0, 0.01]");
    damping.alpha = scene_real(node.items[0], what + ".damping", body_key("material.damping_alpha").range);
    damping.beta = scene_real(node.items[1], what + ".damping", body_key("material.damping_beta").range);
  }
  if (const TomlEntry* entry = table.find("damping_alpha"))
    damping.alpha = scene_real(entry->value, what + ".damping_alpha", body_key("material.damping_alpha").range);
  if (const TomlEntry* entry = table.find("damping_beta"))
    damping.beta = scene_real(entry->value, what + ".damping_beta", body_key("material.damping_beta").range);
}

void read_elastic(const TomlNode& table, const std::string& what, DeformableDescription& soft) {
  check_keys(scene_table(table, what), what, deformable_material_keys());
  const auto with = [&](const char* key, auto&& read) {
    if (const TomlEntry* entry = table.find(key)) read(entry->value, what + "." + key);
  };
  with("model", [&](const TomlNode& node, const std::string& key) { soft.model = choice(node, key, model_names()); });
  with("density", [&](const TomlNode& node, const std::string& key) { soft.density = scene_positive(node, key, 1e9); });
  const auto with_choice = [&](const char* key, auto& variable, const auto& words) {
    with(key, [&](const TomlNode& node, const std::string& name) {
      ParameterSet rows;
      Rows(rows).add(name, variable, words, "");
      rows.find(name)->set(scene_value(*rows.find(name), node));
    });
  };
  with_choice("mass", soft.mass, Words<MassKind>{{MassKind::lumped, "lumped"}, {MassKind::consistent, "consistent"}});
  with_choice("element", soft.element, element_words());
  read_damping(table, what, soft.damping);

  // a scene may have settings of materials that it doesn't use at present, as it may of other methods
  for (const Entry<Material>& entry : materials()) {
    ParameterSet rows;
    const std::unique_ptr<Material> material = entry.make();
    material->declare(Rows(rows, what));
    for (const TomlEntry& given : table.entries)
      if (const Parameter* row = rows.find(what + "." + given.key)) {
        const ParameterValue value = scene_value(*row, given.value);
        if (entry.name == soft.model) soft.settings.emplace_back(given.key, format_value(value));
      }
  }
}

NodeRegion read_region(const TomlNode& node, const std::string& what) {
  scene_table(node, what);
  check_keys(node, what, {"box", "sphere", "nodes", "motion"});
  const TomlEntry *box = node.find("box"), *sphere = node.find("sphere"), *nodes = node.find("nodes");
  const int named = (box != nullptr) + (sphere != nullptr) + (nodes != nullptr);
  if (named != 1)
    refuse(node.place, fmt::format("{} names {} regions", what, named), "one of box, sphere, nodes is wanted",
           "write fixed = { box = { min = [...], max = [...] } }");
  NodeRegion region;
  const auto vector = [&](const TomlNode& table, const std::string& name, const char* key) {
    const TomlEntry* entry = table.find(key);
    if (entry == nullptr)
      refuse(table.place, fmt::format("{} has no {}", name, key), "[x, y, z] in metres is wanted", "add it");
    return scene_vector(entry->value, name + "." + key, kLength);
  };
  if (box != nullptr) {
    check_keys(scene_table(box->value, what + ".box"), what + ".box", {"min", "max"});
    region.min = vector(box->value, what + ".box", "min");
    region.max = vector(box->value, what + ".box", "max");
    if ((region.min.array() > region.max.array()).any())
      refuse(box->value.place, what + ".box has a min beyond its max", "min <= max in x, y and z is wanted",
             "exchange them");
  } else if (sphere != nullptr) {
    region.kind = NodeRegion::sphere;
    const std::string name = what + ".sphere";
    check_keys(scene_table(sphere->value, name), name, {"center", "radius"});
    region.center = vector(sphere->value, name, "center");
    const TomlEntry* radius = sphere->value.find("radius");
    if (radius == nullptr) refuse(sphere->value.place, name + " has no radius", "radius = metres is wanted", "add it");
    region.radius = scene_positive(radius->value, name + ".radius", 1e6);
  } else {
    region.kind = NodeRegion::list;
    if (nodes->value.kind != TomlNode::array || nodes->value.items.empty())
      refuse(nodes->value.place,
             nodes->value.kind == TomlNode::array ? what + ".nodes lists no node"
                                                  : fmt::format("{}.nodes is {}", what, toml_kind_name(nodes->value)),
             "[0, 1, 2], counted from 0, is wanted", "add at least one");
    for (const TomlNode& item : nodes->value.items) {
      const double n = scene_real(item, what + ".nodes", {0, 1e9});
      if (n != std::floor(n))
        refuse(item.place, what + ".nodes holds a fraction", "whole numbers are wanted", "round it");
      region.nodes.push_back(static_cast<int>(n));
    }
  }
  if (const TomlEntry* motion = node.find("motion"))
    region.motion = read_motion(motion->value, what + ".motion", Vec3::Zero(), Vec3::Zero());
  return region;
}

/// The regions as written and the place of each, for what can only be said once the nodes are known.
struct Regions {
  std::vector<const TomlNode*> node;
  std::vector<std::string> name;
};

Regions read_fixed(const TomlNode& table, const std::string& what, DeformableDescription& soft) {
  Regions regions;
  const TomlEntry* fixed = table.find("fixed");
  if (fixed == nullptr) return regions;
  const std::string name = what + ".fixed";
  if (fixed->value.kind == TomlNode::array) {
    if (fixed->value.items.empty())
      refuse(fixed->value.place, name + " lists no region", "at least one is wanted", "remove fixed, or add one");
    for (std::size_t i = 0; i < fixed->value.items.size(); ++i) {
      regions.node.push_back(&fixed->value.items[i]);
      regions.name.push_back(fmt::format("{}[{}]", name, i));
    }
  } else {
    regions.node.push_back(&fixed->value);
    regions.name.push_back(name);
  }
  for (std::size_t i = 0; i < regions.node.size(); ++i)
    soft.fixed.push_back(read_region(*regions.node[i], regions.name[i]));
  return regions;
}

// a region that holds nothing is a slip in its numbers, and so is one that leaves nothing to deform
void check_fixed(const Regions& regions, const std::string& what, const DeformableDescription& soft,
                 const BodyDescription& body) {
  const Pose file{rotation_from_degrees(body.rotation), body.position};
  const int nodes = static_cast<int>(soft.mesh.vertices.size());
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  std::vector<Vec3> world;
  for (const Vec3& x : soft.mesh.vertices) {
    world.push_back(file.apply(x));
    low = low.cwiseMin(world.back());
    high = high.cwiseMax(world.back());
  }
  std::vector<char> held(nodes, 0);
  int all = 0;
  for (std::size_t r = 0; r < soft.fixed.size(); ++r) {
    for (const int i : soft.fixed[r].nodes)
      if (i >= nodes)
        refuse(regions.node[r]->place, fmt::format("{}.nodes names node {}", regions.name[r], i),
               fmt::format("the body has nodes 0 to {}", nodes - 1), "correct it");
    int found = 0;
    for (int i = 0; i < nodes; ++i) {
      if (held[i] || !soft.fixed[r].contains(i, world[i])) continue;
      held[i] = 1;
      ++found;
    }
    all += found;
    if (found == 0)
      refuse(regions.node[r]->place,
             fmt::format("{} holds no node{}", regions.name[r], r > 0 ? " that the regions before it leave" : ""),
             fmt::format("the body's nodes lie in [{:.4g}, {:.4g}, {:.4g}] to [{:.4g}, {:.4g}, {:.4g}]", low.x(),
                         low.y(), low.z(), high.x(), high.y(), high.z()),
             "move or widen it");
  }
  if (!soft.fixed.empty() && all == nodes)
    refuse(regions.node[0]->place, fmt::format("{}.fixed holds all {} nodes", what, nodes),
           "a body with no node left to move is rigid", "hold fewer, or make it static or scripted");
}

}  // namespace

std::vector<std::string> deformable_material_keys() {
  std::vector<std::string> keys = kMaterialKeys;
  for (const Entry<Material>& entry : materials()) {
    ParameterSet rows;
    const std::unique_ptr<Material> material = entry.make();
    material->declare(Rows(rows));
    for (const Parameter& row : rows.all())
      if (std::find(keys.begin(), keys.end(), row.path) == keys.end()) keys.push_back(row.path);
  }
  return keys;
}

void read_deformable_body(const TomlNode& table, const std::string& what, double scale, SurfaceFiles& files,
                          BodyDescription& body) {
  auto soft = std::make_shared<DeformableDescription>();
  if (const TomlEntry* material = table.find("material")) read_elastic(material->value, what + ".material", *soft);
  const Regions regions = read_fixed(table, what, *soft);
  read_volume(table, what, scale, files, *soft, body);
  if (soft->element == ElementKind::quadratic)
    for (NodeRegion& region : soft->fixed)
      if (region.kind == NodeRegion::list && std::all_of(region.nodes.begin(), region.nodes.end(), [&](int i) {
            return i < static_cast<int>(soft->mesh.vertices.size());
          }))
        add_midpoints(soft->mesh, region.nodes);
  check_fixed(regions, what, *soft, body);
  if (body.mass) {
    double volume = 0.0;
    for (std::size_t t = 0; t < soft->mesh.tets.size(); ++t)
      volume += tet_volume(soft->mesh, soft->mesh.tets[t]) * (soft->fraction.empty() ? 1.0 : soft->fraction[t]);
    soft->density = *body.mass / volume;
    body.mass.reset();
  }
  body.deformable = std::move(soft);
}

}  // namespace impinge
