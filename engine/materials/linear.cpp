// Linear elasticity: small-strain tensor ε = (F + Fᵀ)/2 − I, Ψ = μ ε:ε + λ/2 (tr ε)². Constant stiffness, the cheapest;
// but it takes a rotation for a strain, so a turning body swells: for small rotations only.
#include "engine/materials/warped.hpp"

namespace impinge {
namespace {

class Linear : public Material {
 public:
  bool is_objective() const override { return false; }
  double energy(const TetRest& rest, const Corners& x) const override {
    const Mat3 strain = strain_of(rest, x);
    const double trace = strain.trace();
    const auto [mu, lambda] = lame(rest);
    return rest.volume * (mu * strain.squaredNorm() + 0.5 * lambda * trace * trace);
  }
  void force(const TetRest& rest, const Corners& x, ElementResponse& out) const override {
    const Mat3 strain = strain_of(rest, x);
    const double trace = strain.trace();
    const auto [mu, lambda] = lame(rest);
    out.energy = rest.volume * (mu * strain.squaredNorm() + 0.5 * lambda * trace * trace);
    const Mat3 stress = 2.0 * mu * strain + lambda * trace * Mat3::Identity();
    out.force.noalias() = -rest.volume * (stress * rest.gradient);
  }
  void response(const TetRest& rest, const Corners& x, Tangent, ElementResponse& out) const override {
    force(rest, x, out);
    warped_stiffness(rest, Mat3::Identity(), lame(rest), out);
  }

 private:
  static Mat3 strain_of(const TetRest& rest, const Corners& x) {
    const Mat3 f = deformation_gradient(rest, x);
    return 0.5 * (f + f.transpose()) - Mat3::Identity();
  }
};

}  // namespace

Entry<Material> linear_material() {
  return entry<Material, Linear>("linear", "linear elasticity, for small rotations only");
}

}  // namespace impinge
