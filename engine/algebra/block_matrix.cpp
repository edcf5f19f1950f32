#include "engine/algebra/block_matrix.hpp"

#include <algorithm>

#include "engine/core/error.hpp"
#include "engine/core/parallel.hpp"

namespace impinge {
namespace {

// rows a task takes: some 50 µs of work, well above what starting a task costs
constexpr std::size_t kRowsPerTask = 512;
// numbers summed by one task of a dot product; part of the result's definition (it fixes the order of summation)
constexpr Eigen::Index kDotPiece = 8192;

/// Fills diagonal and mirror of a pattern that has its columns.
void finish(BlockPattern& p) {
  p.diagonal.resize(p.rows);
  p.mirror.resize(p.column.size());
  for (int i = 0; i < p.rows; ++i) p.diagonal[i] = p.find(i, i);
  for (int i = 0; i < p.rows; ++i)
    for (int k = p.begin[i]; k < p.begin[i + 1]; ++k) p.mirror[k] = p.find(p.column[k], i);
}

}  // namespace

int BlockPattern::find(int i, int j) const {
  const auto first = column.begin() + begin[i], last = column.begin() + begin[i + 1];
  const auto at = std::lower_bound(first, last, j);
  return at != last && *at == j ? static_cast<int>(at - column.begin()) : -1;
}

BlockPattern make_block_pattern(int rows, std::span<const std::array<int, 4>> groups) {
  BlockPattern p;
  p.rows = rows;
  // groups round each node first: a node's row is the union of few short lists
  std::vector<int> start(rows + 1, 0);
  for (const auto& group : groups)
    for (const int i : group) ++start[i + 1];
  for (int i = 0; i < rows; ++i) start[i + 1] += start[i];
  std::vector<int> member(start[rows]), cursor(start.begin(), start.end() - 1);
  for (std::size_t g = 0; g < groups.size(); ++g)
    for (const int i : groups[g]) member[cursor[i]++] = static_cast<int>(g);

  p.begin.assign(1, 0);
  std::vector<int> row;
  for (int i = 0; i < rows; ++i) {
    row.assign(1, i);
    for (int k = start[i]; k < start[i + 1]; ++k)
      row.insert(row.end(), groups[member[k]].begin(), groups[member[k]].end());
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
    p.column.insert(p.column.end(), row.begin(), row.end());
    p.begin.push_back(static_cast<int>(p.column.size()));
  }
  finish(p);
  return p;
}

BlockPattern block_pattern_of_rows(std::vector<int> begin, std::vector<int> column) {
  BlockPattern p;
  p.rows = static_cast<int>(begin.size()) - 1;
  p.begin = std::move(begin);
  p.column = std::move(column);
  finish(p);
  return p;
}

BlockPattern sub_pattern(const BlockPattern& pattern, std::span<const int> new_index, std::vector<int>& source) {
  BlockPattern p;
  p.begin.assign(1, 0);
  source.clear();
  for (int i = 0; i < pattern.rows; ++i) {
    if (new_index[i] < 0) continue;
    IMPINGE_ASSERT(new_index[i] == p.rows);
    ++p.rows;
    for (int k = pattern.begin[i]; k < pattern.begin[i + 1]; ++k) {
      if (new_index[pattern.column[k]] < 0) continue;
      p.column.push_back(new_index[pattern.column[k]]);
      source.push_back(k);
    }
    p.begin.push_back(static_cast<int>(p.column.size()));
  }
  finish(p);
  return p;
}

bool BlockMatrix::all_finite() const {
  return std::all_of(values.begin(), values.end(), [](const Mat3& block) { return block.allFinite(); });
}

void multiply(const BlockMatrix& a, const VecX& x, VecX& y) {
  const BlockPattern& p = *a.pattern;
  y.resize(3 * p.rows);
  const double* in = x.data();
  const auto rows = [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      double s0 = 0.0, s1 = 0.0, s2 = 0.0;
      for (int k = p.begin[i]; k < p.begin[i + 1]; ++k) {
        const double* m = a.values[k].data();
        const double* v = in + 3 * p.column[k];
        s0 += m[0] * v[0] + m[3] * v[1] + m[6] * v[2];
        s1 += m[1] * v[0] + m[4] * v[1] + m[7] * v[2];
        s2 += m[2] * v[0] + m[5] * v[1] + m[8] * v[2];
      }
      y[3 * i] = s0;
      y[3 * i + 1] = s1;
      y[3 * i + 2] = s2;
    }
  };
  const std::size_t tasks = (p.rows + kRowsPerTask - 1) / kRowsPerTask;
  parallel_for(tasks, 1,
               [&](std::size_t t) { rows(t * kRowsPerTask, std::min<std::size_t>((t + 1) * kRowsPerTask, p.rows)); });
}

VecX operator*(const BlockMatrix& a, const VecX& x) {
  VecX y;
  multiply(a, x, y);
  return y;
}

double dot(const VecX& x, const VecX& y) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < x.size(); i += kDotPiece) {
    const Eigen::Index n = std::min(kDotPiece, x.size() - i);
    sum += x.segment(i, n).dot(y.segment(i, n));
  }
  return sum;
}

LowerTriangle::LowerTriangle(const BlockPattern& p) : matrix_(3 * p.rows, 3 * p.rows) {
  // column 3j + c of the lower triangle is row j of blocks read across (A is symmetric): entries below the diagonal
  std::vector<int> outer(3 * p.rows + 1, 0);
  for (int j = 0; j < p.rows; ++j) {
    const int below = p.begin[j + 1] - p.diagonal[j] - 1;
    for (int c = 0; c < 3; ++c) outer[3 * j + c + 1] = outer[3 * j + c] + (3 - c) + 3 * below;
  }
  matrix_.resizeNonZeros(outer.back());
  std::fill_n(matrix_.valuePtr(), outer.back(), 0.0);
  std::copy(outer.begin(), outer.end(), matrix_.outerIndexPtr());
  int* inner = matrix_.innerIndexPtr();
  for (int j = 0; j < p.rows; ++j)
    for (int c = 0; c < 3; ++c) {
      for (int r = c; r < 3; ++r) *inner++ = 3 * j + r;
      for (int k = p.diagonal[j] + 1; k < p.begin[j + 1]; ++k)
        for (int r = 0; r < 3; ++r) *inner++ = 3 * p.column[k] + r;
    }
}

bool LowerTriangle::refill(const BlockMatrix& a) {
  const BlockPattern& p = *a.pattern;
  IMPINGE_ASSERT(matrix_.rows() == a.rows());
  std::vector<char> changed(p.rows, 0);
  const auto fill = [&](std::size_t j) {
    bool differs = false;
    for (int c = 0; c < 3; ++c) {
      double* out = matrix_.valuePtr() + matrix_.outerIndexPtr()[3 * j + c];
      const auto put = [&](double value) {
        differs = differs || !(*out == value);
        *out++ = value;
      };
      for (int r = c; r < 3; ++r) put(a.values[p.diagonal[j]](r, c));
      // block (i, j) below the diagonal is the transpose of (j, i)
      for (int k = p.diagonal[j] + 1; k < p.begin[j + 1]; ++k)
        for (int r = 0; r < 3; ++r) put(a.values[k](c, r));
    }
    changed[j] = differs;
  };
  parallel_for(p.rows, kRowsPerTask, fill);
  return std::find(changed.begin(), changed.end(), 1) != changed.end();
}

}  // namespace impinge
