// Random symmetric positive definite problems of up to 200 rows, every LCP solver against the pivoting reference
// where the law is linear, and against the judge where it is a cone.
#include <catch2/catch.hpp>

#include <Eigen/Eigenvalues>

#include "engine/lcp/lcp_solver.hpp"
#include "tests/support/mechanics/dense_delassus.hpp"
#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

struct Tally {
  int problems = 0, open = 0, stick = 0, slip = 0, unique = 0, two_solutions = 0;
};

struct Case {
  DenseDelassus w;
  ConeProblem problem;
  double condition = 0.0;
  bool unique = false;  // by proof
};

// W = G G^T / m + ε I, its blocks scaled as unlike masses would; q points inwards at three contacts of four
Case make_case(Random& random, int kind) {
  const int n = 1 + static_cast<int>(std::pow(random.u(), 2.0) * 66.0), rows = 3 * n;
  MatX g(rows, rows + random.below(rows + 1));
  for (Eigen::Index i = 0; i < g.size(); ++i) g.data()[i] = random.sym();
  MatX w = g * g.transpose() / static_cast<double>(g.cols()) +
           std::pow(10.0, random.in(-1.5, -0.3)) * MatX::Identity(rows, rows);
  for (int i = 0; i < n; ++i) {
    const double s = std::pow(10.0, random.in(-0.25, 0.25));
    w.middleRows<3>(3 * i) *= s;
    w.middleCols<3>(3 * i) *= s;
  }
  w = (0.5 * (w + w.transpose())).eval();
  const VecX eigenvalues = Eigen::SelfAdjointEigenSolver<MatX>(w, Eigen::EigenvaluesOnly).eigenvalues();
  Case c{DenseDelassus(w), {}, eigenvalues[rows - 1] / eigenvalues[0], kind == 0};
  REQUIRE(eigenvalues[0] > 0.0);
  // u ↦ mu |u_T| n has the Lipschitz constant mu (√2 mu for the pyramid): with that below 1/cond(W) the map is strongly
  // monotone, so its solution is unique
  const bool small = random.below(4) == 0;
  const double mu = kind == 0 ? 0.0 : small ? 0.7 / c.condition : random.in(0.1, 0.8);
  c.unique = c.unique || small;
  for (int i = 0; i < n; ++i) {
    c.problem.q.push_back(random.vector() - Vec3(0.5, 0, 0));
    c.problem.mu.push_back(mu);
  }
  if (kind == 1) c.problem.law = FrictionLaw::pyramid;
  return c;
}

void count_regimes(const Case& c, const std::vector<Vec3>& lambda, Tally& tally) {
  for (std::size_t i = 0; i < lambda.size(); ++i) {
    if (lambda[i].x() <= 0.0)
      ++tally.open;
    else if (cone_violation((1.0 + 1e-7) * Vec3(lambda[i].x() / (1.0 + 2e-7), lambda[i].y(), lambda[i].z()),
                            c.problem.mu[i], c.problem.law) > 0.0)
      ++tally.slip;
    else
      ++tally.stick;
  }
}

void check_problem(Random& random, int kind, Tally& tally) {
  Case c = make_case(random, kind);
  c.problem.w = &c.w;
  ++tally.problems;
  tally.unique += c.unique;
  std::vector<Vec3> reference;
  if (kind != 2) {
    reference.assign(c.problem.q.size(), Vec3::Zero());
    const LcpResult exact = find_entry(lcp_solvers(), "pivoting")->make()->solve(c.problem, {1e-11, 100000}, reference);
    CAPTURE(kind, c.problem.q.size(), exact.iterations, name_of(exact.reason),
            judge(c.problem, reference).map.relative);
    REQUIRE(exact.reason == StopReason::converged);
    count_regimes(c, reference, tally);
  }
  for (const auto& e : lcp_solvers()) {
    const auto solver = e.make();
    if (e.name == "pivoting" || !solver->applies(c.problem).empty()) continue;
    std::vector<Vec3> lambda(c.problem.q.size(), Vec3::Zero());
    const LcpResult result = solver->solve(c.problem, {1e-11, 100000}, lambda);
    const Residual residual = judge(c.problem, lambda);
    CAPTURE(e.name, kind, c.problem.q.size(), c.condition, result.iterations, name_of(result.reason),
            residual.map.relative);
    REQUIRE(result.reason == StopReason::converged);
    REQUIRE(residual.map.relative <= 1e-10);
    REQUIRE(residual.cone.relative <= 1e-12);
    if (reference.empty()) {  // the first solver's answer serves where the solution is unique
      count_regimes(c, lambda, tally);
      reference = lambda;
      continue;
    }
    double difference = 0.0;
    for (std::size_t i = 0; i < lambda.size(); ++i)
      difference = std::max(difference, (lambda[i] - reference[i]).norm());
    if (c.unique)
      REQUIRE(difference <= 1e-8 * c.condition);
    else if (difference > 1e-8 * c.condition)
      ++tally.two_solutions;  // both satisfy the judge
  }
}

void check_problems(int count, std::uint64_t seed) {
  Tally tally[3];
  Random random(seed);
  for (int i = 0; i < count; ++i) check_problem(random, i % 3, tally[i % 3]);
  for (int kind = 0; kind < 3; ++kind) {
    const Tally& t = tally[kind];
    CAPTURE(kind, t.problems, t.open, t.stick, t.slip, t.unique, t.two_solutions);
    CHECK(t.open > count / 3);
    if (kind > 0) CHECK(t.stick > count / 3);
    if (kind > 0) CHECK(t.slip > count / 3);
    CHECK(t.unique > t.problems / 8);
    CHECK(t.two_solutions == 0);
  }
}

}  // namespace

TEST_CASE("a sample of random problems, every LCP solver", "[methods]") { check_problems(60, 38); }

TEST_CASE("2,000 random problems, every LCP solver", "[long]") { check_problems(2000, 3838); }
