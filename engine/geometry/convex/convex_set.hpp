// What the tests of convex solids know of one: how far it reaches in a direction, and the flat or straight part of its
// surface that faces a direction. Everything in the solid's own frame, metres.
#pragma once

#include "engine/core/types.hpp"

namespace impinge {

class ConvexPolyhedron;

/// A flat or straight part of a surface: three or more corners, counter-clockwise seen from outside, are a face, two a
/// line, one a point.
struct ContactFace {
  static constexpr int kMost = 32;
  int count = 0;
  std::array<Vec3, kMost> point;
  std::array<int, kMost> vertex;  ///< what each corner is called, the same in every step; unique on the solid
  std::array<int, kMost> edge;    ///< what the side from each corner to the next is called; unique on the solid
  Vec3 normal = Vec3::Zero();     ///< unit, outward; of a face only
  int face = 0;                   ///< what the face is called; unique on the solid

  /// Adds a corner; numbers count on from `face` unless they are given.
  void add(const Vec3& x) { add(x, kMost * face + count, kMost * face + count); }
  void add(const Vec3& x, int vertex_number, int edge_number) {
    point[count] = x;
    vertex[count] = vertex_number;
    edge[count++] = edge_number;
  }
};

/// A closed bounded convex set, or its core: the solid is then all that is no farther from the core than `rounding`.
class ConvexSet {
 public:
  virtual ~ConvexSet() = default;
  /// A point of the core farthest along `direction`, which has any length but zero.
  virtual Vec3 support(const Vec3& direction) const = 0;
  virtual double rounding() const { return 0.0; }
  /// The part of the solid's surface that a surface with inward normal `direction` (unit) would rest on: a face or line
  /// at right angles to the direction or nearly so (14 degrees), else the farthest point.
  virtual ContactFace facing(const Vec3& direction) const {
    ContactFace face;
    face.add(support(direction) + rounding() * direction);
    return face;
  }
  /// Where the surface touches what faces `to` (unit, as of facing) when it touched at `place` what faced `from`, and rolls:
  /// corners and flat parts with the same place.
  virtual Vec3 rolled(const Vec3& place, const Vec3& from, const Vec3& to) const {
    return place + rounding() * (to - from);
  }
  /// Whether turning about its y axis leaves it as it is.
  virtual bool is_round_about_y() const { return false; }
  /// Points in which a curved surface ends; of a polyhedron none, its corners are known.
  virtual std::vector<Vec3> tips() const { return {}; }
  /// The corners, edges and faces of a set that has no other surface; null for all others.
  virtual const ConvexPolyhedron* polyhedron() const { return nullptr; }
};

/// Of what is round about its y axis, by its orientations now and then: whether it rolls, its axis keeping its direction.
inline bool rolls_about_y(const Mat3& now, const Mat3& then) {
  constexpr double kSameAxis = 1e-2;  // radians
  return now.col(1).cross(then.col(1)).norm() <= kSameAxis;
}

/// Cosine of the angle to a direction up to which a face or line counts as facing it: about 14 degrees.
constexpr double kNearlyFacing = 0.97;

}  // namespace impinge
