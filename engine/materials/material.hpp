// What a tetrahedron answers to being deformed: energy, nodal forces and their derivative.
//
// The seam is one element with its four corners (linear shape functions, so the deformation gradient F is constant in
// it). Materials with an energy density of F, warped linear ones and springs along the edges all fit behind it.
#pragma once

#include <string>

#include "engine/core/method.hpp"
#include "engine/core/registry.hpp"
#include "engine/core/types.hpp"

namespace impinge {

/// Columns are the corners' positions, metres (or forces, newtons).
using Corners = Eigen::Matrix<double, 3, 4>;
/// Corner by corner x, y, z.
using Mat12 = Eigen::Matrix<double, 12, 12>;

/// A tetrahedron before it is deformed.
struct TetRest {
  Corners gradient;     ///< column a: gradient of the shape function of corner a, 1/m; F = Σ x_a gradient_aᵀ
  double volume = 0.0;  ///< m³, times the filled fraction: all that energy and force are weighted with
  std::array<double, 6> edge_length;  ///< in the order of kTetEdges, m
  // shares of μ and of λ that count here: elements that take shear and volume at points of their own ask for one of them
  double shear = 1.0, bulk = 1.0;
};

/// What the isotropic laws are made of, Pa.
struct Lame {
  double mu, lambda;
};

/// Which derivative of the force is wanted.
enum class Tangent {
  automatic,  ///< what the material recommends for a linearly implicit step; positive semidefinite
  exact,      ///< −∂f/∂x to rounding; may be indefinite
  projected   ///< the exact one with negative eigenvalues of the element set to zero (never indefinite)
};

/// What every material has; rows of its own a material adds in declare().
struct MaterialSettings {
  double young = 1e5;                    ///< Young's modulus E, Pa
  double poisson = 0.45;                 ///< Poisson's ratio, in (−1, 0.5)
  Tangent tangent = Tangent::automatic;  ///< what Tangent::automatic stands for, unless it is automatic itself

  double mu() const { return young / (2.0 * (1.0 + poisson)); }                                  ///< Lamé, Pa
  double lambda() const { return young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson)); }  ///< Lamé, Pa
};

/// The answer of an element of N nodes. The stiffness is symmetric; only its blocks on and above the diagonal are kept,
/// row by row.
template <int N>
struct ElementAnswer {
  static constexpr int kNodes = N, kBlocks = N * (N + 1) / 2;
  double energy = 0.0;                  ///< J
  Eigen::Matrix<double, 3, N> force;    ///< −∂energy/∂x, N
  std::array<Mat3, kBlocks> stiffness;  ///< ∂²energy/∂x∂x (or its stand-in), N/m
};
/// That of a tetrahedron with its four corners: blocks in the order of kBlockRow, kBlockColumn.
using ElementResponse = ElementAnswer<4>;
inline constexpr std::array<int, 10> kBlockRow = {0, 0, 0, 0, 1, 1, 1, 2, 2, 3};
inline constexpr std::array<int, 10> kBlockColumn = {0, 1, 2, 3, 1, 2, 3, 2, 3, 3};

class Material : public Method {
 public:
  MaterialSettings& settings() { return settings_; }
  const MaterialSettings& settings() const { return settings_; }
  Lame lame() const { return {settings_.mu(), settings_.lambda()}; }
  Lame lame(const TetRest& rest) const { return {settings_.mu() * rest.shear, settings_.lambda() * rest.bulk}; }
  /// Rows of settings(), then the material's own: keys of `material` in a scene, and `body.NAME.material.*`. What is
  /// derived from settings is to be computed where it is used: rows change them while the body moves.
  void declare(const Rows& rows) override;

  /// J.
  virtual double energy(const TetRest& rest, const Corners& x) const = 0;
  /// Energy and force only; the stiffness of `out` is left as it was.
  virtual void force(const TetRest& rest, const Corners& x, ElementResponse& out) const = 0;
  /// Energy, force and stiffness.
  virtual void response(const TetRest& rest, const Corners& x, Tangent tangent, ElementResponse& out) const = 0;

  /// Whether elements in a tangle are let go until they are free of it (bodies/unwinding.hpp): for materials that are
  /// meant to survive inversion and would hold a tangle together.
  virtual bool unwinds() const { return false; }
  /// Whether turning costs no energy: of all but what measures strains in fixed axes.
  virtual bool is_objective() const { return true; }
  /// Principal stretch below which the law yields the more it is pressed, so that what is squeezed further may stay so;
  /// 0: none.
  virtual double collapse_stretch() const { return 0.0; }

 protected:
  /// The request with `automatic` replaced by the setting; still automatic if the setting leaves it to the material.
  Tangent wanted(Tangent tangent) const { return tangent == Tangent::automatic ? settings_.tangent : tangent; }

 private:
  MaterialSettings settings_;
};

const Registry<Material>& materials();

/// Rest data of a tetrahedron of positive volume; `fraction` of it is filled.
TetRest make_tet_rest(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, double fraction = 1.0);

/// F = Σ x_a gradient_aᵀ.
inline Mat3 deformation_gradient(const TetRest& rest, const Corners& x) { return x * rest.gradient.transpose(); }

/// The ten blocks as a whole matrix.
Mat12 full_stiffness(const ElementResponse& response);

}  // namespace impinge
