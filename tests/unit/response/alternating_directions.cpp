// Alternating directions against the judge: from a λ that is near, as heaps have it from the step before.
#include <catch2/catch.hpp>

#include "engine/core/parallel.hpp"
#include "engine/lcp/alternating_directions.hpp"
#include "engine/response/operators/factored_delassus.hpp"
#include "engine/response/response.hpp"
#include "tests/support/group_systems.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

constexpr int kBodies = 400, kContacts = 4 * kBodies;  // of several strips

LcpResult alternate(GroupSystem& group, double tolerance, std::vector<double>* history = nullptr) {
  FactoredDelassus w(group);
  ConeProblem problem = make_cone_problem(group);
  problem.w = &w;
  LcpSettings settings;
  settings.tolerance = tolerance;
  settings.history = history;
  return alternate_directions(problem, settings, group.lambda);
}

Residual residual_of(GroupSystem& group) {
  FactoredDelassus w(group);
  ConeProblem problem = make_cone_problem(group);
  problem.w = &w;
  return judge(problem, group.lambda);
}

}  // namespace

TEST_CASE("alternating directions bring a heap to a thousandth from the answer before, in few iterations") {
  Random random(17);
  GroupSystem group = heap(random, kBodies, kContacts);
  REQUIRE(alternate(group, 1e-4).reason == StopReason::converged);
  for (int step = 0; step < 3; ++step) {
    for (RigidBlock& body : group.rigid) body.velocity += 0.1 * random.direction();
    REQUIRE(residual_of(group).map.relative > 1e-2);
    std::vector<double> history;
    const LcpResult result = alternate(group, 1e-3, &history);
    CAPTURE(step, result.iterations);
    CHECK(result.reason == StopReason::converged);
    CHECK(result.iterations <= 300);
    CHECK(history.size() == static_cast<std::size_t>(result.iterations) + 1);
    const Residual left = residual_of(group);
    CHECK(left.map.relative <= 1e-3);
    CHECK(left.cone.relative < 1e-14);
  }
}

TEST_CASE("alternating directions know attachments, slides, contacts without friction and what nothing can move") {
  Random random(23);
  GroupSystem group = heap(random, 30, 120);
  for (std::size_t i = 0; i < group.contacts.size(); ++i) {
    ContactRows& rows = group.contacts[i];
    if (i % 10 == 1) rows.kind = RowKind::attachment;
    if (i % 10 == 4) rows.kind = RowKind::sliding;
    if (i % 10 == 7) rows.friction = 0.0;
  }
  group.contacts.front().a.rigid = group.contacts.front().b.rigid = -1;
  {
    FactoredDelassus w(group);
    ConeProblem problem = make_cone_problem(group);
    problem.w = &w;
    for (const Entry<LcpSolver>& entry : lcp_solvers())
      if (entry.name == "semismooth_newton") entry.make()->solve(problem, {}, group.lambda);
  }
  for (int step = 0; step < 3; ++step) {
    for (RigidBlock& body : group.rigid) body.velocity += 0.1 * random.direction();
    REQUIRE(residual_of(group).map.relative > 1e-2);
    const LcpResult result = alternate(group, 1e-3);
    CAPTURE(step, result.iterations);
    CHECK(result.reason == StopReason::converged);
    const Residual left = residual_of(group);
    CHECK(left.map.relative <= 1e-3);
    CHECK(left.cone.relative < 1e-14);
  }
}

TEST_CASE("alternating directions have the same bits for any number of threads") {
  std::vector<std::vector<Vec3>> answers;
  for (const int threads : {1, 2, 5}) {
    Random random(31);
    GroupSystem group = heap(random, kBodies, kContacts);
    set_thread_count(threads);
    alternate(group, 1e-3);
    answers.push_back(group.lambda);
  }
  set_thread_count(0);
  CHECK(answers[0] == answers[1]);
  CHECK(answers[0] == answers[2]);
}
