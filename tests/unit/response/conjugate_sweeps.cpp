// Conjugate sweeps, and where the default takes them: a W that is dense and stiff, with more rows than a factorization
// is worth.
#include <catch2/catch.hpp>

#include "engine/lcp/conjugate_sweeps.hpp"
#include "engine/lcp/gauss_seidel_sweep.hpp"
#include "engine/lcp/lcp_solver.hpp"
#include "tests/support/mechanics/dense_delassus.hpp"
#include "tests/support/mechanics/methods.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// Contacts in a line, each of which feels its neighbours: W is a Laplace matrix and a little, so that a sweep carries
/// news by one contact and the stiffness is 4 over `little`.
MatX line(int contacts, double little) {
  MatX w = MatX::Zero(3 * contacts, 3 * contacts);
  for (int i = 0; i < contacts; ++i)
    for (int k = 0; k < 3; ++k) {
      w(3 * i + k, 3 * i + k) = 2.0 + little;
      if (i > 0) w(3 * i + k, 3 * (i - 1) + k) = w(3 * (i - 1) + k, 3 * i + k) = -1.0;
    }
  return w;
}

struct Line {
  DenseDelassus w;
  ConeProblem problem;
  explicit Line(int contacts, double little = 1e-2) : w(line(contacts, little)) {
    problem.w = &w;
    for (int i = 0; i < contacts; ++i) {
      problem.q.emplace_back(i % 7 == 0 ? 0.3 : -1.0, 0.2, -0.1);
      problem.mu.push_back(0.3);
    }
  }
};

LcpResult solve(const Line& of, const char* method, std::vector<Vec3>& lambda) {
  return make_named(lcp_solvers(), method)->solve(of.problem, {1e-8, 20000}, lambda);
}

}  // namespace

TEST_CASE("a conjugate sweep without momentum is a sweep, and what comes after needs fewer of them") {
  const Line of(100);
  std::vector<Vec3> plain(100, Vec3::Zero()), conjugate = plain;
  ConjugateSweeps sweeps(of.problem);
  of.problem.w->begin(plain);
  const double change = gauss_seidel_sweep(of.problem, plain);
  of.problem.w->begin(conjugate);
  CHECK(sweeps.sweep(conjugate) == change);
  CHECK(conjugate == plain);
  std::vector<Vec3> lambda(100, Vec3::Zero());
  const LcpResult gauss_seidel = solve(of, "projected_gauss_seidel", lambda);
  lambda.assign(100, Vec3::Zero());
  const LcpResult nncg = solve(of, "nonsmooth_nonlinear_conjugate_gradient", lambda);
  REQUIRE(gauss_seidel.reason == StopReason::converged);
  REQUIRE(nncg.reason == StopReason::converged);
  CAPTURE(gauss_seidel.iterations, nncg.iterations);
  CHECK(3 * nncg.iterations < gauss_seidel.iterations);
}

TEST_CASE("the default ends by conjugate sweeps what they end for less than Newton, and by Newton what they don't") {
  // stiffness 400: 14 of Newton's steps take twice the time of 560 conjugate sweeps; from 1,300 on Newton is quicker
  for (const double little : {1e-2, 3e-3, 1e-6}) {
    const Line of(300, little);
    std::vector<Vec3> lambda(300, Vec3::Zero()), newton = lambda, swept = lambda, conjugate = lambda;
    const LcpResult result = solve(of, "automatic", lambda);
    CAPTURE(little, result.iterations);
    CHECK(result.reason == StopReason::converged);
    CHECK(judge(of.problem, lambda).map.relative <= 1e-8);
    const LcpResult by_newton = solve(of, "semismooth_newton", newton);
    REQUIRE(by_newton.reason == StopReason::converged);
    double apart = 0.0;
    for (std::size_t i = 0; i < lambda.size(); ++i) apart = std::max(apart, (lambda[i] - newton[i]).norm());
    CHECK(apart <= 1e-6 / little);
    if (little == 1e-2) {
      const LcpResult nncg = solve(of, "nonsmooth_nonlinear_conjugate_gradient", conjugate);
      REQUIRE(nncg.reason == StopReason::converged);
      CHECK(result.iterations <= nncg.iterations + 10);  // Gauss-Seidel's ten, and nothing else
      CHECK(result.iterations > 10 * by_newton.iterations);
    } else {
      const LcpSettings four_times{1e-8, 4 * result.iterations};
      const auto gauss_seidel = make_named(lcp_solvers(), "projected_gauss_seidel");
      CHECK(gauss_seidel->solve(of.problem, four_times, swept).reason != StopReason::converged);
    }
  }
}
