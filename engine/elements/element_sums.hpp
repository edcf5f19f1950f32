// Sums of what elements of N nodes answer, over the nodes and the blocks of a pattern: in order of elements, so that
// they don't depend on the number of threads.
#pragma once

#include "engine/algebra/block_matrix.hpp"
#include "engine/materials/material.hpp"

namespace impinge {

template <int N>
class ElementSums {
 public:
  ElementSums() = default;
  /// `pattern` joins all nodes of each element.
  ElementSums(const BlockPattern& pattern, std::span<const std::array<int, N>> elements);

  void gather_forces(std::span<const ElementAnswer<N>> slots, VecX& f) const;
  void gather_stiffness(std::span<const ElementAnswer<N>> slots, BlockMatrix& k) const;

 private:
  // what each node, and each block on or above the diagonal, adds up: codes in order of elements
  std::vector<int> node_begin_, node_code_;    // code: N element + node
  std::vector<int> block_begin_, block_code_;  // code: 2 (kBlocks element + block) + (1 if transposed)
};

extern template class ElementSums<4>;
extern template class ElementSums<10>;

}  // namespace impinge
