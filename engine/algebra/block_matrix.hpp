// Symmetric sparse matrices of 3 × 3 blocks whose pattern is made once and whose numbers change every step.
#pragma once

#include <Eigen/SparseCore>
#include <memory>
#include <span>

#include "engine/core/types.hpp"

namespace impinge {

/// Block rows in compressed form; both triangles are stored. Columns of a row ascend; the diagonal is always there.
struct BlockPattern {
  int rows = 0;
  std::vector<int> begin;     ///< rows + 1 entries
  std::vector<int> column;    ///< of each block
  std::vector<int> diagonal;  ///< position of each row's diagonal block
  std::vector<int> mirror;    ///< position of the block (j, i) for each block (i, j)

  int blocks() const { return static_cast<int>(column.size()); }
  /// Position of block (i, j), or −1.
  int find(int i, int j) const;
};

/// Pattern that joins all nodes of each group (the corners of an element) with one another. Indices in [0, rows).
BlockPattern make_block_pattern(int rows, std::span<const std::array<int, 4>> groups);

/// Pattern from its block rows. Each row's columns ascend and hold the diagonal, and (j, i) is there where (i, j) is.
BlockPattern block_pattern_of_rows(std::vector<int> begin, std::vector<int> column);

/// Rows and columns of `pattern` that are kept: node i becomes new_index[i], which is −1 where it goes and ascends
/// otherwise. `source` gets the position in `pattern` of each block of the result.
BlockPattern sub_pattern(const BlockPattern& pattern, std::span<const int> new_index, std::vector<int>& source);

struct BlockMatrix {
  std::shared_ptr<const BlockPattern> pattern;
  std::vector<Mat3> values;  ///< one a block of the pattern

  BlockMatrix() = default;
  explicit BlockMatrix(std::shared_ptr<const BlockPattern> p)
      : pattern(std::move(p)), values(pattern->column.size(), Mat3::Zero()) {}
  int rows() const { return pattern ? 3 * pattern->rows : 0; }
  bool all_finite() const;
};

/// y = A x. The same bits for any number of threads.
void multiply(const BlockMatrix& a, const VecX& x, VecX& y);
VecX operator*(const BlockMatrix& a, const VecX& x);

/// xᵀy, summed in pieces of fixed length: the same bits for any number of threads.
double dot(const VecX& x, const VecX& y);

/// The lower triangle in compressed columns (what sparse factorizations take), and a way to refill its numbers.
class LowerTriangle {
 public:
  explicit LowerTriangle(const BlockPattern& pattern);
  /// Writes the numbers of `a`, whose pattern must be the one this was made with. False if they were there already.
  bool refill(const BlockMatrix& a);
  const Eigen::SparseMatrix<double>& matrix() const { return matrix_; }

 private:
  Eigen::SparseMatrix<double> matrix_;
};

}  // namespace impinge
