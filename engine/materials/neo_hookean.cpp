// Neo-Hookean elasticity with the classic logarithm, Ψ = μ/2 (Σσ_i² − 3) − μ ln J + λ/2 ln²J, ln J = Σ ln σ_i, safe
// under inversion: below a threshold stretch (0.1 by default) each ln σ_i is continued by its quadratic Taylor
// polynomial L, so Ψ is C² and finite for σ <= 0 (the idea of invertible finite elements [Irving04]). A
// threshold of 0.6 resists inversion less steeply, so more tangled meshes recover, but it changes the answer to
// compression below 0.6.
//
// Why the logarithm and not Ψ itself is continued: a quadratic continuation of Ψ in each stretch is unbounded below
// once the two other stretches exceed about 5, where λ/2 ln²J bends down. With Ψ = μ/2 (Σσ² − 3) − μ ΣL + λ/2 (ΣL)² the
// energy is bounded below, and the rest shape is its only stationary point: Ψ_i = 0 for all i needs σ_i/L'_i equal for
// all, which forces σ = 1.
//
// That holds for one element. A mesh can still be tangled: nodes thrown about may wind round one another so that no
// element is inverted and none at rest, and the logarithm is a wall against unwinding. So elements in a tangle are let
// go until they are free of it (bodies/unwinding.hpp); then nodes placed anywhere at all come back
// (tests/accuracy/fem_dynamics.cpp).
#include "engine/materials/isotropic.hpp"

#include <cmath>

namespace impinge {
namespace {

class NeoHookean : public IsotropicMaterial {
 public:
  void declare(const Rows& rows) override {
    Material::declare(rows);
    rows.add("extension_threshold", threshold_, {1e-3, 0.9}, "",
             "neo_hookean: principal stretch below which the logarithm is continued by its quadratic.");
  }

  bool unwinds() const override { return true; }
  double density(const Lame& lame, const Vec3& s) const override {
    const double log_j = logarithm(s[0]) + logarithm(s[1]) + logarithm(s[2]);
    return lame.mu * (shear_part(s[0]) + shear_part(s[1]) + shear_part(s[2])) + 0.5 * lame.lambda * log_j * log_j;
  }
  Vec3 density_gradient(const Lame& lame, const Vec3& s) const override {
    const Vec3 slope(first(s[0]), first(s[1]), first(s[2]));
    return lame.mu * s + log_weight(lame, s) * slope;
  }
  StretchHessian density_hessian(const Lame& lame, const Vec3& s) const override {
    const double mu = lame.mu, lambda = lame.lambda, weight = log_weight(lame, s);
    const Vec3 slope(first(s[0]), first(s[1]), first(s[2]));
    StretchHessian h;
    h.principal = lambda * slope * slope.transpose();
    for (int k = 0; k < 3; ++k) {
      const int i = (k + 1) % 3, j = (k + 2) % 3;
      h.principal(k, k) += mu + weight * second(s[k]);
      h.flip[k] = mu + weight * slope_quotient(s[i], s[j]);
      h.twist[k] = mu + weight * (slope[i] + slope[j]) / twist_denominator(s[i] + s[j]);
    }
    return h;
  }

 private:
  /// (s² − 1)/2 − L(s), whose two parts are equal but for the square of a small strain.
  double shear_part(double s) const {
    const double strain = s - 1.0;
    if (s < threshold_) return 0.5 * (s * s - 1.0) - logarithm(s);
    return 0.5 * strain * strain + (strain - std::log1p(strain));
  }
  double log_weight(const Lame& lame, const Vec3& s) const {
    return lame.lambda * (logarithm(s[0]) + logarithm(s[1]) + logarithm(s[2])) - lame.mu;
  }
  double logarithm(double s) const {
    const double e = threshold_;
    if (s >= e) return std::log(s);
    const double d = s / e - 1.0;
    return std::log(e) + d - 0.5 * d * d;
  }
  double first(double s) const {
    const double e = threshold_;
    return s >= e ? 1.0 / s : (2.0 - s / e) / e;
  }
  double second(double s) const {
    const double t = std::max(s, threshold_);
    return -1.0 / (t * t);
  }
  /// (L'(a) − L'(b))/(a − b) without the subtraction.
  double slope_quotient(double a, double b) const {
    const double e = threshold_;
    if (a < b) std::swap(a, b);
    if (b >= e) return -1.0 / (a * b);
    if (a <= e) return -1.0 / (e * e);
    const double above = a - e, below = e - b;
    return -(above / (e * a) + below / (e * e)) / (above + below);
  }

  double threshold_ = 0.1;
};

}  // namespace

Entry<Material> neo_hookean_material() {
  return entry<Material, NeoHookean>("neo_hookean", "logarithmic neo-Hookean, safe under inversion");
}

}  // namespace impinge
