// L with L Lᵀ = P A Pᵀ, by supernodes: its numbers, and solving with them.
#pragma once

#include <Eigen/SparseCore>

#include "engine/algebra/dense_product.hpp"
#include "engine/algebra/supernodes.hpp"
#include "engine/core/types.hpp"

namespace impinge {

class SupernodalFactor {
 public:
  /// lower: the lower triangle of A in compressed columns, each entry of which has a place in L.
  SupernodalFactor(Supernodes nodes, const Eigen::SparseMatrix<double>& lower);

  const Supernodes& nodes() const { return nodes_; }
  /// The node's height × width numbers by columns; above the diagonal there is anything.
  DenseColumns columns(int node) const;

  /// From the numbers of `lower`, which has the pattern this was made with. False: not positive definite.
  bool factorize(const Eigen::SparseMatrix<double>& lower);
  /// x = A⁻¹ b.
  void solve(const VecX& b, VecX& x) const;
  void solve(const MatX& b, MatX& x) const;  ///< column by column

 private:
  struct Source {
    int from, to;  // of lower's numbers, to which of the node's
  };
  bool factorize(int node, const Eigen::SparseMatrix<double>& lower, std::vector<MatX>& left);

  template <class Columns>
  void solve_in_place(Columns& x) const;

  Supernodes nodes_;
  std::vector<Source> sources_;
  std::vector<std::size_t> source_begin_;  // of each node
  std::vector<double> values_;
};

}  // namespace impinge
