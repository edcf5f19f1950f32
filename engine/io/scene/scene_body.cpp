#include "engine/io/scene/scene_body.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/bodies/body_keys.hpp"
#include "engine/core/error.hpp"
#include "engine/core/utf8.hpp"
#include "engine/io/scene/scene_deformable.hpp"
#include "engine/io/scene/scene_motion.hpp"
#include "engine/io/scene/scene_shape.hpp"
#include "engine/io/scene/scene_sizes.hpp"
#include "engine/io/scene/scene_values.hpp"
#include "engine/shapes/primitives.hpp"

namespace impinge {

namespace {

// beyond these a number is a slip, not a quantity
constexpr double kMostScale = 1e6, kMostDensity = 1e9, kMostThickness = 1e6;

const std::vector<std::string> kBodyKeys = {"name",
                                            "kind",
                                            "shape",
                                            "surface",
                                            "scale",
                                            "material",
                                            "mass",
                                            "position",
                                            "rotation",
                                            "velocity",
                                            "angular_velocity",
                                            "motion",
                                            "friction",
                                            "restitution",
                                            "self_collision",
                                            "self_exempt_distance",
                                            "volume",
                                            "fixed",
                                            "sides",
                                            "thickness",
                                            "mend",
                                            "unit",
                                            "up",
                                            "component",
                                            "convex",
                                            "decimate",
                                            "copies"};

BodyKind read_body_kind(const TomlNode& table, const std::string& what) {
  const TomlEntry* entry = table.find("kind");
  if (entry == nullptr)
    refuse(table.place, what + " has no kind", "static, scripted, dynamic or deformable is wanted",
           "add kind = \"dynamic\"");
  const std::string& word = scene_text(entry->value, what + ".kind");
  for (const BodyKind kind : {BodyKind::fixed, BodyKind::scripted, BodyKind::dynamic, BodyKind::deformable})
    if (word == kind_name(kind)) return kind;
  const std::string near = nearest_word(word, {"static", "scripted", "dynamic", "deformable"});
  refuse(entry->value.place, fmt::format("{}.kind is {}", what, toml_string(word)),
         "static, scripted, dynamic or deformable is allowed",
         near.empty() ? "use one of them" : fmt::format("did you mean '{}'?", near));
}

/// Of deformable bodies `mass` is a word here: how the mass matrix is made.
void check_no_mass(const TomlNode& node, const std::string& what, BodyKind kind) {
  const TomlEntry* mass = node.find("mass");
  if (mass == nullptr) return;
  if (kind != BodyKind::deformable)
    refuse(mass->place, fmt::format("{}.mass, where a body's mass has no place", what),
           "what a body weighs is a key of the body, mass = kg, or material = { density }",
           "write it beside material, not within");
  if (mass->value.is_number())
    refuse(mass->value.place, fmt::format("{}.mass is {}", what, format_toml(mass->value)),
           "one of lumped, consistent is wanted there, how the mass matrix is made",
           "write it beside material, not within, if it is what the body weighs");
}

void read_material(const TomlNode& node, const std::string& what, BodyDescription& body) {
  scene_table(node, what);
  check_no_mass(node, what, body.kind);
  if (body.kind == BodyKind::deformable) return;  // scene_deformable.cpp
  for (const std::string& key : deformable_material_keys())
    if (const TomlEntry* entry = node.find(key); entry != nullptr && key != "density")
      refuse(entry->place,
             fmt::format("{}.{} belongs to deformable bodies, and this one is {}", what, key, kind_name(body.kind)),
             "allowed: density", "make it deformable, or remove it");
  check_keys(node, what, {"density"});
  if (const TomlEntry* density = node.find("density"))
    body.density = scene_positive(density->value, what + ".density", kMostDensity);
}

SurfaceSides read_sides(const TomlNode& node, const std::string& what) {
  const std::string& word = scene_text(node, what);
  if (word == "both") return SurfaceSides::both;
  if (word == "front") return SurfaceSides::front;
  refuse(node.place, fmt::format("{} is {}", what, toml_string(word)), "both or front is allowed", "use one of them");
}

SharedShape read_surface(const TomlNode& table, const std::string& what, BodyKind kind, SurfaceFiles& surfaces) {
  if (read_surface_keys(table, what).convex) return surfaces.load_hull(table, what);
  if (kind == BodyKind::dynamic) return surfaces.shape_of(surfaces.load(table, what));
  const TomlEntry *sides = table.find("sides"), *thickness = table.find("thickness");
  ThinSurface how;
  if (sides != nullptr) how.sides = read_sides(sides->value, what + ".sides");
  if (thickness != nullptr) how.thickness = scene_positive(thickness->value, what + ".thickness", kMostThickness);
  return surfaces.shape_of(surfaces.load_thin(table, what, how, sides != nullptr || thickness != nullptr));
}

/// Of shapes and volumes; a surface's may be three, which its own reader takes.
double read_scale(const TomlNode& table, const TomlNode& node, const std::string& what) {
  if (node.kind != TomlNode::array) return scene_positive(node, what, kMostScale);
  const TomlEntry* volume = table.find("volume");
  if (table.find("surface") == nullptr || (volume != nullptr && volume->value.kind == TomlNode::text))
    refuse(node.place, what + " is a list", "one number is wanted but for a surface file alone", "use one number");
  return 1.0;
}

void check_surface_keys(const TomlNode& table, const std::string& what, BodyKind kind) {
  for (const std::string& key : surface_keys())
    if (const TomlEntry* entry = table.find(key); entry != nullptr && table.find("surface") == nullptr)
      refuse(entry->place, fmt::format("{}.{} belongs to a surface file, and this body has none", what, key),
             "surface = \"file\" has it", "remove it");
  if (const TomlEntry* convex = table.find("convex"); convex != nullptr && kind == BodyKind::deformable)
    refuse(convex->place, what + ".convex belongs to bodies that keep their form, and this one is deformable",
           "a shape convex_hull can be deformable", "use shape = { convex_hull = { surface = \"file\" } }");
  const TomlEntry* decimate = table.find("decimate");
  if (decimate != nullptr && kind == BodyKind::deformable)
    refuse(decimate->place, what + ".decimate belongs to bodies that keep their form, and this one is deformable",
           "a deformable body is drawn by the surface that it collides with",
           "use the file that impinge mesh FILE --decimate N --out NEW.ply writes");
  if (decimate != nullptr && read_surface_keys(table, what).convex)
    refuse(decimate->place, what + " has a hull and decimate", "one of them is wanted", "remove one");
}

// what has no meaning for the body's kind is refused: taken and ignored it would mislead
void check_kind(const TomlNode& table, const std::string& what, const BodyDescription& body) {
  const TomlEntry* motion = table.find("motion");
  if (body.kind == BodyKind::scripted && motion == nullptr)
    refuse(table.place, what + " is scripted and has no motion", "key frames are wanted",
           "add motion = [ ... ], or make it static");
  if (body.kind != BodyKind::scripted && motion != nullptr)
    refuse(motion->place, fmt::format("{} is {} and has a motion", what, kind_name(body.kind)),
           "scripted bodies have one", "make it scripted, or remove motion");
  if (body.kind != BodyKind::dynamic && body.kind != BodyKind::deformable) {
    for (const char* key : {"velocity", "angular_velocity"}) {
      const TomlEntry* entry = table.find(key);
      if (entry != nullptr && !(key[0] == 'v' ? body.velocity : body.angular_velocity).isZero(0.0))
        refuse(entry->place, fmt::format("{} is {} and has a {}", what, kind_name(body.kind), key),
               "dynamic and deformable bodies have one", "make it dynamic, or remove it");
    }
  }
  if (body.kind == BodyKind::dynamic && body.shape && body.shape->as<Plane>() != nullptr)
    refuse(table.find("shape")->value.place, what + " is dynamic and a plane, which has no mass",
           "a plane is static or scripted", "use a box");
}

/// Keys that some kinds of bodies have and this one doesn't.
void check_keys_of_kind(const TomlNode& table, const std::string& what, BodyKind kind) {
  if (kind != BodyKind::deformable)
    for (const char* key : {"volume", "fixed"})
      if (const TomlEntry* entry = table.find(key))
        refuse(entry->place,
               fmt::format("{}.{} belongs to deformable bodies, and this one is {}", what, key, kind_name(kind)),
               "kind = \"deformable\" has it", "make it deformable, or remove it");

  if (table.find("surface") == nullptr || (kind != BodyKind::fixed && kind != BodyKind::scripted))
    for (const char* key : {"sides", "thickness"})
      if (const TomlEntry* entry = table.find(key))
        refuse(entry->place,
               fmt::format("{}.{} belongs to the open surface of a body that is static or scripted", what, key),
               "kind = \"static\" with surface = \"file\" has it", "remove it");
}

}  // namespace

// a body's own, or nothing by the word that `set` and --set give it back to the scene with
std::optional<double> read_coefficient(const TomlNode& node, const std::string& what, const char* name) {
  const BodyKey& key = body_key(name);
  return scene_real_or(key.word, node, what, key.range);
}

std::string fault_of_name(std::string_view name, const char* whose) {
  const auto is_letter = [](char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_'; };
  const auto may_follow = [&](char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '-'; };
  if (name.empty() || !is_letter(name[0]) || !std::all_of(name.begin(), name.end(), may_follow))
    return fmt::format("{} as {}'s name; letters, digits, _ and - are allowed, a letter or _ first; rename it",
                       toml_string(shortened(std::string(name), 60)), whose);
  if (name.size() > kMostNameLetters)
    return fmt::format("{}'s name of {} letters; at most {} are allowed, since files are named after it; shorten it",
                       whose, name.size(), kMostNameLetters);
  return "";
}

void check_name(const TomlNode& node, const std::string& name, const char* whose) {
  if (const std::string fault = fault_of_name(name, whose); !fault.empty())
    throw InputError(fmt::format("{}: {}", node.place, fault));
}

BodyDescription read_body(const TomlNode& table, SurfaceFiles& surfaces) {
  scene_table(table, "body");
  const TomlEntry* name = table.find("name");
  if (name == nullptr) refuse(table.place, "a body without a name", "name = \"...\" is wanted", "add it");
  BodyDescription body;
  body.name = scene_text(name->value, "body.name");
  check_name(name->value, body.name, "a body");
  const std::string what = "body." + body.name;
  body.kind = read_body_kind(table, what);
  check_keys(table, what, kBodyKeys);
  check_keys_of_kind(table, what, body.kind);
  check_surface_keys(table, what, body.kind);
  const auto with = [&](const char* key, auto&& read) {
    if (const TomlEntry* entry = table.find(key)) read(entry->value, what + "." + key);
  };
  double scale = 1.0;
  with("scale", [&](const TomlNode& node, const std::string& key) { scale = read_scale(table, node, key); });
  with("position", [&](const TomlNode& node, const std::string& key) {
    body.position = scene_vector(node, key, body_key("position").range);
  });
  with("rotation", [&](const TomlNode& node, const std::string& key) {
    body.rotation = scene_vector(node, key, body_key("rotation").range);
  });
  with("velocity", [&](const TomlNode& node, const std::string& key) {
    body.velocity = scene_vector(node, key, body_key("velocity").range);
  });
  with("angular_velocity", [&](const TomlNode& node, const std::string& key) {
    body.angular_velocity = scene_vector(node, key, body_key("angular_velocity").range);
  });
  with("friction",
       [&](const TomlNode& node, const std::string& key) { body.friction = read_coefficient(node, key, "friction"); });
  with("restitution", [&](const TomlNode& node, const std::string& key) {
    body.restitution = read_coefficient(node, key, "restitution");
  });
  with("self_collision",
       [&](const TomlNode& node, const std::string& key) { body.self_collision = scene_flag(node, key); });
  with("self_exempt_distance", [&](const TomlNode& node, const std::string& key) {
    body.self_exempt_distance = scene_real(node, key, body_key("self_exempt_distance").range);
  });
  with("material", [&](const TomlNode& node, const std::string& key) { read_material(node, key, body); });
  with("mass", [&](const TomlNode& node, const std::string& key) { body.mass = scene_mass(node, key); });
  if (const TomlEntry* material = table.find("material");
      body.mass && material != nullptr && material->value.find("density") != nullptr)
    refuse(table.find("mass")->place, what + " has a mass and a density", "one of them is wanted", "remove one");

  if (body.kind == BodyKind::deformable) {
    check_kind(table, what, body);
    read_deformable_body(table, what, scale, surfaces, body);
    return body;
  }
  const TomlEntry *shape = table.find("shape"), *surface = table.find("surface");
  if (shape == nullptr && surface == nullptr)
    refuse(table.place, what + " has no shape", "shape = { ... } or surface = \"file\" is wanted", "add one");
  if (shape != nullptr && surface != nullptr)
    refuse(surface->place, what + " has a shape and a surface", "one of them is wanted", "remove one");
  if (shape != nullptr) body.shape = read_shape(shape->value, what + ".shape", scale, surfaces);
  with("motion", [&](const TomlNode& node, const std::string& key) {
    body.motion = read_motion(node, key, body.position, body.rotation);
  });
  check_kind(table, what, body);
  if (surface == nullptr) return body;
  body.shape = read_surface(table, what, body.kind, surfaces);
  body.surface_file = surface->value.string;
  return body;
}

}  // namespace impinge
