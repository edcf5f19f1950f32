// Co-rotational linear elasticity: the small strain is measured in the frame R of the polar decomposition F = R S, so
// Ψ = μ ‖S − I‖² + λ/2 tr²(S − I) [MuellerGross04], the seed's choice [Haapaoja16 §2.1].
//
// Its default tangent is the warped R K Rᵀ: positive semidefinite and cheap, without the terms of ∂R/∂x. The exact and
// the projected one come from the principal stretches: Ψ = μ Σ(σ_i − 1)² + λ/2 (Σσ_i − 3)².
#include "engine/geometry/svd3.hpp"
#include "engine/materials/isotropic.hpp"
#include "engine/materials/warped.hpp"

namespace impinge {
namespace {

class Corotational : public IsotropicMaterial {
 public:
  double density(const Lame& lame, const Vec3& s) const override {
    const double trace = s.sum() - 3.0;
    return lame.mu * (s - Vec3::Ones()).squaredNorm() + 0.5 * lame.lambda * trace * trace;
  }
  Vec3 density_gradient(const Lame& lame, const Vec3& s) const override {
    return 2.0 * lame.mu * (s - Vec3::Ones()) + Vec3::Constant(lame.lambda * (s.sum() - 3.0));
  }
  StretchHessian density_hessian(const Lame& lame, const Vec3& s) const override {
    const double mu = lame.mu, lambda = lame.lambda, trace = s.sum() - 3.0;
    StretchHessian h;
    h.principal = Mat3::Constant(lambda) + 2.0 * mu * Mat3::Identity();
    h.flip.setConstant(2.0 * mu);
    for (int k = 0; k < 3; ++k)
      h.twist[k] = 2.0 * mu + (2.0 * lambda * trace - 4.0 * mu) / twist_denominator(s[(k + 1) % 3] + s[(k + 2) % 3]);
    return h;
  }

  double energy(const TetRest& rest, const Corners& x) const override {
    Mat3 f = deformation_gradient(rest, x), stress;
    return energy_and_stress(rest, f, nearest_rotation(f), stress);
  }
  void force(const TetRest& rest, const Corners& x, ElementResponse& out) const override {
    const Mat3 f = deformation_gradient(rest, x);
    forces(rest, f, nearest_rotation(f), out);
  }
  void response(const TetRest& rest, const Corners& x, Tangent tangent, ElementResponse& out) const override {
    if (wanted(tangent) != Tangent::automatic) return IsotropicMaterial::response(rest, x, tangent, out);
    const Mat3 f = deformation_gradient(rest, x);
    const Mat3 rotation = nearest_rotation(f);
    forces(rest, f, rotation, out);
    warped_stiffness(rest, rotation, lame(rest), out);
  }

 private:
  double energy_and_stress(const TetRest& rest, const Mat3& f, const Mat3& rotation, Mat3& stress) const {
    const auto [mu, lambda] = lame(rest);
    const Mat3 difference = f - rotation;
    const double trace = rotation.cwiseProduct(f).sum() - 3.0;
    stress = 2.0 * mu * difference + lambda * trace * rotation;
    return rest.volume * (mu * difference.squaredNorm() + 0.5 * lambda * trace * trace);
  }
  void forces(const TetRest& rest, const Mat3& f, const Mat3& rotation, ElementResponse& out) const {
    Mat3 stress;
    out.energy = energy_and_stress(rest, f, rotation, stress);
    out.force.noalias() = -rest.volume * (stress * rest.gradient);
  }
};

}  // namespace

Entry<Material> corotational_material() {
  return entry<Material, Corotational>("corotational", "linear elasticity in each element's rotated frame");
}

}  // namespace impinge
