// The elliptic functions that the free rotation of a rigid body is made of.
#pragma once

#include <array>

namespace impinge {

/// Jacobi's sn, cn and dn of one modulus k, by descending Landen steps along the arithmetic-geometric mean. The modulus
/// is given by its complement: near k = 1 that is what has the digits. [Bulirsch65]
class JacobiFunctions {
 public:
  struct Values {
    double sn, cn, dn;
  };

  /// `complement`: k'² = 1 - k², in [1e-300, 1].
  explicit JacobiFunctions(double complement);

  /// K: sn and cn change their sign every 2 K, dn has that for its period.
  double quarter_period() const;
  /// For |u| <= K.
  Values at(double u) const;

 private:
  static constexpr int kMostSteps = 16;  // the mean of 1 and 1e-150 takes ten
  std::array<double, kMostSteps> a_, b_;
  int steps_ = 0;
  double mean_ = 0.0;
};

/// Carlson's R_J(x, y, z, p) = 3/2 ∫ dt / ((t + p) √((t + x)(t + y)(t + z))) over t > 0, by duplication. For
/// 0 <= x <= p and y, z, p > 0 with (p - y)(p - z) >= 0, which is where nothing in it cancels. [Carlson95]
double carlson_rj(double x, double y, double z, double p);

}  // namespace impinge
