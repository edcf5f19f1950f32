// L Lᵀ of a symmetric positive definite matrix that gains and loses rows one by one, each in the square of their number:
// what active-set methods solve with in every step [GoldfarbIdnani83].
#pragma once

#include <Eigen/Jacobi>
#include <algorithm>
#include <cmath>

#include "engine/core/types.hpp"

namespace impinge {

class GrowingCholesky {
 public:
  Eigen::Index size() const { return size_; }

  /// L⁻¹ b.
  VecX forward(const VecX& b) const { return l_.topLeftCorner(size_, size_).triangularView<Eigen::Lower>().solve(b); }
  /// L⁻ᵀ b.
  VecX backward(const VecX& b) const {
    return l_.topLeftCorner(size_, size_).transpose().triangularView<Eigen::Upper>().solve(b);
  }

  /// One more row and column, the last: `forward` of the column above its diagonal, and what is left of the diagonal
  /// beside its square, > 0.
  void add(const VecX& row, double rest) {
    if (size_ == l_.rows())
      l_.conservativeResize(std::max<Eigen::Index>(8, 2 * size_), std::max<Eigen::Index>(8, 2 * size_));
    l_.row(size_).head(size_) = row.transpose();
    l_(size_, size_) = std::sqrt(rest);
    ++size_;
  }

  /// Without row and column `at`; those after it move up.
  void remove(Eigen::Index at) {
    --size_;
    for (Eigen::Index c = 0; c <= size_; ++c) {
      const Eigen::Index first = std::max(at, c - 1);  // an entry beside the diagonal comes with each row that moves up
      const Eigen::Index below = size_ - first;
      if (below > 0) l_.col(c).segment(first, below) = l_.col(c).segment(first + 1, below).eval();
    }
    for (Eigen::Index c = at; c < size_; ++c) {
      Eigen::JacobiRotation<double> turn;
      turn.makeGivens(l_(c, c), l_(c, c + 1));
      l_.block(c, 0, size_ - c, l_.cols()).applyOnTheRight(c, c + 1, turn);
      if (l_(c, c) < 0.0) l_.col(c).segment(c, size_ - c) *= -1.0;
    }
  }

 private:
  MatX l_;  // room for more than is there
  Eigen::Index size_ = 0;
};

}  // namespace impinge
