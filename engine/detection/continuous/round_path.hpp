// Balls and capsules on their way past triangles. They are what lies within a radius of a segment, so how near they come
// to a surface is a distance, and how much nearer between two moments is bounded by the way between them: a few distances
// tell that nothing is met, where a search for the meeting would have to cut time again and again along a surface that is
// touched all the way.
#pragma once

#include <optional>

#include "engine/detection/continuous/surface_path.hpp"
#include "engine/shapes/shape.hpp"

namespace impinge {

/// In the body's frame: all points no farther than `radius` from the segment pq.
struct RoundCore {
  Vec3 p, q;
  double radius = 0.0;  ///< metres, > 0
};
/// Of a sphere or a capsule; none of others.
std::optional<RoundCore> round_core(const Shape& shape);

/// Whether the round body is known to overlap the triangles nowhere by more than `depth`, metres, all along both paths,
/// which are those of rigid bodies. False where it isn't known: then they have to be searched.
bool stays_out(const RoundCore& core, const SurfacePath& own, const SurfacePath& triangles, double depth);
/// The same of two round bodies.
bool stays_out(const RoundCore& a, const SurfacePath& of_a, const RoundCore& b, const SurfacePath& of_b, double depth);

}  // namespace impinge
