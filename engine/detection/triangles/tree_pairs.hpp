// What walks of two trees share: frames, margins, and the test of two triangles that they come to.
#pragma once

#include <algorithm>
#include <vector>

#include "engine/detection/triangles/triangle_pair_test.hpp"

namespace impinge {

inline bool deforms(const Collider& mesh) { return !mesh.vertex_velocities.empty(); }

/// From the frame of b's tree to that of a's. A rigid mesh's is its own, a deforming one's the world.
inline Pose tree_in_tree(const Collider& a, const Collider& b) {
  const Pose in = deforms(a) ? Pose() : a.pose, of = deforms(b) ? Pose() : b.pose;
  return {in.rotation.transpose() * of.rotation, in.apply_inverse(of.position)};
}

/// How far boxes of the trees may be apart whose triangles are within the margin: as search_box has it, and what poses
/// round.
inline double tree_margin(const Collider& a, const Collider& b, double margin) {
  const double magnitude = std::max(largest_coordinate(a.bounds), largest_coordinate(b.bounds));
  return margin * (1.0 + 1e-9) + (4.0 * kTouchTolerance + 1e-13) * magnitude;
}

/// Each body of the pairs once, ascending.
inline std::vector<BodyIndex> bodies_of(std::span<const BodyPair> pairs) {
  std::vector<BodyIndex> bodies;
  for (const BodyPair& pair : pairs) bodies.insert(bodies.end(), {pair.a, pair.b});
  std::sort(bodies.begin(), bodies.end());
  bodies.erase(std::unique(bodies.begin(), bodies.end()), bodies.end());
  return bodies;
}

}  // namespace impinge
