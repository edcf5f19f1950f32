#include <Eigen/LU>
#include <limits>

#include "engine/lcp/body_matrix.hpp"
#include "engine/lcp/newton_system.hpp"

namespace impinge {
namespace {

constexpr int kRefinements = 6;  // where B is small 1 / B takes digits, which come back
constexpr double kExact = 1e-9;  // of b
constexpr double kUseful = 0.5;  // a solution that leaves more of b is none

class SystemOfBodies : public NewtonSystem {
 public:
  explicit SystemOfBodies(const BodySpace& bodies)
      : bodies_(bodies), matrix_(bodies), by_u_(bodies.sides.size()), inverse_(bodies.sides.size()) {
    for (const Mat3& inertia : bodies.inertia) inverse_inertia_.push_back(inertia.inverse());
  }

  void factorize(std::span<const Mat3> a, std::span<const Mat3> b, const std::vector<char>& kept) override {
    a_.assign(a.begin(), a.end()), b_.assign(b.begin(), b.end());
    for (std::size_t i = 0; i < by_u_.size(); ++i) {
      // where both bodies are held A is 0 too, and x has no effect
      const bool known = !kept[i] || a[i].isZero(0.0);
      inverse_[i] = known ? Mat3(Mat3::Identity()) : Mat3(b[i].inverse());
      by_u_[i] = known ? Mat3(Mat3::Zero()) : Mat3(inverse_[i] * a[i]);
    }
    matrix_.factorize(by_u_);
  }

  void solve(const VecX& b, VecX& x) const override {
    solve_once(b, x);
    VecX rest = b - product(x), better, more;
    double size = rest.norm();
    for (int k = 0; k < kRefinements && size > kExact * b.norm(); ++k) {
      solve_once(rest, more);
      better = x + more;
      rest = b - product(better);
      const double now = rest.norm();
      if (!(now < size)) break;
      x = better;
      const bool slow = now > 0.5 * size;
      size = now;
      if (slow) break;
    }
    if (!(size < kUseful * b.norm())) x.setConstant(std::numeric_limits<double>::quiet_NaN());
  }

 private:
  void solve_once(const VecX& b, VecX& x) const {
    x.resize(b.size());
    for (std::size_t i = 0; i < by_u_.size(); ++i)
      x.segment<3>(3 * static_cast<Eigen::Index>(i)) = inverse_[i] * b.segment<3>(3 * static_cast<Eigen::Index>(i));
    VecX s = push(x);
    matrix_.solve(s);
    for (std::size_t i = 0; i < by_u_.size(); ++i)
      x.segment<3>(3 * static_cast<Eigen::Index>(i)) -= by_u_[i] * bodies_.relative(i, s);
  }

  /// (A W + B) x.
  VecX product(const VecX& x) const {
    VecX v = push(x), y(x.size());
    for (std::size_t body = 0; body < bodies_.mass.size(); ++body) {
      const auto at = static_cast<Eigen::Index>(6 * body);
      v.segment<3>(at) /= bodies_.mass[body];
      v.segment<3>(at + 3) = inverse_inertia_[body] * v.segment<3>(at + 3);
    }
    for (std::size_t i = 0; i < by_u_.size(); ++i)
      y.segment<3>(3 * static_cast<Eigen::Index>(i)) =
          a_[i] * bodies_.relative(i, v) + b_[i] * x.segment<3>(3 * static_cast<Eigen::Index>(i));
    return y;
  }

  /// Jᵀ x.
  VecX push(const VecX& x) const {
    VecX s = bodies_.no_velocities();
    for (std::size_t i = 0; i < by_u_.size(); ++i) bodies_.push(i, x.segment<3>(3 * static_cast<Eigen::Index>(i)), s);
    return s;
  }

  const BodySpace& bodies_;
  BodyMatrix matrix_;
  std::vector<Mat3> inverse_inertia_, a_, b_, by_u_, inverse_;  // M⁻¹'s, A, B, B⁻¹ A, B⁻¹
};

}  // namespace

std::unique_ptr<NewtonSystem> newton_system_of_bodies(const BodySpace& bodies) {
  return std::make_unique<SystemOfBodies>(bodies);
}

}  // namespace impinge
