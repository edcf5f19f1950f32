// Newton on rounded equations: its equations against finite differences and the exact ones, its answers against the
// judge, where nothing near is known.
#include <catch2/catch.hpp>

#include "engine/lcp/lcp_solver.hpp"
#include "engine/lcp/smoothed_alart_curnier.hpp"
#include "engine/response/operators/factored_delassus.hpp"
#include "engine/response/response.hpp"
#include "tests/support/group_systems.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

std::unique_ptr<LcpSolver> solver_of(std::string_view name) {
  for (const Entry<LcpSolver>& entry : lcp_solvers())
    if (entry.name == name) return entry.make();
  return nullptr;
}

/// A problem of one contact, whose W nobody asks for.
ConeProblem one_contact(double mu, FrictionLaw law, RowKind kind = RowKind::contact) {
  ConeProblem problem;
  problem.q = {Vec3::Zero()}, problem.mu = {mu}, problem.law = law, problem.kind = {kind};
  return problem;
}

}  // namespace

TEST_CASE("rounded equations have the derivatives of finite differences, and the exact value where the width ends") {
  Random random(11);
  for (const FrictionLaw law : {FrictionLaw::cone, FrictionLaw::pyramid})
    for (const double mu : {0.0, 0.1, 0.8})
      for (int k = 0; k < 200; ++k) {
        const ConeProblem problem = one_contact(mu, law);
        const Vec2 rho(random.in(0.5, 2.0), random.in(0.5, 2.0));
        Vec3 u = random.in(0.1, 2.0) * random.direction(), lambda = random.in(0.1, 2.0) * random.direction();
        if (mu == 0.0) u.tail<2>().setZero(), lambda.tail<2>().setZero();
        const double width = random.in(0.01, 0.3);
        const AlartCurnier e = smoothed_alart_curnier(problem, 0, u, lambda, rho, width);
        const auto value = [&](const Vec3& at_u, const Vec3& at_lambda, double w) {
          return smoothed_alart_curnier_value(problem, 0, at_u, at_lambda, rho, w);
        };
        CAPTURE(mu, static_cast<int>(law), k, width, u, lambda);
        CHECK((e.value - value(u, lambda, width)).norm() < 1e-14);
        constexpr double kStep = 1e-6;
        for (int c = 0; c < (mu == 0.0 ? 1 : 3); ++c) {
          const Vec3 d = kStep * Vec3::Unit(c);
          CHECK(((value(u + d, lambda, width) - value(u - d, lambda, width)) / (2.0 * kStep) - e.by_u.col(c)).norm() <
                1e-6);
          CHECK(((value(u, lambda + d, width) - value(u, lambda - d, width)) / (2.0 * kStep) - e.by_lambda.col(c))
                    .norm() < 1e-6);
        }
        const Vec3 exact = alart_curnier_value(problem, 0, u, lambda, rho);
        CHECK((value(u, lambda, 1e-9) - exact).norm() < 1e-7);
      }
  const ConeProblem attached = one_contact(0.0, FrictionLaw::cone, RowKind::attachment);
  const Vec3 u(0.1, 0.2, 0.3), lambda(1.0, 2.0, 3.0);
  CHECK(smoothed_alart_curnier_value(attached, 0, u, lambda, Vec2(2.0, 2.0), 0.1) == 2.0 * u);
}

TEST_CASE("Newton on rounded equations solves a tower of 80 boxes and heaps from nothing, by the judge") {
  Random random(5);
  std::vector<GroupSystem> groups{tower(80)};
  for (const int bodies : {20, 80, 300}) groups.push_back(heap(random, bodies, 4 * bodies));
  for (GroupSystem& group : groups) {
    FactoredDelassus w(group);
    ConeProblem problem = make_cone_problem(group);
    problem.w = &w;
    LcpSettings settings;
    std::vector<double> history;
    settings.history = &history;
    const LcpResult result = solver_of("smoothing_newton")->solve(problem, settings, group.lambda);
    CAPTURE(group.rigid.size(), result.iterations);
    CHECK(result.reason == StopReason::converged);
    CHECK(history.size() == static_cast<std::size_t>(result.iterations) + 1);
    const Residual left = judge(problem, group.lambda);
    CHECK(left.map.relative <= settings.tolerance);
    CHECK(left.cone.relative < 1e-14);
  }
}
