// How much bodies really overlap, whatever detection found: the judge of `--judge`. Winding numbers, formulas for exact
// shapes, and the answers that going through all triangles would have (geometry/surface/searched_mesh).
#pragma once

#include <map>

#include "engine/bodies/bodies.hpp"
#include "engine/geometry/surface/node_rims.hpp"
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

/// What of meshes stays the same whatever they do, kept from one look to the next.
class JudgeMemory {
 public:
  /// Not for several threads at once.
  const NodeRims& rims_of(const SharedShape& mesh);

 private:
  struct Kept {
    SharedShape shape;  // so that nobody else gets its place in memory
    NodeRims rims;
  };
  std::map<const SurfaceMesh*, Kept> kept_;
};

OverlapVerdict judge_overlap(const Bodies& bodies, JudgeMemory& memory);
OverlapVerdict judge_overlap(const Bodies& bodies);

}  // namespace impinge
