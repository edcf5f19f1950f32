// What an element's stiffness makes of its motions as a rigid body, taken out of it: for damping, which knows strain rates
// only.
#pragma once

#include "engine/materials/material.hpp"

namespace impinge {

/// P K P in place of the stiffness K, P the projection beside the six rigid motions of the nodes at x. Where K is that of a
/// stressed element it turns motions ω × x into forces, and strain rates into forces with a torque about x: as damping
/// the one would brake spins, the other make them from nothing. P K P is symmetric, and semidefinite where K is; unstressed
/// elements keep theirs.
template <int N>
void leave_rigid_motions(const Eigen::Matrix<double, 3, N>& x, ElementAnswer<N>& out);

extern template void leave_rigid_motions<4>(const Eigen::Matrix<double, 3, 4>&, ElementAnswer<4>&);
extern template void leave_rigid_motions<10>(const Eigen::Matrix<double, 3, 10>&, ElementAnswer<10>&);

}  // namespace impinge
