// All that attachments and sliding points ask of the rigid bodies of a group, as one system of equations: a sweep from joint
// to joint loses on a chain what each link hands on to the next, and what it leaves is pulled back by a velocity later,
// with energy from nowhere.
#pragma once

#include <Eigen/SparseCholesky>

#include "engine/response/joint_blocks.hpp"

namespace impinge {

class JointSystem {
 public:
  explicit JointSystem(const GroupSystem& group) : JointSystem(group, joint_blocks(group)) {}
  JointSystem(const GroupSystem& group, std::vector<JointBlock> blocks);

  /// Contacts whose rows are in it, in their order.
  const std::vector<std::size_t>& contacts() const { return contacts_; }
  int place(std::size_t contact) const { return place_[contact]; }  ///< in contacts(); -1: none
  bool holds(std::size_t contact) const { return place_[contact] >= 0; }
  /// Impulses along the rows of these contacts, by place in contacts(), that take velocities u along them away: the smallest,
  /// where some are redundant, and of what contradicts itself what least squares make of it.
  std::vector<Vec3> answer(const std::vector<Vec3>& u) const;

 private:
  VecX solved(const VecX& u) const;

  std::vector<JointBlock> blocks_;
  std::vector<std::size_t> contacts_;
  std::vector<int> place_;            // by contact, in contacts_; -1: none
  std::vector<Eigen::Index> begin_;   // by block, of its unknowns
  Eigen::SparseMatrix<double> rows_;  // B J M^(-1/2)
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors_;
};

}  // namespace impinge
