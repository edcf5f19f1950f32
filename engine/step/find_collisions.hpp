// Stage 6 of a sub-step: from pairs of bodies to collisions.
#pragma once

#include "engine/contact/contact_settings.hpp"
#include "engine/detection/collider.hpp"
#include "engine/detection/collision.hpp"
#include "engine/detection/triangles/narrow_phase.hpp"

namespace impinge {

/// Fills `triangle_pairs` of mesh-mesh pairs, sorted, and `collisions` in the order of `pairs`. time_step: s.
void find_collisions(std::span<const Collider> colliders, std::span<const BodyPair> pairs,
                     const ContactSettings& settings, double time_step, bool either_may_stop, NarrowPhase& narrow_phase,
                     std::vector<TrianglePair>& triangle_pairs, std::vector<Collision>& collisions);

}  // namespace impinge
