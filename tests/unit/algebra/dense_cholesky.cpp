#include "engine/algebra/dense_cholesky.hpp"

#include <Eigen/Cholesky>
#include <catch2/catch.hpp>

#include "engine/core/parallel.hpp"
#include "engine/core/types.hpp"
#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

MatX random_dense(int rows, int columns, Random& random) {
  return MatX::NullaryExpr(rows, columns, [&] { return random.sym(); });
}

MatX random_definite(int n, Random& random) {
  const MatX r = random_dense(n, n, random);
  return r * r.transpose() + 0.1 * n * MatX::Identity(n, n);
}

/// With `work` on one thread, and again on all: equal to the bit.
template <class Work>
MatX on_any_threads(Work work) {
  set_thread_count(1);
  const MatX one = work();
  set_thread_count(2);
  const MatX two = work();
  set_thread_count(0);
  CHECK(MatX(one.triangularView<Eigen::Lower>()) == MatX(two.triangularView<Eigen::Lower>()));
  return one;
}

}  // namespace

TEST_CASE("columns of a dense matrix are factorized as Eigen does the whole, with the rows below them") {
  Random random(31);
  for (const auto& [height, width] :
       {std::pair(1, 1), {3, 1}, {5, 5}, {7, 4}, {20, 9}, {61, 47}, {130, 49}, {301, 100}, {999, 150}}) {
    CAPTURE(height, width);
    const MatX a = random_definite(height, random);
    const MatX made = on_any_threads([&] {
      MatX columns = a.leftCols(width);
      CHECK(factorize_columns(columns.data(), height, width));
      return columns;
    });
    const MatX truth = a.llt().matrixL();
    const MatX difference = made - truth.leftCols(width);
    CHECK(MatX(difference.triangularView<Eigen::Lower>()).cwiseAbs().maxCoeff() <= 1e-13 * truth.cwiseAbs().maxCoeff());
  }
}

TEST_CASE("a dense matrix with a pivot that is not positive is not factorized, wherever it is") {
  Random random(32);
  const MatX a = random_definite(110, random);
  for (const int bad : {0, 2, 5, 47, 48, 100, 109}) {
    CAPTURE(bad);
    MatX m = a;
    m(bad, bad) = -1.0;
    CHECK_FALSE(factorize_columns(m.data(), 110, 110));
    m = a;
    m(bad, bad) = std::numeric_limits<double>::quiet_NaN();
    CHECK_FALSE(factorize_columns(m.data(), 110, 110));
  }
}

TEST_CASE("rows are solved for with a dense triangle") {
  Random random(33);
  for (const auto& [rows, n] : {std::pair(1, 1), {1, 50}, {3, 5}, {9, 48}, {50, 97}, {0, 7}}) {
    CAPTURE(rows, n);
    const MatX l = random_definite(n, random).llt().matrixL();
    const MatX x = random_dense(rows, n, random);
    MatX product = MatX::Constant(rows + 2, n, 7.0);
    product.topRows(rows) = x * l.transpose();
    solve_rows({l.data(), n}, n, product.data(), rows + 2, rows);
    CHECK((product.topRows(rows) - x).norm() <= 1e-12 * (1.0 + x.norm()));
    CHECK((product.bottomRows(2).array() == 7.0).all());
  }
}
