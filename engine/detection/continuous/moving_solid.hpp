// A solid of a body that moves through a piece of its path, as another body sees it.
#pragma once

#include "engine/geometry/aabb.hpp"
#include "engine/geometry/convex/minkowski.hpp"

namespace impinge {

/// Where the body is when the piece begins and ends. Of a body that only looks on, no solid.
struct MovingSolid {
  const PlacedConvex* solid;
  Pose first, last;
  double radius;          ///< that its points turn about the body's centre, metres
  bool is_round = false;  ///< about the body's y axis: only the turning of that moves its surface

  Vec3 way() const { return last.position - first.position; }
  Vec3 turn() const;
  /// By how much its surface turns beside b's at most, rad.
  double swing_beside(const MovingSolid& b) const;
};

/// How far a point of `a`, as `b` sees it, may be off the straight line between its places where a piece begins and ends,
/// metres: an eighth of the largest acceleration that two steady motions come to.
double bend_between(const MovingSolid& a, const MovingSolid& b);

/// The box that holds all of `a` in the piece, as `b` sees it.
Aabb box_of_piece(const MovingSolid& a, const MovingSolid& b);

}  // namespace impinge
