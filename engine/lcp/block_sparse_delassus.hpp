// W as its nonzero 3 x 3 blocks, row by row. What it stores is what it is: W need not be symmetric to the last digit.
#pragma once

#include "engine/lcp/cone_problem.hpp"

namespace impinge {

class BlockSparseDelassus : public Delassus {
 public:
  struct Block {
    int row, column;
    Mat3 value;
  };
  /// Blocks of a contacts x contacts operator in any order, each place at most once.
  BlockSparseDelassus(std::size_t contacts, std::vector<Block> blocks);

  std::size_t contacts() const override { return diagonal_.size(); }
  const Mat3& diagonal(std::size_t i) const override { return diagonal_[i]; }
  void begin(const std::vector<Vec3>& lambda) override { lambda_ = lambda; }
  Vec3 row(std::size_t i, bool normal_only) const override;
  void change(std::size_t i, const Vec3& delta, bool) override { lambda_[i] += delta; }
  MatX dense() override;
  const std::vector<Block>& blocks() const { return blocks_; }

 private:
  std::vector<Block> blocks_;  // by row, then column
  std::vector<std::size_t> begin_;
  std::vector<Mat3> diagonal_;
  std::vector<Vec3> lambda_;
};

}  // namespace impinge
