// Q⁻¹ = D⁻¹/c of a deformable body: the inverse of A's block diagonal, scaled so that Q lies above A: c >= λ_max(D⁻¹A).
// On tetrahedral meshes λ_max is 2.2 to 3.2 and never above 4, the nodes of an element; with c = 1 the relaxation
// diverges.
//
// A correction by motions that all nodes share (rigid ones, or those of a coarse grid) was tried: Q⁻¹ + Z (Z^T A Z)⁻¹
// Z^T. It makes the inner problem J Q⁻¹ J^T as badly conditioned as CA's, and sweeps on it stall: more work in all.
#pragma once

#include "engine/contact/group_system.hpp"

namespace impinge {

class NodeInverse {
 public:
  /// Refers to nothing. c = 1 for a body whose A is its block diagonal.
  explicit NodeInverse(const DeformableBlock& block);

  int nodes() const { return static_cast<int>(diagonal_.size()); }
  /// Block of Q⁻¹, 1/kg.
  const Mat3& operator[](int i) const { return scaled_[i]; }
  /// x = y - Q⁻¹ r.
  void step(const VecX& y, const VecX& r, VecX& x) const;
  /// max over nodes of |D⁻¹ r|, m/s.
  double velocity_of(const VecX& r) const;
  /// Q⁻¹ <- Q⁻¹/factor, where Q was found not to lie above A.
  void shrink(double factor);

 private:
  double largest_eigenvalue(const BlockMatrix& a) const;
  std::vector<Mat3> diagonal_, scaled_;
};

}  // namespace impinge
