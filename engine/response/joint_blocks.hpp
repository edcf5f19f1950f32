// Attachments and sliding points of the same two rigid bodies as one equation. A sweep that goes from point to point can't
// bring together those of a hinge, which are close to each other: what one gives turns the body at the next.
#pragma once

#include "engine/contact/group_system.hpp"

namespace impinge {

/// Of two rigid bodies, or of one and what doesn't move (-1).
struct JointBlock {
  /// Of the group's contacts, and which of the three rows of one.
  struct Row {
    std::size_t contact;
    int k;
    double sign;  ///< -1: its A is the block's B

    const ContactSide& at_a(const ContactRows& of) const { return sign > 0.0 ? of.a : of.b; }
    const ContactSide& at_b(const ContactRows& of) const { return sign > 0.0 ? of.b : of.a; }
    /// Of the impulse on the block's A.
    Vec3 direction(const ContactRows& of) const { return sign * of.directions.row(k).transpose(); }
  };
  int a, b;
  std::vector<Row> rows = {};
  bool holds_points = false;  ///< not slides alone
  /// What its rows can ask for, each across the others: rows × rank, Bᵀ W B = 1. Two points hold a body in five ways, not in
  /// six. W⁻¹ = B Bᵀ: what redundant rows ask for is met by least squares, by the smallest impulses. √kg
  MatX basis = {};
};

/// B with W⁻¹ = B Bᵀ, as far as W has one.
MatX basis_of(const MatX& w);

/// In the order of their first rows.
std::vector<JointBlock> joint_blocks(const GroupSystem& group);

}  // namespace impinge
