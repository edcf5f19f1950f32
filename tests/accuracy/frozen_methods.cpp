// Constraint anticipation, its iterative form and a monolithic KKT system on the same frozen step: two deformable cubes
// on a floor, and the hardest frame of the seed's dragon scene. And W by several routes.
#include <catch2/catch.hpp>

#include "engine/lcp/residual.hpp"
#include "engine/response/augmented_lagrangian.hpp"
#include "engine/response/delassus_columns.hpp"
#include "engine/response/response.hpp"
#include "tests/support/mechanics/deformable_stack.hpp"
#include "tests/support/mechanics/frozen_dragon.hpp"
#include "tests/support/mechanics/frozen_reference.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// ‖Δv_x - Δv_y‖_A / ‖Δv_y‖_A of a step of one group.
double difference(const FrozenStep& step, const GroupAnswer& x, const GroupAnswer& y) {
  return energy_distance(step.groups[0], x, y) / std::sqrt(energy_product(step.groups[0], y, y));
}

void check_frictionless(const FrozenStep& step, double tolerance) {
  const FrozenStep smooth = without_friction(step);
  const GroupAnswer kkt = kkt_answer(smooth.groups[0]);
  const FrozenOutcome exact = solved(smooth, "constraint_anticipation", "semismooth_newton", 1e-12);
  const FrozenOutcome iterative =
      solved(smooth, "iterative_constraint_anticipation", "projected_gauss_seidel", tolerance);
  CHECK(exact.converged);
  CHECK(iterative.converged);
  CHECK(difference(smooth, exact.answers[0], kkt) < 1e-6);
  CHECK(difference(smooth, iterative.answers[0], exact.answers[0]) < 1e-6);
  CHECK(difference(smooth, iterative.answers[0], kkt) < 1e-6);
  const FrozenRuler ruler(smooth);
  CHECK(ruler.judge(ruler.exact()).residual < 1e-12);
  CHECK(ruler.judge(exact.answers).distance < 1e-9);
}

void check_friction(const FrozenStep& step, double tolerance) {
  const FrozenRuler ruler(step);
  CHECK(ruler.judge(ruler.exact()).residual < 1e-12);
  for (const char* solver : {"projected_gauss_seidel", "nonsmooth_nonlinear_conjugate_gradient", "semismooth_newton"}) {
    const FrozenVerdict verdict = ruler.judge(solved(step, "constraint_anticipation", solver, 1e-9).answers);
    CAPTURE(solver, verdict.distance);
    CHECK(verdict.natural_map_relative < 1e-8);
    CHECK(verdict.residual < 1e-8);
    CHECK(verdict.cone_violation < 1e-12);
  }
  const FrozenVerdict verdict =
      ruler.judge(solved(step, "iterative_constraint_anticipation", "projected_gauss_seidel", tolerance).answers);
  CAPTURE(verdict.distance);
  CHECK(verdict.natural_map_relative < 1e-8);
  CHECK(verdict.residual < 1e-8);
  CHECK(verdict.distance < 1e-4);
}

void check_routes(const FrozenGroup& group, bool dense) {
  const MatX w = w_assembled(group, LinearSolverChoice("automatic"));
  const double size = w.norm();
  CHECK((w - w.transpose()).norm() <= 1e-13 * size);
  const MatX solves = w_by_whole_solves(group, LinearSolverChoice("automatic"));
  CHECK((solves - solves.transpose()).norm() <= 1e-12 * size);
  CHECK((w - solves).norm() <= 1e-12 * size);
  CHECK((w - w_assembled(group, LinearSolverChoice("simplicial_llt"))).norm() <= 1e-12 * size);
  if (dense) CHECK((w - w_by_dense_inverse(group)).norm() <= 1e-12 * size);
}

}  // namespace

TEST_CASE(
    "two stacked cubes: exact, iterative and monolithic answers agree without friction, and with it each is one") {
  for (const double young : {1e4, 1e5, 1e6})
    for (const bool rigid : {false, true}) {
      CAPTURE(young, rigid);
      const SoftStack stack =
          make_soft_stack({.young = young, .friction = 0.4, .cells = {4, 3}, .rigid_on_top = rigid});
      const FrozenStep step = frozen_of(stack.group);
      check_frictionless(step, 1e-9);
      check_friction(step, 1e-9);
      check_routes(step.groups[0], true);
    }
}

TEST_CASE(
    "the augmented Lagrangian, and columns by conjugate gradients, find the same velocities from nothing, with "
    "friction and without") {
  for (const double friction : {0.0, 0.4})
    for (const bool columns : {false, true}) {
      const SoftStack stack = make_soft_stack({.young = 1e4, .friction = friction, .cells = {4, 3}});
      const FrozenStep step = frozen_of(stack.group);
      GroupSystem group = stack.group;
      group.clear_delta();
      group.lambda.assign(group.contacts.size(), Vec3::Zero());
      const GroupOperator a(group);
      const ConeProblem problem = make_cone_problem(group);
      const double tolerance = 1e-9 * velocity_scale(problem);
      VecX x = VecX::Zero(a.size());
      const bool converged = columns
                                 ? solve_by_delassus_columns(
                                       a, problem, *find_entry(lcp_solvers(), "automatic")->make(), tolerance, group, x)
                                       .converged
                                 : solve_by_augmented_lagrangian(a, problem, tolerance, group, x).converged;
      a.store(x, group);
      CAPTURE(friction, columns);
      CHECK(converged);
      const FrozenVerdict verdict = FrozenRuler(step).judge(
          {{group.lambda, group.delta_velocity, group.delta_angular_velocity, group.deformable_delta}});
      CHECK(verdict.residual < 1e-8);
      CHECK(verdict.distance < 1e-6);
    }
}

TEST_CASE("the dragon's hardest frame: exact, iterative and monolithic answers agree at every stiffness", "[long]") {
  for (const char* young : {"", "1e4", "1e5", "1e6"}) {
    std::vector<std::string> overrides;
    if (*young != 0) overrides.push_back(std::string("body.dragon.material.young=") + young);
    FrozenStep step = hardest_frame(overrides, 25);
    CAPTURE(young, step.frame, step.contacts());
    REQUIRE(step.contacts() > 200);
    // the group of most contacts
    std::swap(step.groups[0],
              *std::max_element(step.groups.begin(), step.groups.end(), [](const FrozenGroup& l, const FrozenGroup& r) {
                return l.system.contacts.size() < r.system.contacts.size();
              }));
    step.groups.resize(1);
    check_frictionless(step, 1e-10);
    check_friction(step, 1e-9);
    check_routes(step.groups[0], false);
  }
}

TEST_CASE(
    "iterative anticipation ends where its sweeps stall: more rows than a soft surface has unknowns, and friction",
    "[long]") {
  const std::vector<FrozenStep> steps = dragon_frames({"body.dragon.material.young=1e4"}, 19);
  for (const int frame : {14, 16, 19}) {
    const FrozenStep& step = steps[frame - 1];
    const FrozenOutcome outcome = solved(step, "iterative_constraint_anticipation", "projected_gauss_seidel", 1e-9);
    const FrozenVerdict verdict = FrozenRuler(step).judge(outcome.answers);
    CAPTURE(frame, step.contacts(), outcome.ms, outcome.outer_iterations, verdict.distance);
    CHECK(outcome.converged);
    CHECK(verdict.natural_map_relative < 1e-8);
    CHECK(verdict.residual < 1e-8);
  }
}
