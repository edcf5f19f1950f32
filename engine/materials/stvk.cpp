// Saint Venant–Kirchhoff: Hooke's law for the Green strain E = (FᵀF − I)/2, in stretches E_i = (σ_i² − 1)/2, Ψ = μ
// ΣE_i² + λ/2 (ΣE_i)². Right for large rotations, wrong for strong compression: it softens below a stretch of 1/√3 and
// lets an element collapse and invert (its energy knows σ² only).
#include <cmath>

#include "engine/materials/isotropic.hpp"

namespace impinge {
namespace {

class SaintVenantKirchhoff : public IsotropicMaterial {
 public:
  double collapse_stretch() const override { return 1.0 / std::sqrt(3.0); }
  double density(const Lame& lame, const Vec3& s) const override {
    const Vec3 strain = green(s);
    const double trace = strain.sum();
    return lame.mu * strain.squaredNorm() + 0.5 * lame.lambda * trace * trace;
  }
  Vec3 density_gradient(const Lame& lame, const Vec3& s) const override {
    const Vec3 strain = green(s);
    return s.cwiseProduct(2.0 * lame.mu * strain + Vec3::Constant(lame.lambda * strain.sum()));
  }
  StretchHessian density_hessian(const Lame& lame, const Vec3& s) const override {
    const double mu = lame.mu, lambda = lame.lambda;
    const double pressure = lambda * green(s).sum() - mu;
    StretchHessian h;
    h.principal = lambda * s * s.transpose();
    h.principal.diagonal() += 3.0 * mu * s.cwiseAbs2() + Vec3::Constant(pressure);
    for (int k = 0; k < 3; ++k) {
      const double a = s[(k + 1) % 3], b = s[(k + 2) % 3];
      h.flip[k] = mu * (a * a + a * b + b * b) + pressure;
      h.twist[k] = mu * (a * a - a * b + b * b) + pressure;
    }
    return h;
  }

 private:
  static Vec3 green(const Vec3& s) { return 0.5 * (s.cwiseAbs2() - Vec3::Ones()); }
};

}  // namespace

Entry<Material> stvk_material() {
  return entry<Material, SaintVenantKirchhoff>("stvk", "Saint Venant-Kirchhoff: large rotations, moderate strains");
}

}  // namespace impinge
