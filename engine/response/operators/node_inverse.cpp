#include "engine/response/operators/node_inverse.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace impinge {
namespace {

constexpr int kPowerIterations = 10;
constexpr double kSafety = 1.03;  // the power method approaches λ_max from below
constexpr double kBound = 4.0;    // x^T A_e x <= 4 Σ x_i^T A_e,ii x_i for an element of four nodes

}  // namespace

NodeInverse::NodeInverse(const DeformableBlock& block) {
  const BlockMatrix& a = *block.a;
  diagonal_.reserve(a.pattern->rows);
  for (int i = 0; i < a.pattern->rows; ++i) diagonal_.push_back(a.values[a.pattern->diagonal[i]].inverse());
  scaled_ = diagonal_;
  if (!block.is_diagonal) shrink(std::min(kBound, kSafety * largest_eigenvalue(a)));
}

double NodeInverse::largest_eigenvalue(const BlockMatrix& a) const {
  VecX x(a.rows()), y, next;
  const VecX zero = VecX::Zero(a.rows());
  // no symmetry to be caught in
  for (Eigen::Index i = 0; i < x.size(); ++i) x[i] = 1.0 + 0.5 * std::sin(12.9898 * static_cast<double>(i + 1));
  double value = 1.0;
  for (int k = 0; k < kPowerIterations; ++k) {
    multiply(a, x, y);
    step(zero, y, next);
    // Rayleigh's quotient in the inner product of A, in which D⁻¹A is symmetric
    const double size = dot(x, y);
    if (!(size > 0.0)) break;
    value = -dot(next, y) / size;
    x = next / next.norm();
  }
  return value;
}

void NodeInverse::step(const VecX& y, const VecX& r, VecX& x) const {
  x.resize(y.size());
  for (int i = 0; i < nodes(); ++i) x.segment<3>(3 * i) = y.segment<3>(3 * i) - scaled_[i] * r.segment<3>(3 * i);
}

double NodeInverse::velocity_of(const VecX& r) const {
  double largest = 0.0;
  for (int i = 0; i < nodes(); ++i) largest = std::max(largest, (diagonal_[i] * r.segment<3>(3 * i)).squaredNorm());
  return std::sqrt(largest);
}

void NodeInverse::shrink(double factor) {
  for (Mat3& m : scaled_) m /= factor;
}

}  // namespace impinge
