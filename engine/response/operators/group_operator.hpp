// A of a whole group as an operator, with springs between bodies added: (A + J^T H J) x = b, never assembled.
#pragma once

#include "engine/contact/group_system.hpp"

namespace impinge {

/// x holds (v, ω) of each rigid body, then the free nodes of each deformable one.
class GroupOperator {
 public:
  explicit GroupOperator(const GroupSystem& group);

  Eigen::Index size() const { return size_; }
  /// A x.
  VecX multiply(const VecX& x) const;
  /// J x of contact i.
  Vec3 row(std::size_t i, const VecX& x) const;
  /// y += J_i^T λ.
  void add_impulse(std::size_t i, const Vec3& lambda, VecX& y) const;
  /// J_i D⁻¹ J_i^T with D the diagonal blocks of A.
  Mat3 block_mobility(std::size_t i) const;
  /// D_i with blockdiag(D) ⪰ J A⁻¹ J^T of the contacts that `act`, without a solve: a rigid body counts once for each
  /// of its contacts [Tonge12], a node for the weights that contacts have in it, as if it were a body by itself: A is
  /// above its mass, the sum of its row of A.
  std::vector<Mat3> shared_mobility(const std::vector<char>& act) const;
  /// Largest eigenvalue of the normal rows of J A⁻¹ J^T of those contacts against the diagonal of J D⁻¹ J^T, by power
  /// iteration: from below.
  double largest_normal_eigenvalue(const std::vector<char>& act) const;
  /// x of (A + J^T H J) x = b from where x stands, H a symmetric positive semidefinite block for each contact or empty.
  /// Conjugate gradients with the diagonal blocks as preconditioner; ends at ‖r‖ <= tolerance ‖b‖ in the
  /// preconditioner's norm. False if it didn't get there. `steps` gets how many it made.
  bool solve(const std::vector<Mat3>& h, const VecX& b, double tolerance, VecX& x, int* steps = nullptr) const;
  /// The same for any H, by stabilised bi-conjugate gradients [VanDerVorst92]: sliding friction follows the normal
  /// impulse, not the other way about. Ends at ‖r‖ <= tolerance ‖b‖ as they stand.
  bool solve_unsymmetric(const std::vector<Mat3>& h, const VecX& b, double tolerance, VecX& x,
                         int* steps = nullptr) const;
  /// max over nodes and rigid bodies of |D⁻¹ b|, m/s and rad/s.
  double velocity_of(const VecX& b) const;
  /// ‖b‖ in the norm of D⁻¹.
  double norm(const VecX& b) const;
  /// The group's Δv as x.
  VecX load(const GroupSystem& group) const;
  /// x as the group's Δv.
  void store(const VecX& x, GroupSystem& group) const;

 private:
  using Mat6 = Eigen::Matrix<double, 6, 6>;
  struct Blocks {
    std::vector<Mat6> rigid;
    std::vector<std::vector<Mat3>> node;
  };
  Blocks inverse_blocks(const std::vector<Mat3>& h) const;
  VecX precondition(const Blocks& inverse, const VecX& r) const;
  VecX multiply_with_springs(const std::vector<Mat3>& h, const VecX& x) const;
  Eigen::Matrix<double, 3, 6> rigid_row(std::size_t i, const ContactSide& side, double sign) const;

  const GroupSystem& group_;
  std::vector<double> mass_;
  std::vector<Mat3> inertia_;
  std::vector<Eigen::Index> deformable_at_;  // where each deformable body's nodes begin
  Eigen::Index size_ = 0;
  Blocks plain_;
};

}  // namespace impinge
