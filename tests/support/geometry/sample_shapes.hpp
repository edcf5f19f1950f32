// Shapes of every kind for tests, made from the keys that the list of shapes shows: a new one is tested unnamed.
#pragma once

#include "engine/shapes/primitives.hpp"
#include "engine/shapes/shape_entry.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/random.hpp"

namespace impinge::test {

/// A shape by name and lengths: `made("cylinder", {{"radius", 0.1}, {"length", 0.3}})`.
inline SharedShape made(std::string_view name, std::initializer_list<std::pair<const char*, double>> lengths) {
  ShapeValues values;
  for (const auto& [key, value] : lengths) values.set(key, value);
  return make_shape(name, values);
}

inline SharedShape cylinder(double radius, double length) {
  return made("cylinder", {{"radius", radius}, {"length", length}});
}
inline SharedShape cone(double radius, double length) { return made("cone", {{"radius", radius}, {"length", length}}); }

inline SharedShape made_hull(const std::vector<Vec3>& points) {
  ShapeValues values;
  values.set("points", points);
  return make_shape("convex_hull", values);
}

inline SharedShape made_compound(const std::vector<ShapePart>& parts) {
  ShapeValues values;
  values.set("parts", parts);
  return make_shape("compound", values);
}

inline std::vector<Vec3> box_corners(const Vec3& half) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i)
    corners.emplace_back(i & 1 ? half.x() : -half.x(), i & 2 ? half.y() : -half.y(), i & 4 ? half.z() : -half.z());
  return corners;
}

/// Of about a metre, in its centre of mass like a body's.
inline SharedShape sample_shape(Random& r, const ShapeEntry& entry) {
  SharedShape shape;
  if (entry.make == nullptr) {
    shape = surface(r.below(2) ? icosphere(1, r.in(0.4, 0.8)) : box({r.in(0.2, 0.8), r.in(0.2, 0.8), r.in(0.2, 0.8)}));
  } else {
    ShapeValues values;
    bool optional = false;  // of keys that may be left out one is enough
    for (const ShapeKey& key : entry.keys) {
      if (!key.required && optional) continue;
      optional = optional || !key.required;
      switch (key.kind) {
        case ShapeKey::length:
          values.set(key.name, r.in(0.2, 0.8));
          break;
        case ShapeKey::lengths:
          values.set(key.name, Vec3(r.in(0.4, 1.6), r.in(0.4, 1.6), r.in(0.4, 1.6)));
          break;
        case ShapeKey::coordinate:
          values.set(key.name, 0.3 * r.sym());
          break;
        case ShapeKey::direction:
          values.set(key.name, r.direction());
          break;
        case ShapeKey::points:
        case ShapeKey::surface: {
          std::vector<Vec3> points;
          for (int i = 6 + r.below(14); i > 0; --i) points.push_back(Vec3(0.8 * r.direction()));
          values.set(key.name, points);
          break;
        }
        case ShapeKey::parts:
          values.set(key.name,
                     std::vector<ShapePart>{
                         {Sphere{r.in(0.2, 0.4)}, {r.rotation(), 0.4 * r.vector()}},
                         {Box{Vec3(r.in(0.1, 0.4), r.in(0.1, 0.4), 0.3)}, {r.rotation(), 0.4 * r.vector()}},
                         {made("cylinder", {{"radius", 0.2}, {"length", 0.6}}), {r.rotation(), 0.4 * r.vector()}}});
          break;
      }
    }
    shape = entry.make(values);
  }
  return shape->as<Plane>() != nullptr ? shape : shape->recentered(shape->mass(1.0).center);
}

}  // namespace impinge::test
