// Stress and strain of each tetrahedron, for display and for reports. Elastic only: what damping adds is left out.
#pragma once

#include "engine/bodies/deformable_body.hpp"

namespace impinge {

/// One tetrahedron as it is deformed now; constant in it.
struct ElementState {
  Mat3 stress;                ///< Cauchy stress in world axes, Pa; tension is positive
  Vec3 stretch;               ///< principal stretches, largest first; the last is negative where it is inverted
  double volume_ratio = 1.0;  ///< J = det F
};

/// σ = −Σ f_a x_aᵀ / (J V) over the corners, made symmetric. That is P Fᵀ/J for a material with a stress P(F), and the
/// mean stress of springs, which have none. Where |J| < 0.01 it is divided by that (a flat element has no finite
/// stress).
ElementState element_state(const DeformableBody& body, int element);

/// √(3/2 s:s), s the deviator of `stress`, Pa: in uniaxial tension the tension itself.
double von_mises(const Mat3& stress);
/// √(2/3 e:e), e the deviator of the strains stretch − 1: in uniaxial tension without change of volume, for small
/// strains, the strain itself. 0 for any rotation and any even growth; defined for inverted elements too.
double equivalent_strain(const Vec3& stretch);

// one number a tetrahedron
std::vector<double> element_von_mises(const DeformableBody& body);    ///< Pa
std::vector<double> element_mean_stress(const DeformableBody& body);  ///< tr σ / 3, Pa: minus the pressure
std::vector<double> element_equivalent_strain(const DeformableBody& body);
std::vector<double> element_volume_ratio(const DeformableBody& body);

/// Mean of the tetrahedra round each node, weighted by their rest volume: what a smooth picture interpolates.
std::vector<double> node_average(const DeformableBody& body, const std::vector<double>& of_elements);

}  // namespace impinge
