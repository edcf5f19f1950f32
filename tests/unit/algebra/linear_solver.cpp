#include "engine/algebra/linear_solver.hpp"

#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <limits>

#include "engine/core/parallel.hpp"
#include "engine/geometry/tets/tet_mesh.hpp"
#include "tests/support/random.hpp"

using namespace impinge;

namespace {

/// A symmetric positive definite matrix on the pattern of a tetrahedral box.
BlockMatrix random_matrix(int cells, std::uint64_t seed, double shift = 1.0) {
  const TetMesh mesh = make_tet_box(Vec3::Ones(), cells, cells, cells);
  BlockMatrix a(std::make_shared<BlockPattern>(make_block_pattern(static_cast<int>(mesh.vertices.size()), mesh.tets)));
  test::Random random(seed);
  for (const Tet& tet : mesh.tets) {
    Eigen::Matrix<double, 12, 12> g, k;
    for (int i = 0; i < 144; ++i) g(i % 12, i / 12) = random.sym();
    k = g * g.transpose();
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) a.values[a.pattern->find(tet[i], tet[j])] += k.block<3, 3>(3 * i, 3 * j);
  }
  for (int i = 0; i < a.pattern->rows; ++i) a.values[a.pattern->diagonal[i]] += shift * Mat3::Identity();
  return a;
}

MatX dense(const BlockMatrix& a) {
  MatX m = MatX::Zero(a.rows(), a.rows());
  for (int i = 0; i < a.pattern->rows; ++i)
    for (int k = a.pattern->begin[i]; k < a.pattern->begin[i + 1]; ++k)
      m.block<3, 3>(3 * i, 3 * a.pattern->column[k]) = a.values[k];
  return m;
}

VecX random_vector(Eigen::Index n, std::uint64_t seed) {
  test::Random random(seed);
  VecX v(n);
  for (Eigen::Index i = 0; i < n; ++i) v[i] = random.sym();
  return v;
}

}  // namespace

TEST_CASE("a block pattern knows its diagonal and mirrors, and multiplies like its dense form") {
  const BlockMatrix a = random_matrix(3, 1);
  const BlockPattern& p = *a.pattern;
  for (int i = 0; i < p.rows; ++i) {
    CHECK(p.column[p.diagonal[i]] == i);
    for (int k = p.begin[i]; k < p.begin[i + 1]; ++k) {
      CHECK(p.column[p.mirror[k]] == i);
      CHECK(p.mirror[p.mirror[k]] == k);
    }
  }
  const VecX x = random_vector(a.rows(), 2);
  CHECK((a * x - dense(a) * x).norm() < 1e-13 * x.norm() * dense(a).norm());
  LowerTriangle lower(p);
  lower.refill(a);
  CHECK((MatX(lower.matrix()) - MatX(dense(a).triangularView<Eigen::Lower>())).norm() == 0.0);
}

TEST_CASE("a sub-pattern is the rows and columns that stay") {
  const BlockMatrix a = random_matrix(2, 3);
  std::vector<int> index(a.pattern->rows), source;
  int kept = 0;
  for (int i = 0; i < a.pattern->rows; ++i) index[i] = i % 3 == 1 ? -1 : kept++;
  BlockMatrix b(std::make_shared<BlockPattern>(sub_pattern(*a.pattern, index, source)));
  for (std::size_t k = 0; k < source.size(); ++k) b.values[k] = a.values[source[k]];
  const MatX whole = dense(a), part = dense(b);
  for (int i = 0; i < a.pattern->rows; ++i)
    for (int j = 0; j < a.pattern->rows; ++j)
      if (index[i] >= 0 && index[j] >= 0)
        CHECK((part.block<3, 3>(3 * index[i], 3 * index[j]) - whole.block<3, 3>(3 * i, 3 * j)).norm() == 0.0);
}

TEST_CASE("every linear solver agrees with a dense one, for one and for many right-hand sides") {
  const BlockMatrix a = random_matrix(3, 4), other = random_matrix(3, 5);
  const VecX b = random_vector(a.rows(), 6);
  const MatX many = random_vector(a.rows() * 4, 7).reshaped(a.rows(), 4);
  for (const auto& entry : linear_solvers()) {
    CAPTURE(std::string(entry.name));
    const auto solver = entry.make();
    solver->tolerance = 1e-13;
    solver->analyze(*a.pattern);
    // the second matrix has the same pattern, so no new analysis
    for (const BlockMatrix* m : {&a, &other}) {
      REQUIRE(solver->factorize(*m) == SolveStatus::ok);
      const Eigen::LLT<MatX> truth(dense(*m));
      VecX x;
      CHECK(solver->solve(b, x).status == SolveStatus::ok);
      CHECK((x - truth.solve(b)).norm() < 1e-9 * x.norm());
      MatX y;
      CHECK(solver->solve_many(many, y).status == SolveStatus::ok);
      CHECK((y - truth.solve(many)).norm() < 1e-9 * y.norm());
    }
    VecX zero = VecX::Ones(a.rows());
    CHECK(solver->solve(VecX::Zero(a.rows()), zero).status == SolveStatus::ok);
    CHECK(zero.norm() == 0.0);
  }
}

