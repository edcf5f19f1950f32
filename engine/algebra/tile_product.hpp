// The dense product under a factorization by blocks of six: T = A B, where A comes packed in tiles of eight rows. Every
// number of T is summed in one order whatever vectors the processor has, so all of them make the same bits.
#pragma once

#include <cstddef>
#include <vector>

namespace impinge {

constexpr int kTileRows = 8, kTileColumns = 6;

/// A, column by column in tiles of kTileRows rows; the last is filled up with zeros.
class TileRows {
 public:
  /// `rows` x `depth`, all 0.
  void resize(int rows, int depth);
  int tiles() const { return tiles_; }
  double& at(int row, int column) { return values_[index(row / kTileRows, column) + row % kTileRows]; }
  const double* tile(int t) const { return &values_[index(t, 0)]; }
  int depth() const { return depth_; }

 private:
  std::size_t index(int tile, int column) const {
    return (static_cast<std::size_t>(tile) * depth_ + column) * kTileRows;
  }
  int tiles_ = 0, depth_ = 0;
  std::vector<double> values_;
};

/// T = A B of the tiles from `first` on. B: depth x kTileColumns, row by row. T: column by column, a.tiles() kTileRows
/// numbers each; rows before that tile are not touched.
void tile_product(const TileRows& a, int first, const double* b, double* t);

}  // namespace impinge
