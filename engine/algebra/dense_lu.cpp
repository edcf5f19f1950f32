// By halves [Toledo97]: the left half of the columns, then the right one less what the left makes of it, and so on down to a
// few. Nearly all work is then in products of matrices.
#include "engine/algebra/dense_lu.hpp"

#include <algorithm>
#include <cmath>

#include "engine/algebra/dense_product.hpp"
#include "engine/core/interrupt.hpp"

namespace impinge {
namespace {

constexpr int kFew = 8;

/// A block of a matrix by columns.
struct Block {
  double* at;
  int rows, columns, stride;
  double* column(int j) const { return at + static_cast<std::ptrdiff_t>(j) * stride; }
  Block from(int row, int column_index, int r, int c) const { return {column(column_index) + row, r, c, stride}; }
};

/// c -= a b.
void subtract(const Block& a, const Block& b, const Block& c) {
  subtract_product({a.at, a.stride}, {b.at, b.stride}, c.at, c.stride, c.rows, c.columns, a.columns);
}

void swap_rows(const Block& a, const int* swaps, int count) {
  for (int j = 0; j < a.columns; ++j) {
    double* column = a.column(j);
    for (int k = 0; k < count; ++k) std::swap(column[k], column[swaps[k]]);
  }
}

/// b = L⁻¹ b with the unit lower triangle of l.
void solve_lower(const Block& l, const Block& b) {
  const int k = l.columns;
  if (k <= kFew) {
    for (int j = 0; j < b.columns; ++j) {
      double* x = b.column(j);
      for (int p = 0; p < k; ++p)
        for (int i = p + 1; i < k; ++i) x[i] -= l.column(p)[i] * x[p];
    }
    return;
  }
  const int half = k / 2;
  const Block top = b.from(0, 0, half, b.columns), bottom = b.from(half, 0, k - half, b.columns);
  solve_lower(l.from(0, 0, half, half), top);
  subtract(l.from(half, 0, k - half, half), top, bottom);
  solve_lower(l.from(half, half, k - half, k - half), bottom);
}

/// Swaps count from the block's first row.
void factorize_few(const Block& a, int* swaps) {
  for (int k = 0; k < a.columns; ++k) {
    double* pivot = a.column(k);
    int largest = k;
    for (int i = k + 1; i < a.rows; ++i)
      if (std::abs(pivot[i]) > std::abs(pivot[largest])) largest = i;
    swaps[k] = largest;
    if (largest != k)
      for (int j = 0; j < a.columns; ++j) std::swap(a.column(j)[k], a.column(j)[largest]);
    for (int i = k + 1; i < a.rows; ++i) pivot[i] /= pivot[k];
    for (int j = k + 1; j < a.columns; ++j) {
      double* column = a.column(j);
      const double factor = column[k];
      for (int i = k + 1; i < a.rows; ++i) column[i] -= pivot[i] * factor;
    }
  }
}

/// At least as many rows as columns.
void factorize(const Block& a, int* swaps) {
  if (a.columns <= kFew) return factorize_few(a, swaps);
  check_interrupt();
  const int half = a.columns / 2, rest = a.columns - half, below = a.rows - half;
  factorize(a.from(0, 0, a.rows, half), swaps);
  const Block right = a.from(0, half, a.rows, rest);
  swap_rows(right, swaps, half);
  solve_lower(a.from(0, 0, half, half), right.from(0, 0, half, rest));
  const Block corner = right.from(half, 0, below, rest), left = a.from(half, 0, below, half);
  subtract(left, right.from(0, 0, half, rest), corner);
  factorize(corner, swaps + half);
  swap_rows(left, swaps + half, rest);
  for (int k = half; k < a.columns; ++k) swaps[k] += half;
}

}  // namespace

void DenseLu::compute(MatX a) {
  lu_ = std::move(a);
  const int n = static_cast<int>(lu_.rows());
  swaps_.assign(static_cast<std::size_t>(n), 0);
  if (n > 0) factorize({lu_.data(), n, n, n}, swaps_.data());
}

VecX DenseLu::solve(const VecX& b) const {
  VecX x = b;
  for (std::size_t k = 0; k < swaps_.size(); ++k) std::swap(x[static_cast<Eigen::Index>(k)], x[swaps_[k]]);
  lu_.triangularView<Eigen::UnitLower>().solveInPlace(x);
  lu_.triangularView<Eigen::Upper>().solveInPlace(x);
  return x;
}

}  // namespace impinge
