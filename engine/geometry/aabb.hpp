// Axis-aligned bounding box. Touching boxes overlap: a closed box, so that exact contact is never missed.
#pragma once

#include <limits>

#include "engine/core/types.hpp"

namespace impinge {

struct Aabb {
  Vec3 min = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 max = Vec3::Constant(-std::numeric_limits<double>::infinity());

  bool is_empty() const { return (min.array() > max.array()).any(); }
  void include(const Vec3& point) {
    min = min.cwiseMin(point);
    max = max.cwiseMax(point);
  }
  void include(const Aabb& other) {
    min = min.cwiseMin(other.min);
    max = max.cwiseMax(other.max);
  }
  Aabb inflated(double margin) const { return {min - Vec3::Constant(margin), max + Vec3::Constant(margin)}; }
  Vec3 center() const { return 0.5 * (min + max); }
  Vec3 extent() const { return max - min; }
};

inline bool overlap(const Aabb& a, const Aabb& b) {
  return (a.min.array() <= b.max.array()).all() && (b.min.array() <= a.max.array()).all();
}

/// From a point to the box; 0 inside. Metres².
inline double squared_distance(const Aabb& box, const Vec3& x) {
  return (x - x.cwiseMax(box.min).cwiseMin(box.max)).squaredNorm();
}

/// What rounding of a coordinate in the box is relative to, metres; 0 for an empty one.
inline double largest_coordinate(const Aabb& box) {
  return box.is_empty() ? 0.0 : box.min.cwiseAbs().cwiseMax(box.max.cwiseAbs()).maxCoeff();
}

inline Aabb bounds_of(const Vec3& a, const Vec3& b, const Vec3& c) {
  return {a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)};
}

}  // namespace impinge
