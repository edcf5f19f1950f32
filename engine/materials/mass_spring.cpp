// Springs along the six edges of each tetrahedron, with a volume spring where they alone can't reach Poisson's ratio.
//
// Stiffness from E: springs with Σ k l² = C V, spread evenly over all directions, have the energy density C/30 (2 ε:ε +
// tr²ε) (the mean of n n n n over the sphere), that is μ = λ = C/15 and ν = 1/4. So each gets k = C V/(6 l²), and
//   ν <= 1/4: C = 6 E, k = E V/l² [VanGelder98], effective ν = 1/4;
//   ν > 1/4:  C = 15 μ, and λ − μ is carried by (λ − μ)/2 (J − 1)² (volume springs [Teschner04]).
// Edges of a real mesh are not evenly spread, so the measured E differs with direction: along the axes of a lattice of
// cubes cut into six it is 30 % too high, along those of a body-centred cage 15 % too low. No choice of six numbers
// mends that; where moduli matter, take another material.
#include "engine/materials/material.hpp"

#include <cmath>

#include "engine/geometry/tets/tet_mesh.hpp"

namespace impinge {
namespace {

class MassSpring : public Material {
 public:
  double energy(const TetRest& rest, const Corners& x) const override {
    double sum = 0.0;
    for (int e = 0; e < 6; ++e) {
      const double stretch = (x.col(kTetEdges[e][0]) - x.col(kTetEdges[e][1])).norm() - rest.edge_length[e];
      sum += 0.5 * spring(rest, e) * stretch * stretch;
    }
    const double dj = deformation_gradient(rest, x).determinant() - 1.0;
    return sum + 0.5 * volume_modulus(rest) * rest.volume * dj * dj;
  }

  void force(const TetRest& rest, const Corners& x, ElementResponse& out) const override {
    out.energy = energy(rest, x);
    out.force.setZero();
    for (int e = 0; e < 6; ++e) {
      const auto [a, b] = kTetEdges[e];
      const Vec3 edge = x.col(a) - x.col(b);
      const double length = edge.norm();
      if (length == 0.0) continue;  // no direction to push: a point has lost it
      const Vec3 pull = spring(rest, e) * (length - rest.edge_length[e]) / length * edge;
      out.force.col(a) -= pull;
      out.force.col(b) += pull;
    }
    if (volume_modulus(rest) == 0.0) return;
    const Mat3 f = deformation_gradient(rest, x);
    out.force.noalias() -= volume_modulus(rest) * rest.volume * (f.determinant() - 1.0) * (cofactor(f) * rest.gradient);
  }

  void response(const TetRest& rest, const Corners& x, Tangent tangent, ElementResponse& out) const override {
    force(rest, x, out);
    const bool exact = wanted(tangent) == Tangent::exact;
    std::array<Mat3, 6> block;
    for (int e = 0; e < 6; ++e) {
      const auto [a, b] = kTetEdges[e];
      const Vec3 edge = x.col(a) - x.col(b);
      const double length = edge.norm();
      const Vec3 n = length > 0.0 ? Vec3(edge / length) : Vec3::Zero();
      // a compressed spring pushes sideways: negative across its direction, dropped where no indefinite tangent is
      // wanted
      double across = length > 0.0 ? 1.0 - rest.edge_length[e] / length : 0.0;
      if (!exact) across = std::max(across, 0.0);
      block[e] = spring(rest, e) * ((1.0 - across) * n * n.transpose() + across * Mat3::Identity());
    }
    for (Mat3& k : out.stiffness) k.setZero();
    for (int i = 0; i < 10; ++i) {
      const int a = kBlockRow[i], b = kBlockColumn[i];
      for (int e = 0; e < 6; ++e) {
        const bool at_a = kTetEdges[e][0] == a || kTetEdges[e][1] == a;
        const bool at_b = kTetEdges[e][0] == b || kTetEdges[e][1] == b;
        if (at_a && at_b) out.stiffness[i] += a == b ? block[e] : Mat3(-block[e]);
      }
    }
    if (volume_modulus(rest) == 0.0) return;
    const Mat3 f = deformation_gradient(rest, x);
    const Corners g = cofactor(f) * rest.gradient;
    const double scale = volume_modulus(rest) * rest.volume, dj = f.determinant() - 1.0;
    for (int i = 0; i < 10; ++i) {
      const int a = kBlockRow[i], b = kBlockColumn[i];
      out.stiffness[i] += scale * g.col(a) * g.col(b).transpose();
      // ∂²J between corners a and b: x ↦ F (g_b × g_a) as a cross product
      if (exact && a != b)
        out.stiffness[i] += scale * dj * cross_matrix(f * Vec3(rest.gradient.col(b)).cross(Vec3(rest.gradient.col(a))));
    }
  }

 private:
  bool has_volume_springs() const { return settings().poisson > 0.25; }
  /// C/6, Pa.
  double edge_modulus() const { return has_volume_springs() ? 2.5 * settings().mu() : settings().young; }
  /// λ − μ where springs alone don't reach it, Pa.
  double volume_modulus(const TetRest& rest) const {
    return has_volume_springs() ? rest.bulk * (settings().lambda() - settings().mu()) : 0.0;
  }
  /// k = C V/(6 l²), N/m.
  double spring(const TetRest& rest, int e) const {
    return rest.shear * edge_modulus() * rest.volume / (rest.edge_length[e] * rest.edge_length[e]);
  }
  /// ∂ det F/∂F.
  static Mat3 cofactor(const Mat3& f) {
    Mat3 c;
    c.col(0) = f.col(1).cross(f.col(2));
    c.col(1) = f.col(2).cross(f.col(0));
    c.col(2) = f.col(0).cross(f.col(1));
    return c;
  }
  static Mat3 cross_matrix(const Vec3& w) {
    Mat3 m;
    m << 0.0, -w.z(), w.y(), w.z(), 0.0, -w.x(), -w.y(), w.x(), 0.0;
    return m;
  }
};

}  // namespace

Entry<Material> mass_spring_material() {
  return entry<Material, MassSpring>("mass_spring",
                                     "springs along the edges, volume springs above a Poisson's ratio of 1/4");
}

}  // namespace impinge
