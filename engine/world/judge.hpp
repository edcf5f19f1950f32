// How much bodies really overlap, whatever detection found: the judge of `--judge`. Slow on purpose: winding numbers
// over all triangles, formulas for exact shapes, no data structure shared with detection.
#pragma once

#include <span>

#include "engine/bodies/bodies.hpp"
#include "engine/world/step_record.hpp"

namespace impinge {

struct OverlapVerdict {
  /// Metres. Deepest vertex of either closed surface inside the other; with an exact shape its signed distance decides
  /// (sphere and capsule by their centre line, two other convex solids by the least motion that parts them, a compound
  /// part by part). 0 without overlap.
  double penetration = 0.0;
  int body_a = -1, body_b = -1;  ///< where it is deepest
  double deepest = 0.0;          ///< metres; that, or edges of meshes between their ends where these run deeper
  /// The pair whose overlap, edges included, is the largest share of the thinner one's thickness (shapes/wall).
  Crossing crossing;
  std::int64_t intersections = 0;  ///< triangle pairs of different meshes that share a point
};

OverlapVerdict judge_overlap(const Bodies& bodies);

}  // namespace impinge
