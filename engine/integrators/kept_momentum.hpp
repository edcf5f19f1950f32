// How a deformable body moves as a whole needs no solve where nothing holds it: what an iteration leaves of that balance would
// be momentum lost.
#pragma once

#include "engine/bodies/deformable_body.hpp"

namespace impinge {

/// Moves all nodes of v alike, so that the sum of A v over them is that of b; v and b over the free nodes. `mass`: what A
/// counts the body's mass by; whatever else A holds knows no such motion.
inline void keep_momentum(const DeformableBody& body, double mass, const VecX& b, VecX& v) {
  if (body.pull || body.free_nodes() != body.nodes() || v.size() != b.size()) return;
  const std::vector<double>& node = body.fem.node_mass();
  Vec3 missing = Vec3::Zero();
  double whole = 0.0;
  for (int i = 0; i < body.nodes(); ++i) {
    missing += b.segment<3>(3 * i) - mass * node[static_cast<std::size_t>(i)] * v.segment<3>(3 * i);
    whole += mass * node[static_cast<std::size_t>(i)];
  }
  if (!missing.allFinite() || !(whole > 0.0)) return;
  for (int i = 0; i < body.nodes(); ++i) v.segment<3>(3 * i) += missing / whole;
}

}  // namespace impinge
