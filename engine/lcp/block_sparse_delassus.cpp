#include "engine/lcp/block_sparse_delassus.hpp"

#include <algorithm>

namespace impinge {

BlockSparseDelassus::BlockSparseDelassus(std::size_t contacts, std::vector<Block> blocks)
    : blocks_(std::move(blocks)),
      begin_(contacts + 1, 0),
      diagonal_(contacts, Mat3::Zero()),
      lambda_(contacts, Vec3::Zero()) {
  std::sort(blocks_.begin(), blocks_.end(),
            [](const Block& l, const Block& r) { return l.row != r.row ? l.row < r.row : l.column < r.column; });
  for (const Block& b : blocks_) {
    ++begin_[b.row + 1];
    if (b.row == b.column) diagonal_[b.row] = b.value;
  }
  for (std::size_t i = 0; i < contacts; ++i) begin_[i + 1] += begin_[i];
}

Vec3 BlockSparseDelassus::row(std::size_t i, bool normal_only) const {
  Vec3 sum = Vec3::Zero();
  if (normal_only) {
    for (std::size_t k = begin_[i]; k < begin_[i + 1]; ++k)
      sum.x() += blocks_[k].value.row(0).dot(lambda_[blocks_[k].column]);
  } else {
    for (std::size_t k = begin_[i]; k < begin_[i + 1]; ++k) sum += blocks_[k].value * lambda_[blocks_[k].column];
  }
  return sum;
}

MatX BlockSparseDelassus::dense() {
  const auto n = static_cast<Eigen::Index>(3 * contacts());
  MatX w = MatX::Zero(n, n);
  for (const Block& b : blocks_) w.block<3, 3>(3 * b.row, 3 * b.column) = b.value;
  return w;
}

}  // namespace impinge
