// The dense product against sums that are written out: the same order in pieces, so the same bits.
#include "engine/algebra/dense_product.hpp"

#include <catch2/catch.hpp>

#include "engine/core/parallel.hpp"
#include "engine/core/types.hpp"
#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

constexpr int kPiece = 128;

double sum_in_pieces(double c, const MatX& a, const MatX& b, int i, int j) {
  for (int from = 0; from < a.cols(); from += kPiece) {
    double sum = 0.0;
    for (int p = from; p < std::min<int>(from + kPiece, static_cast<int>(a.cols())); ++p) sum += a(i, p) * b(p, j);
    c -= sum;
  }
  return c;
}

}  // namespace

TEST_CASE("a dense product has the bits of sums in order, for any shape, stride and threads") {
  Random random(3);
  const auto any = [&](int rows, int columns) {
    return MatX(MatX::NullaryExpr(rows, columns, [&] { return random.sym(); }));
  };
  for (const auto& [m, n, k] :
       {std::tuple(1, 1, 1), {2, 3, 0}, {5, 7, 6}, {16, 8, 8}, {47, 50, 129}, {102, 150, 300}, {203, 99, 129}}) {
    CAPTURE(m, n, k);
    const MatX a = any(m + 3, k), b = any(k + 1, n), c = any(m + 2, n);
    for (const int threads : {1, 0}) {
      set_thread_count(threads);
      MatX made = c;
      subtract_product({a.data() + 3, m + 3}, {b.data() + 1, k + 1}, made.data() + 2, m + 2, m, n, k);
      CHECK(made.topRows(2) == c.topRows(2));
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < m; ++i)
          CHECK(made(i + 2, j) == sum_in_pieces(c(i + 2, j), a.bottomRows(m), b.bottomRows(k), i, j));
      const MatX turned = b.transpose();  // n × (k + 1)
      MatX again = c;
      subtract_transposed({a.data() + 3, m + 3}, {turned.data() + n, n}, again.data() + 2, m + 2, m, n, k);
      CHECK(again == made);
      const int columns = std::min(m, n);
      MatX square = c;
      subtract_square({a.data() + 3, m + 3}, square.data() + 2, m + 2, m, columns, k);
      const MatX own = a.bottomRows(m);
      for (int j = 0; j < columns; ++j)
        for (int i = j; i < m; ++i) CHECK(square(i + 2, j) == sum_in_pieces(c(i + 2, j), own, own.transpose(), i, j));
    }
    set_thread_count(0);
  }
}
