// Fixed corotated elasticity [Stomakhin12]: Ψ = μ Σ(σ_i − 1)² + λ/2 (J − 1)², J = σ_0 σ_1 σ_2. The volume
// term is that of the true volume, so it holds up under bending and large strain better than the corotational one, and
// it stays finite through inversion. Tangles, which that term would hold together, are let go (bodies/unwinding.hpp).
#include "engine/materials/isotropic.hpp"

namespace impinge {
namespace {

class FixedCorotated : public IsotropicMaterial {
 public:
  bool unwinds() const override { return true; }
  double density(const Lame& lame, const Vec3& s) const override {
    const double dj = s.prod() - 1.0;
    return lame.mu * (s - Vec3::Ones()).squaredNorm() + 0.5 * lame.lambda * dj * dj;
  }
  Vec3 density_gradient(const Lame& lame, const Vec3& s) const override {
    return 2.0 * lame.mu * (s - Vec3::Ones()) + lame.lambda * (s.prod() - 1.0) * cofactors(s);
  }
  StretchHessian density_hessian(const Lame& lame, const Vec3& s) const override {
    const double mu = lame.mu, lambda = lame.lambda, dj = s.prod() - 1.0;
    const Vec3 c = cofactors(s);
    StretchHessian h;
    h.principal = lambda * c * c.transpose();
    h.principal.diagonal().array() += 2.0 * mu;
    for (int k = 0; k < 3; ++k) {
      const int i = (k + 1) % 3, j = (k + 2) % 3;
      const double volume = lambda * dj * s[k];
      h.principal(i, j) += volume;
      h.principal(j, i) += volume;
      h.flip[k] = 2.0 * mu - volume;
      h.twist[k] = 2.0 * mu + volume - 4.0 * mu / twist_denominator(s[i] + s[j]);
    }
    return h;
  }

 private:
  static Vec3 cofactors(const Vec3& s) { return {s[1] * s[2], s[2] * s[0], s[0] * s[1]}; }
};

}  // namespace

Entry<Material> fixed_corotated_material() {
  return entry<Material, FixedCorotated>("fixed_corotated", "corotated shear with the true volume change");
}

}  // namespace impinge
