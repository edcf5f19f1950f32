// Co-rotational elasticity that stiffens as it stretches: Ψ = μ Σ(σ_i − 1)² + λ/2 (Σσ_i − 3)² + κ μ Σ(σ_i − 1)⁴.
#include "engine/materials/isotropic.hpp"

namespace impinge {
namespace {

class Stiffening : public IsotropicMaterial {
 public:
  void declare(const Rows& rows) override {
    Material::declare(rows);
    rows.add("stiffening", stiffening_, {0.0, 1e3}, "", "stiffening: κ, how much a stretch adds to its own stiffness.");
  }

  double density(const Lame& lame, const Vec3& s) const override {
    const Vec3 e = s - Vec3::Ones();
    return lame.mu * e.squaredNorm() + 0.5 * lame.lambda * e.sum() * e.sum() +
           stiffening_ * lame.mu * e.array().square().square().sum();
  }
  Vec3 density_gradient(const Lame& lame, const Vec3& s) const override {
    const Vec3 e = s - Vec3::Ones();
    return 2.0 * lame.mu * e + Vec3::Constant(lame.lambda * e.sum()) +
           4.0 * stiffening_ * lame.mu * e.array().cube().matrix();
  }
  StretchHessian density_hessian(const Lame& lame, const Vec3& s) const override {
    const Vec3 e = s - Vec3::Ones(), gradient = density_gradient(lame, s);
    StretchHessian h;
    h.principal = Mat3::Constant(lame.lambda) + 2.0 * lame.mu * Mat3::Identity();
    for (int k = 0; k < 3; ++k) {
      const int i = (k + 1) % 3, j = (k + 2) % 3;
      h.principal(k, k) += 12.0 * stiffening_ * lame.mu * e[k] * e[k];
      h.flip[k] = 2.0 * lame.mu + 4.0 * stiffening_ * lame.mu * (e[i] * e[i] + e[i] * e[j] + e[j] * e[j]);
      h.twist[k] = (gradient[i] + gradient[j]) / twist_denominator(s[i] + s[j]);
    }
    return h;
  }

 private:
  double stiffening_ = 1.0;
};

}  // namespace

Entry<Material> stiffening_material() {
  return entry<Material, Stiffening>("stiffening", "co-rotational, stiffer the more it is stretched");
}

}  // namespace impinge
