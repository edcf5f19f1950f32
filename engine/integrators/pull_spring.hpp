// The pull on a deformable body (bodies/pull.hpp) as part of its sub-step. It acts at the end of the step in every scheme,
// as contact does: h f(x, v) is added to b, its derivative, h (c + s k) w wᵀ with the weights w of the point's nodes, to
// A. Both are of one tetrahedron, whose nodes A joins already, so contact meets the spring with the rest of A. Where no
// one pulls nothing is done.
#pragma once

#include "engine/bodies/deformable_body.hpp"

namespace impinge {

/// Adds its impulse over the sub-step at v (over all nodes), kg m/s, times `factor`. Returns the impulse.
Vec3 add_pull(const DeformableBody& body, const DeformableStep& step, const VecX& v, double factor, VecX& impulse);
/// What it adds to the incremental potential at v, whose gradient is minus that, kg m²/s².
double pull_potential(const DeformableBody& body, const DeformableStep& step, const VecX& v);
/// Adds its part of A.
void add_pull_to_system(const DeformableBody& body, DeformableStep& step);
/// For a scheme with A = M: as if the point had a part of the mass of its nodes and were solved for implicitly. The force
/// is then never more than that mass bears, and damps without turning the motion round.
void add_limited_pull(const DeformableBody& body, const DeformableStep& step, VecX& impulse);

}  // namespace impinge
