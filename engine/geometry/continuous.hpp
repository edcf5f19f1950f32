// Continuous detection: the first time at which a vertex meets a face, or an edge an edge, while their corners move.
//
// The answer is conservative: never later than the true first time at which the two come within `separation`, and
// nothing only where they never do. It may be early by what the tolerance allows, or say "contact" of features that pass
// a little farther apart than the separation.
//
// Two methods. `inclusion` bisects the box of times and places on the features, in order of time, and discards what
// interval bounds exclude [Snyder92, Wang21]; rounding is bounded and counted in, so it is proven never to miss.
// `advancement` steps by distance over speed [Mirtich96, Li21]: quicker where the features stay apart, conservative but
// for rounding in the distance itself.
#pragma once

#include <optional>

#include "engine/core/types.hpp"

namespace impinge {

/// Four corners that move on straight lines while t goes from 0 to 1, metres. For a vertex and a face: x, a, b, c; for
/// two edges: a0, a1, b0, b1.
struct MovingCorners {
  std::array<Vec3, 4> start, end;
};

struct ContinuousSettings {
  double separation = 0.0;    ///< within this distance they count as in contact, metres, >= 0
  double tolerance = 1e-6;    ///< how far apart features may be that are still called in contact beyond it, metres, > 0
  int max_boxes = 1'000'000;  ///< inclusion: boxes looked at before the earliest one left is taken for a contact
};

struct Impact {
  double time = 0.0;  ///< in [0, 1]; at or before the true one
  /// Where on the features: weights (u, v) of b and c in the face, or of a1 and b1 on the edges; to the tolerance.
  Vec2 place = Vec2::Zero();
  /// Whether the features come within separation + tolerance there; else the bound on boxes or steps was met.
  bool certain = true;
};

std::optional<Impact> vertex_face_impact(const MovingCorners& corners, const ContinuousSettings& settings);
std::optional<Impact> edge_edge_impact(const MovingCorners& corners, const ContinuousSettings& settings);

/// The same by conservative advancement. `tolerance` is the distance beyond `separation` at which it stops, > 0.
std::optional<Impact> vertex_face_advancement(const MovingCorners& corners, const ContinuousSettings& settings);
std::optional<Impact> edge_edge_advancement(const MovingCorners& corners, const ContinuousSettings& settings);

}  // namespace impinge
