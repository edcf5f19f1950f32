#include "engine/algebra/tile_product.hpp"

#include <cstring>

// One kernel for each width of vectors, chosen when the program starts. Sanitizers can't be there so early.
#if defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define IMPINGE_BY_VECTOR_WIDTH __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define IMPINGE_BY_VECTOR_WIDTH
#endif

namespace impinge {
namespace {

using Eight = double __attribute__((vector_size(kTileRows * sizeof(double))));

IMPINGE_BY_VECTOR_WIDTH void multiply_tile(const double* a, const double* b, int depth, double* t, std::size_t stride) {
  Eight s0 = {}, s1 = {}, s2 = {}, s3 = {}, s4 = {}, s5 = {};  // named, so that they stay in registers
  for (int k = 0; k < depth; ++k, a += kTileRows, b += kTileColumns) {
    Eight column;
    std::memcpy(&column, a, sizeof column);
    s0 += column * b[0], s1 += column * b[1], s2 += column * b[2];
    s3 += column * b[3], s4 += column * b[4], s5 += column * b[5];
  }
  const Eight sums[] = {s0, s1, s2, s3, s4, s5};
  for (int j = 0; j < kTileColumns; ++j) std::memcpy(t + j * stride, &sums[j], sizeof sums[j]);
}

}  // namespace

void TileRows::resize(int rows, int depth) {
  tiles_ = (rows + kTileRows - 1) / kTileRows;
  depth_ = depth;
  values_.assign(static_cast<std::size_t>(tiles_) * depth_ * kTileRows, 0.0);
}

void tile_product(const TileRows& a, int first, const double* b, double* t) {
  const std::size_t stride = static_cast<std::size_t>(a.tiles()) * kTileRows;
  for (int tile = first; tile < a.tiles(); ++tile)
    multiply_tile(a.tile(tile), b, a.depth(), t + static_cast<std::size_t>(tile) * kTileRows, stride);
}

}  // namespace impinge
