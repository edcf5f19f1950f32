// The nodes of a deformable body that contacts touch, and A⁻¹ between them: with it impulses at a surface lead to that
// surface's velocities, whatever lies behind it. Its inverse is A's Schur complement on them.
#pragma once

#include "engine/contact/group_system.hpp"

namespace impinge {

/// Free nodes by deformable body, ascending.
std::vector<std::vector<int>> touched_nodes(const GroupSystem& group);

/// Throws DivergenceError where A is not positive definite.
void factorize(const DeformableBlock& block);

/// Of a factorized body, for columns C: Cᵀ A⁻¹ C, 1/kg where they are impulses. Throws as factorize() does.
MatX gram_of(const DeformableBlock& block, const SparseColumns& columns);

/// A⁻¹ between those nodes, 3 x 3 a pair of them, 1/kg.
MatX inverse_between(const DeformableBlock& block, const std::vector<int>& nodes);

}  // namespace impinge
