// (A + Jᵀ H J) x = b again and again with another H: by gradients until these have taken as long as a factorization of A
// and W = J A⁻¹ Jᵀ, from then on by those: x = A⁻¹ (b - Jᵀ y) with (H W + 1) y = H J A⁻¹ b [Woodbury50], which is a system
// of Newton's (lcp/newton_system.hpp).
#pragma once

#include <memory>

#include "engine/lcp/newton_system.hpp"
#include "engine/response/operators/group_operator.hpp"

namespace impinge {

class SpringSolver {
 public:
  /// Both outlive it; `a` is of the group. With 0 `patience` it factorizes at once where it can, with a large one never:
  /// times the steps of gradients that are weighed against that.
  SpringSolver(GroupSystem& group, const GroupOperator& a, double patience = 1.0);

  /// x for a symmetric positive semidefinite H, 3 x 3 by contact; gradients end at `tolerance` and begin at 0.
  void solve(const std::vector<Mat3>& h, const VecX& b, double tolerance, VecX& x);
  /// The same for any H.
  void solve_unsymmetric(const std::vector<Mat3>& h, const VecX& b, double tolerance, VecX& x);
  /// A⁻¹ b to `tolerance`. False if it wasn't reached.
  bool free(const VecX& b, double tolerance, VecX& x) const;
  bool is_factorized() const { return system_ != nullptr; }

 private:
  /// Steps of gradients that take as long as A's factorization and W; infinite where A can't be factorized, or W is too
  /// large to be written out.
  double steps_of_factor() const;
  /// And those that a system with this H takes then.
  double steps_of_system(const std::vector<Mat3>& h) const;
  /// A system took so many steps of gradients: what that was more than it need be adds up.
  void weigh(double steps, const std::vector<Mat3>& h);
  void factorize();
  bool solve_by_factor(const std::vector<Mat3>& h, const VecX& b, VecX& x);
  VecX free_by_factor(const VecX& b) const;

  GroupSystem& group_;
  const GroupOperator& a_;
  double left_ = 0.0;  // steps
  std::unique_ptr<Delassus> w_;
  std::unique_ptr<NewtonSystem> system_;  // null: gradients
};

}  // namespace impinge
