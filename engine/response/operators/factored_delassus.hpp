// W = J B⁻¹ J^T of a group, kept as factors, where B is block diagonal: A itself for rigid bodies (6 x 6 a body), and
// for deformable bodies a 3 x 3 block a node (what iterative constraint anticipation puts in A's place). B⁻¹ J^T λ is
// carried by body and node, so a row costs the few nodes it touches however many contacts there are; only diagonal
// blocks are stored.
#pragma once

#include "engine/contact/group_system.hpp"
#include "engine/lcp/body_space.hpp"
#include "engine/lcp/cone_problem.hpp"

namespace impinge {

/// Inverse diagonal blocks of every deformable body's A, 1/kg, by body and node.
std::vector<std::vector<Mat3>> inverse_node_blocks(const GroupSystem& group);

class FactoredDelassus : public Delassus {
 public:
  /// Refers to `group`, and writes its Δv (B⁻¹ J^T λ). node_inverse: for each deformable body the inverse blocks of its
  /// free nodes, 1/kg; it must outlive this.
  explicit FactoredDelassus(GroupSystem& group, const std::vector<std::vector<Mat3>>* node_inverse = nullptr);

  bool has_factors() const override { return true; }
  const BodySpace* body_space() override;
  std::size_t contacts() const override { return diagonal_.size(); }
  const Mat3& diagonal(std::size_t i) const override { return diagonal_[i]; }
  void begin(const std::vector<Vec3>& lambda) override;
  Vec3 row(std::size_t i, bool normal_only) const override;
  void change(std::size_t i, const Vec3& delta, bool normal_only) override;

 private:
  // A⁻¹ J^T of one rigid body in one contact: what a unit impulse along each row does to its velocities
  struct RigidSide {
    Mat3 linear = Mat3::Zero(), angular = Mat3::Zero();  // 3 x 3, a column a row of J
    Mat3 arm = Mat3::Zero();                             // rows r x d: J's angular part
  };
  GroupSystem& group_;
  const std::vector<std::vector<Mat3>>* node_inverse_;
  std::vector<Mat3> diagonal_;
  std::vector<std::array<RigidSide, 2>> sides_;
  std::unique_ptr<BodySpace> body_space_;  // once it is asked for
};

}  // namespace impinge