TEST_CASE("every linear solver makes the same W = Bᵀ A⁻¹ B as a dense one") {
  const BlockMatrix a = random_matrix(5, 12);
  const Eigen::LLT<MatX> truth(dense(a));
  test::Random random(13);
  // contacts on four nodes each, a column that is empty, one that is full, and two alike
  for (const int columns : {1, 40, 130}) {
    std::vector<Eigen::Triplet<double>> entries;
    for (int j = 0; j < columns; ++j) {
      if (j == 3) continue;
      if (j == 5) {
        for (int i = 0; i < a.rows(); ++i) entries.emplace_back(i, j, random.sym());
        continue;
      }
      for (int k = 0; k < 12; ++k)
        entries.emplace_back(static_cast<int>(random.u() * a.rows()), j, j == 7 ? 1.0 : random.sym());
    }
    SparseColumns b(a.rows(), columns);
    b.setFromTriplets(entries.begin(), entries.end());
    const MatX expected = MatX(b).transpose() * truth.solve(MatX(b));
    for (const auto& entry : linear_solvers()) {
      CAPTURE(std::string(entry.name), columns);
      const auto solver = entry.make();
      solver->tolerance = 1e-13;
      solver->analyze(*a.pattern);
      REQUIRE(solver->factorize(a) == SolveStatus::ok);
      MatX w = MatX::Ones(2, 5);
      CHECK(solver->gram(b, w).status == SolveStatus::ok);
      REQUIRE((w.rows() == columns && w.cols() == columns));
      CHECK((w - expected).norm() < 1e-11 * expected.norm());
      CHECK((w.array() == w.transpose().array()).all());
      MatX none;
      CHECK(solver->gram(SparseColumns(a.rows(), 0), none).status == SolveStatus::ok);
      CHECK(none.size() == 0);
    }
  }
}

TEST_CASE("a factorization is made only when the matrix has changed") {
  const BlockMatrix a = random_matrix(3, 14), other = random_matrix(3, 15);
  BlockMatrix broken = a;
  broken.values[1](0, 2) = std::numeric_limits<double>::infinity();
  const VecX b = random_vector(a.rows(), 16);
  for (const auto& entry : linear_solvers()) {
    if (entry.name == "conjugate_gradient") continue;
    CAPTURE(std::string(entry.name));
    const auto solver = entry.make();
    solver->analyze(*a.pattern);
    int expected = 0;
    const auto check = [&](const BlockMatrix& m, bool again) {
      const BlockMatrix copy = m;  // the numbers count, not where they are
      REQUIRE(solver->factorize(copy) == SolveStatus::ok);
      VecX x;
      solver->solve(b, x);
      CHECK((m * x - b).norm() < 1e-9 * b.norm());
      CHECK(solver->factorizations == (expected += again));
    };
    check(a, true);
    check(a, false);
    check(other, true);
    check(a, true);
    CHECK(solver->factorize(broken) == SolveStatus::not_finite);
    check(a, true);
    check(a, false);
    solver->analyze(*a.pattern);
    check(a, true);
  }
}

TEST_CASE("every linear solver says so when a matrix is indefinite or not finite") {
  BlockMatrix a = random_matrix(2, 8);
  const VecX b = random_vector(a.rows(), 9);
  for (const auto& entry : linear_solvers()) {
    CAPTURE(std::string(entry.name));
    const auto solver = entry.make();
    solver->analyze(*a.pattern);
    BlockMatrix indefinite = a;
    indefinite.values[indefinite.pattern->diagonal[3]] -= 1e4 * Mat3::Identity();
    VecX x;
    const SolveStatus first = solver->factorize(indefinite);
    CHECK((first != SolveStatus::ok ? first : solver->solve(b, x).status) == SolveStatus::not_positive_definite);
    BlockMatrix broken = a;
    broken.values[0](1, 1) = std::numeric_limits<double>::quiet_NaN();
    const SolveStatus second = solver->factorize(broken);
    CHECK((second != SolveStatus::ok ? second : solver->solve(b, x).status) == SolveStatus::not_finite);
    REQUIRE(solver->factorize(a) == SolveStatus::ok);
    CHECK(solver->solve(b, x).status == SolveStatus::ok);
  }
}

TEST_CASE("conjugate gradients: a cap is reported, a good start saves work, threads don't matter") {
  const BlockMatrix a = random_matrix(10, 10, 0.01);
  const VecX b = random_vector(a.rows(), 11);
  const auto solver = make_linear_solver("conjugate_gradient");
  solver->analyze(*a.pattern);
  REQUIRE(solver->factorize(a) == SolveStatus::ok);
  VecX x, again;
  set_thread_count(1);
  const SolveReport cold = solver->solve(b, x);
  CHECK(cold.status == SolveStatus::ok);
  CHECK((b - a * x).norm() < 1.1e-8 * b.norm());
  set_thread_count(4);
  solver->solve(b, again);
  set_thread_count(0);
  CHECK((x.array() == again.array()).all());
  CHECK(solver->solve(b, again).iterations == 0);
  solver->max_iterations = 2;
  VecX short_of;
  CHECK(solver->solve(b, short_of).status == SolveStatus::not_converged);
}
