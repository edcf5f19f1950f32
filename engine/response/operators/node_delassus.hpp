// W = J A⁻¹ J^T of a group with deformable bodies, kept as factors: of those bodies A⁻¹ between the nodes that contacts
// touch, of rigid ones six numbers. Contacts may be many more than nodes: a row costs the nodes it touches, a change of
// λ the nodes of the body.
#pragma once

#include "engine/contact/group_system.hpp"
#include "engine/lcp/cone_problem.hpp"
#include "engine/lcp/node_space.hpp"

namespace impinge {

class NodeDelassus : public Delassus {
 public:
  /// `nodes`: touched_nodes(group). Takes group.between_nodes if it is there, or makes it: factorizes A of every
  /// deformable body that is touched; throws DivergenceError where A is not positive definite.
  NodeDelassus(GroupSystem& group, const std::vector<std::vector<int>>& nodes);

  std::size_t contacts() const override { return diagonal_.size(); }
  const Mat3& diagonal(std::size_t i) const override { return diagonal_[i]; }
  void begin(const std::vector<Vec3>& lambda) override;
  Vec3 row(std::size_t i, bool normal_only) const override;
  void change(std::size_t i, const Vec3& delta, bool normal_only) override;
  const NodeSpace* node_space() override { return &space_; }

 private:
  void find_touches(const GroupSystem& group, const std::vector<std::vector<int>>& nodes);
  Mat3 block_of(std::size_t i) const;

  std::shared_ptr<const std::vector<MatX>> between_nodes_;  // A⁻¹, by deformable body
  NodeSpace space_;
  std::vector<int> part_of_;  // of space_, by touched node
  std::unique_ptr<InverseMasses> free_;
  VecX velocity_;  // K⁻¹ J^T λ
  std::vector<Mat3> diagonal_;
};

}  // namespace impinge
