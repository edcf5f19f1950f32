// Materials whose energy density depends on the principal stretches alone, with the generic eigen-system of their
// second derivative (twists, flips and a 3 × 3 matrix of the stretches), so that a new one is an energy and its
// derivatives.
#pragma once

#include "engine/materials/material.hpp"

namespace impinge {

/// Second derivative of an energy density in the frame of the stretches. Pair k is of stretches k+1 and k+2 (mod 3).
struct StretchHessian {
  Mat3 principal;  ///< ∂²Ψ/∂σ_i∂σ_j, Pa
  Vec3 flip;   ///< (Ψ_i − Ψ_j)/(σ_i − σ_j), or its limit Ψ_ii − Ψ_ij, Pa: eigenvalue of a symmetric shear
  Vec3 twist;  ///< (Ψ_i + Ψ_j)/(σ_i + σ_j), Pa: eigenvalue of an antisymmetric shear; singular where σ_i + σ_j = 0
};

class IsotropicMaterial : public Material {
 public:
  double energy(const TetRest& rest, const Corners& x) const override;
  void force(const TetRest& rest, const Corners& x, ElementResponse& out) const override;
  void response(const TetRest& rest, const Corners& x, Tangent tangent, ElementResponse& out) const override;

  // stretches: sorted by size, the last may be negative (rotation_svd); Pa. Each is linear in μ and λ together, and what
  // is given counts, not settings(): an element may ask for one of the two only
  virtual double density(const Lame& lame, const Vec3& stretch) const = 0;
  virtual Vec3 density_gradient(const Lame& lame, const Vec3& stretch) const = 0;
  virtual StretchHessian density_hessian(const Lame& lame, const Vec3& stretch) const = 0;

  /// First Piola–Kirchhoff stress ∂Ψ/∂F, Pa.
  Mat3 stress(const Mat3& f) const;
  /// ∂P/∂F, Pa, 9 × 9 over F's columns one after another; exact or projected.
  Eigen::Matrix<double, 9, 9> stress_derivative(const Mat3& f, Tangent tangent) const;
};

/// σ_i + σ_j, kept away from zero without changing its sign: the twist is singular there.
double twist_denominator(double sum);

}  // namespace impinge
