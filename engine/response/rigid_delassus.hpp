// W = J A⁻¹ J^T of a group of rigid bodies, kept as factors: Δv = A⁻¹ J^T λ is carried by body, so a row costs two body
// look-ups however many contacts a body has, and nothing is stored but the diagonal blocks.
#pragma once

#include "engine/contact/group_system.hpp"
#include "engine/lcp/cone_problem.hpp"

namespace impinge {

class RigidDelassus : public Delassus {
 public:
  /// Refers to `group`, and writes its delta_velocity and delta_angular_velocity.
  explicit RigidDelassus(GroupSystem& group);

  std::size_t contacts() const override { return diagonal_.size(); }
  const Mat3& diagonal(std::size_t i) const override { return diagonal_[i]; }
  void begin(const std::vector<Vec3>& lambda) override;
  Vec3 row(std::size_t i, bool normal_only) const override;
  void change(std::size_t i, const Vec3& delta, bool normal_only) override;

 private:
  struct Side {  // A⁻¹ J^T of one body in one contact: what a unit impulse along each row does to its velocities
    Mat3 linear = Mat3::Zero(), angular = Mat3::Zero();  // 3 x 3, a column a row of J
    Mat3 arm = Mat3::Zero();                             // rows r x d: J's angular part
  };
  GroupSystem& group_;
  std::vector<Mat3> diagonal_;
  std::vector<std::array<Side, 2>> sides_;
};

}  // namespace impinge
