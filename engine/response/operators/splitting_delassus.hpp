// The Delassus operator of a splitting of A: J Q⁻¹ J^T, where Q⁻¹ is a NodeInverse for deformable bodies and A⁻¹ for
// rigid ones. The velocities themselves are carried, by node and by rigid body, so a sweep costs the few nodes that each contact
// touches.
#pragma once

#include "engine/response/operators/node_inverse.hpp"

namespace impinge {

class SplittingDelassus {
 public:
  /// Refers to both. Writes the group's rigid Δv; q: J v* - bound by contact.
  SplittingDelassus(GroupSystem& group, const std::vector<NodeInverse>& inverse, const std::vector<Vec3>& q);

  /// Once more after a NodeInverse has changed.
  void prepare();
  /// Rigid Δv = A⁻¹ J^T λ, afresh.
  void move_rigid(const std::vector<Vec3>& lambda);
  /// One Gauss-Seidel sweep, each contact solved exactly with the others held: moves lambda and x (Δv by deformable
  /// body). Returns what the largest correction did to its own contact, m/s.
  double sweep(std::vector<Vec3>& lambda, std::vector<VecX>& x);
  /// Largest natural map over the contacts at Δv = x, m/s.
  double natural_residual(const std::vector<Vec3>& lambda, const std::vector<VecX>& x) const;
  /// J^T λ on the nodes of each deformable body.
  void impulses(const std::vector<Vec3>& lambda, std::vector<VecX>& f) const;

 private:
  struct Side {
    int rigid = -1, deformable = -1;
    double sign = 1.0;
    int first = 0, last = 0;                          // into node_
    Mat3 arm = Mat3::Zero(), angular = Mat3::Zero();  // rows r x d; inertia⁻¹ times them
  };
  struct Entry {
    int index;
    double weight;  // with the side's sign
  };
  Side make_side(const ContactRows& rows, const ContactSide& from, double sign);
  Vec3 velocity(std::size_t i, const std::vector<VecX>& x) const;
  Vec3 next_impulse(std::size_t i, const Vec3& u, const Vec3& lambda) const;

  GroupSystem& group_;
  const std::vector<NodeInverse>& inverse_;
  const std::vector<Vec3>& q_;
  std::vector<std::array<Side, 2>> sides_;
  std::vector<Entry> node_;
  std::vector<Mat3> diagonal_;
};

}  // namespace impinge
