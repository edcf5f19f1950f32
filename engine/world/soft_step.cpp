#include "engine/world/soft_step.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/core/error.hpp"

namespace impinge {
namespace {

void check_solved(const DeformableStep& step, const RigidBody& body, int frame) {
  if (step.linear_status != SolveStatus::not_finite && step.linear_status != SolveStatus::not_positive_definite) return;
  throw DivergenceError(
      fmt::format("frame {}, body '{}': its system matrix is {}; use more sub-steps or a softer material", frame,
                  body.name, step.linear_status == SolveStatus::not_finite ? "not finite" : "not positive definite"));
}

}  // namespace

void SoftStep::choose_solvers(const DeformableBody& body, const LinearSolverChoice& choice) {
  iterative = choice.make(body.dofs(), 1);
  direct = choice.make(body.dofs(), kContactRightHandSides);
  iterative->analyze(*body.free_pattern());
  direct->analyze(*body.free_pattern());
}

void SoftStep::find_displacement_velocity(RigidBody& body) {
  const DeformableBody& fem = body.soft->fem;
  displacement_velocity = (step.s * with_held(fem, step.v_star) + step.offset) / step.time_step;
}

void SoftStep::begin(RigidBody& body, const DeformableIntegrator& integrator, const Vec3& gravity, double h,
                     int frame) {
  DeformableBody& fem = body.soft->fem;
  velocity_before = fem.velocity;
  touched = false;
  integrator.begin(fem, gravity, h, step);
  integrator.free_velocity(fem, step, *iterative);
  check_solved(step, body, frame);
  find_displacement_velocity(body);
  interpolate(body.soft->embedding, fem.fem.rest(), displacement_velocity, body.soft->surface_velocity);
}

double SoftStep::relinearize(RigidBody& body, const DeformableIntegrator& integrator, const VecX& v,
                             const VecX& impulse) {
  integrator.linearize(body.soft->fem, v, step);
  const VecX momentum = step.a * v;
  const double size = std::max({momentum.norm(), step.b.norm(), impulse.norm()});
  return size > 0.0 ? (momentum - step.b - impulse).norm() / size : 0.0;
}

void SoftStep::resolve(RigidBody& body, int frame) {
  step.linear_status = iterative->factorize(step.a);
  if (step.linear_status == SolveStatus::ok) step.linear_status = iterative->solve(step.b, step.v_star).status;
  check_solved(step, body, frame);
  find_displacement_velocity(body);
}

}  // namespace impinge
