#include "engine/algebra/dense_lu.hpp"

#include <Eigen/LU>
#include <catch2/catch.hpp>

#include "engine/algebra/dense_product.hpp"
#include "engine/core/parallel.hpp"
#include "tests/support/random.hpp"

using namespace impinge;

namespace {

MatX random_dense(Eigen::Index rows, Eigen::Index columns, std::uint64_t seed) {
  test::Random random(seed);
  MatX m(rows, columns);
  for (Eigen::Index j = 0; j < columns; ++j)
    for (Eigen::Index i = 0; i < rows; ++i) m(i, j) = random.sym();
  return m;
}

}  // namespace

TEST_CASE("a dense LU solves as Eigen's does, whatever the size") {
  for (const Eigen::Index n : {1, 2, 7, 8, 9, 31, 64, 150, 333}) {
    CAPTURE(n);
    MatX a = random_dense(n, n, 11);
    a(0, 0) = 0.0;  // wants a pivot
    if (n == 1) a(0, 0) = 2.0;
    const VecX b = random_dense(n, 1, 12);
    DenseLu lu;
    lu.compute(a);
    const VecX x = lu.solve(b);
    const VecX truth = a.fullPivLu().solve(b);
    CHECK((x - truth).norm() <= 1e-9 * truth.norm());
    CHECK((a * x - b).norm() <= 1e-12 * a.norm() * x.norm());
  }
}

TEST_CASE("a dense LU and the product below it have the same bits for any number of threads") {
  const MatX a = random_dense(400, 400, 5), b = random_dense(400, 400, 6);
  const VecX right = random_dense(400, 1, 7);
  const int before = thread_count();
  MatX products[3];
  VecX answers[3];
  for (int t = 0; t < 3; ++t) {
    set_thread_count(t + 1);
    products[t] = random_dense(400, 400, 8);
    subtract_product({a.data(), 400}, {b.data(), 400}, products[t].data(), 400, 397, 395, 391);
    DenseLu lu;
    lu.compute(a);
    answers[t] = lu.solve(right);
  }
  set_thread_count(before);
  CHECK(products[0] == products[1]);
  CHECK(products[0] == products[2]);
  CHECK(answers[0] == answers[1]);
  CHECK(answers[0] == answers[2]);
  MatX expected = random_dense(400, 400, 8);
  expected.topLeftCorner(397, 395) -= a.topLeftCorner(397, 391) * b.topLeftCorner(391, 395);
  CHECK((products[0] - expected).cwiseAbs().maxCoeff() < 1e-12);
}

TEST_CASE("a dense LU of a singular matrix answers nothing finite") {
  MatX a = random_dense(20, 20, 3);
  a.col(13).setZero();
  DenseLu lu;
  lu.compute(a);
  CHECK_FALSE(lu.solve(VecX::Ones(20)).allFinite());
}
