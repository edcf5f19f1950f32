// Newton's system over velocities: where W = J K⁻¹ Jᵀ, (A W + B) x = b is x = B⁻¹ (b - A J s) with
// (K + Jᵀ B⁻¹ A J) s = Jᵀ B⁻¹ b, whose size knows nothing of the contacts' number. B must be regular where kept.
#pragma once

#include <Eigen/LU>
#include <limits>

#include "engine/lcp/newton_system.hpp"

namespace impinge {

/// Space: BodySpace or NodeSpace.
template <class Space>
class SystemOfVelocities : public NewtonSystem {
 public:
  explicit SystemOfVelocities(const Space& space, std::size_t contacts)
      : space_(space), by_u_(contacts), inverse_(contacts) {}

  void factorize(std::span<const Mat3> a, std::span<const Mat3> b, const std::vector<char>& kept) override {
    a_.assign(a.begin(), a.end()), b_.assign(b.begin(), b.end());
    for (std::size_t i = 0; i < by_u_.size(); ++i) {
      // where both bodies are held A is 0 too, and x has no effect
      const bool known = !kept[i] || a[i].isZero(0.0);
      inverse_[i] = known ? Mat3(Mat3::Identity()) : Mat3(b[i].inverse());
      by_u_[i] = known ? Mat3(Mat3::Zero()) : Mat3(inverse_[i] * a[i]);
    }
    factorize_velocities(by_u_);
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

 protected:
  /// K + Jᵀ G J with G by contact.
  virtual void factorize_velocities(std::span<const Mat3> g) = 0;
  virtual void solve_velocities(VecX& s) const = 0;
  /// s = K⁻¹ s.
  virtual void free_velocities(VecX& s) const = 0;

  const Space& space_;

 private:
  static constexpr int kRefinements = 6;  // where B is small 1 / B takes digits, which come back
  static constexpr double kExact = 1e-9;  // of b
  static constexpr double kUseful = 0.5;  // a solution that leaves more of b is none

  static auto part(std::size_t i) { return 3 * static_cast<Eigen::Index>(i); }

  void solve_once(const VecX& b, VecX& x) const {
    x.resize(b.size());
    for (std::size_t i = 0; i < by_u_.size(); ++i) x.segment<3>(part(i)) = inverse_[i] * b.segment<3>(part(i));
    VecX s = push(x);
    solve_velocities(s);
    for (std::size_t i = 0; i < by_u_.size(); ++i) x.segment<3>(part(i)) -= by_u_[i] * space_.relative(i, s);
  }

  /// (A W + B) x.
  VecX product(const VecX& x) const {
    VecX v = push(x), y(x.size());
    free_velocities(v);
    for (std::size_t i = 0; i < by_u_.size(); ++i)
      y.segment<3>(part(i)) = a_[i] * space_.relative(i, v) + b_[i] * x.segment<3>(part(i));
    return y;
  }

  /// Jᵀ x.
  VecX push(const VecX& x) const {
    VecX s = space_.no_velocities();
    for (std::size_t i = 0; i < by_u_.size(); ++i) space_.push(i, x.segment<3>(part(i)), s);
    return s;
  }

  std::vector<Mat3> a_, b_, by_u_, inverse_;  // A, B, B⁻¹ A, B⁻¹
};

}  // namespace impinge
