// The packed product against sums that are written out: the same order, so the same bits.
#include "engine/algebra/tile_product.hpp"

#include <catch2/catch.hpp>

#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

TEST_CASE("a product by tiles has the bits of sums in order, for any rows and depth") {
  Random random(3);
  for (const int rows : {1, 6, 8, 9, 48, 102})
    for (const int depth : {0, 1, 6, 48}) {
      CAPTURE(rows, depth);
      TileRows a;
      a.resize(7, 5);
      a.at(6, 4) = 1.0;  // nothing of what it held stays
      a.resize(rows, depth);
      std::vector<std::vector<double>> plain(rows, std::vector<double>(depth));
      for (int r = 0; r < rows; ++r)
        for (int k = 0; k < depth; ++k) a.at(r, k) = plain[r][k] = random.sym();
      std::vector<double> b(static_cast<std::size_t>(depth) * kTileColumns + 1);
      for (double& x : b) x = random.sym();
      const int first = a.tiles() / 2;
      const std::size_t stride = static_cast<std::size_t>(a.tiles()) * kTileRows;
      std::vector<double> t(kTileColumns * stride, -7.0);
      tile_product(a, first, b.data(), t.data());
      for (std::size_t r = 0; r < stride; ++r)
        for (int j = 0; j < kTileColumns; ++j) {
          double sum = 0.0;
          for (int k = 0; k < depth; ++k)
            if (r < static_cast<std::size_t>(rows))
              sum += plain[r][k] * b[static_cast<std::size_t>(k) * kTileColumns + j];
          const bool is_untouched = r < static_cast<std::size_t>(first) * kTileRows;
          CHECK(t[static_cast<std::size_t>(j) * stride + r] == (is_untouched ? -7.0 : sum));
        }
    }
}
