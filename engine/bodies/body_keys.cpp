#include "engine/bodies/body_keys.hpp"

#include <algorithm>

#include "engine/core/error.hpp"

namespace impinge {
namespace {

using enum ParameterKind;
// beyond these a number is a slip, not a quantity
constexpr Range kFar{-1e6, 1e6};

constexpr BodyKey kKeys[] = {
    {"friction", real, "", {0.0, 100.0}, "Coulomb coefficient; scene: contact.friction.", "scene"},
    {"restitution", real, "", {0.0, 1.0}, "Restitution; scene: contact.restitution.", "scene"},
    {"position", vector3, "m", kFar, "Where the origin of the body's file (or shape) is."},
    {"rotation", vector3, "deg", kFar,
     "About x, then y, then z (fixed axes), round the file's origin; the angular velocity stays."},
    {"velocity", vector3, "m/s", kFar, "Of the centre of mass."},
    {"angular_velocity", vector3, "rad/s", kFar, "Angular velocity, world axes."},
    {"mass", real, "kg", {1e-15, 1e15, true}, "What the body weighs."},
    {"self_collision", boolean, "", {}, "Whether a deformable body's surface meets itself."},
    {"self_exempt_distance",
     real,
     "m",
     {0.0, 1e6},
     "Triangles of a body with self_collision that are this near each other at rest, or cross, never meet; none: all "
     "do.",
     "none"},
    {"material.damping_alpha", real, "1/s", {0.0, 1e6, true}, "Rayleigh damping in proportion to mass."},
    {"material.damping_beta", real, "s", {0.0, 1e3, true}, "Rayleigh damping in proportion to stiffness."},
};

}  // namespace

const BodyKey& body_key(std::string_view name) {
  const auto found = std::find_if(std::begin(kKeys), std::end(kKeys), [&](const BodyKey& k) { return k.name == name; });
  if (found == std::end(kKeys)) throw InternalError("no key of a body: " + std::string(name));
  return *found;
}

Parameter body_row(const std::string& path, std::string_view name, std::function<ParameterValue()> get,
                   std::function<void(const ParameterValue&)> set) {
  const BodyKey& key = body_key(name);
  Parameter row;
  row.path = path + "." + std::string(name);
  row.kind = key.kind;
  row.unit = key.unit;
  row.range = key.range;
  row.doc = key.doc;
  row.word = key.word;
  row.initial = get();
  row.get = std::move(get);
  row.live = set != nullptr;
  row.set = std::move(set);
  return row;
}

}  // namespace impinge
