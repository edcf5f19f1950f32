#include "engine/integrators/deformable_integrator.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/error.hpp"
#include "engine/core/parallel.hpp"
#include "engine/integrators/pull_spring.hpp"

namespace impinge {

VecX applied_force(const DeformableBody& body, const Vec3& gravity) {
  VecX f = body.external_force;
  for (int i = 0; i < body.nodes(); ++i) f.segment<3>(3 * i) += body.fem.node_mass()[i] * gravity;
  return f;
}

VecX damping_force(const DeformableBody& body, const DeformableStep& step, const VecX& v) {
  VecX d = VecX::Zero(v.size()), part;
  if (body.damping.alpha != 0.0) {
    body.fem.multiply_mass(v, part);
    d += body.damping.alpha * part;
  }
  if (body.damping.beta != 0.0) {
    multiply(step.stiffness, step.rigid.size() > 0 ? VecX(v - step.rigid) : v, part);
    d += body.damping.beta * part;
  }
  return d;
}

double damping_potential(const DeformableBody& body, const DeformableStep& step, const VecX& v) {
  double sum = 0.0;
  VecX part;
  if (body.damping.alpha != 0.0) {
    body.fem.multiply_mass(v, part);
    sum += body.damping.alpha * dot(v, part);
  }
  if (body.damping.beta != 0.0) {
    const VecX strains = step.rigid.size() > 0 ? VecX(v - step.rigid) : v;
    multiply(step.stiffness, strains, part);
    sum += body.damping.beta * dot(strains, part);
  }
  return 0.5 * sum;
}

void begin_step(DeformableBody& body, bool with_tangent, DeformableStep& step) {
  step.start = body.position;
  step.rigid.resize(0);
  body.fem.release_tangles(body.position);
  // held nodes move by h times their prescribed velocity, whatever s is
  for (int i = 0; i < body.nodes(); ++i)
    if (body.is_held(i))
      step.offset.segment<3>(3 * i) = (step.time_step - step.s) * body.held_velocity().segment<3>(3 * i);
  const bool damps = body.damping.beta != 0.0;
  const auto made = [&](BlockMatrix& k) -> BlockMatrix& {
    if (k.pattern != body.fem.pattern()) k = BlockMatrix(body.fem.pattern());
    return k;
  };
  if (with_tangent || damps)
    body.fem.stiffness(body.position, Tangent::automatic, step.force,
                       made(with_tangent ? step.tangent : step.stiffness));
  else
    body.fem.forces(body.position, step.force);
  step.newton_iterations = step.linear_iterations = 0;
  step.residual = 0.0;
  step.converged = true;
  step.linear_status = SolveStatus::ok;
  if (!damps) return;
  if (body.free_nodes() == body.nodes())
    body.fem.damping_stiffness(body.position, made(step.stiffness));
  else if (with_tangent)
    step.stiffness = step.tangent;
}

void fill_system(const DeformableBody& body, double mass, double start, double now, const BlockMatrix* k,
                 DeformableStep& step) {
  if (step.a.pattern != body.free_pattern()) step.a = BlockMatrix(body.free_pattern());
  step.mass = mass;
  const std::vector<int>& source = body.free_source();
  const std::vector<double>& block_mass = body.fem.block_mass();
  parallel_for(source.size(), 4096, [&](std::size_t i) {
    Mat3& a = step.a.values[i];
    a.setZero();
    if (start != 0.0) a += start * step.stiffness.values[source[i]];
    if (now != 0.0) a += now * k->values[source[i]];
    a.diagonal().array() += mass * block_mass[source[i]];
  });
}

void solve_free_velocity(const DeformableBody& body, DeformableStep& step, LinearSolver& solver) {
  step.linear_status = solver.factorize(step.a);
  step.v_star = body.gather_free(body.velocity);
  if (step.linear_status == SolveStatus::ok) {
    const SolveReport report = solver.solve(step.b, step.v_star);
    step.linear_status = report.status;
    step.linear_iterations += report.iterations;
    step.residual = report.residual;
  }
  step.converged = step.linear_status == SolveStatus::ok;
}

VecX momentum_balance(const DeformableBody& body, const DeformableStep& step, const VecX& v, const VecX& elastic,
                      const VecX& damping, const VecX& applied, double& size) {
  VecX inertia, momentum;
  body.fem.multiply_mass(v - step.v_hat, inertia);
  body.fem.multiply_mass(step.v_hat, momentum);
  VecX g = inertia + step.tau * (damping - elastic - applied);
  const Vec3 pulled = add_pull(body, step, v, -1.0, g);
  size = std::max({momentum.norm(), inertia.norm(), step.tau * damping.norm(), step.tau * elastic.norm(),
                   step.tau * applied.norm(), pulled.norm()});
  return g;
}

double largest_stiffness(const DeformableBody& body, const DeformableStep& step) {
  double largest = 0.0;
  for (int i = 0; i < body.nodes(); ++i)
    largest = std::max(largest, step.tangent.values[body.fem.pattern()->diagonal[i]].trace());
  return largest;
}

double rounding_of_balance(const DeformableBody& body, const DeformableStep& step, double largest_stiffness) {
  const double extent = step.start.cwiseAbs().maxCoeff();
  return 1e-15 * step.tau * largest_stiffness * extent * std::sqrt(static_cast<double>(body.nodes()));
}

bool newton_direction(LinearSolver& solver, const VecX& g, DeformableStep& step, VecX& direction) {
  step.linear_status = solver.factorize(step.a);
  if (step.linear_status != SolveStatus::ok) return false;
  direction.setZero(g.size());
  const SolveReport report = solver.solve(-g, direction);
  step.linear_iterations += report.iterations;
  step.linear_status = report.status;
  return report.status == SolveStatus::ok || report.status == SolveStatus::not_converged;
}

void OneStepScheme::linearize(DeformableBody& body, const VecX& v, DeformableStep& step) const {
  const VecX all = body.with_held(v);
  VecX force, g;
  if (step.tangent.pattern != body.fem.pattern()) step.tangent = BlockMatrix(body.fem.pattern());
  body.fem.stiffness(step.position(all), Tangent::projected, force, step.tangent);
  body.fem.multiply_mass(all - step.v_hat, g);
  g += step.tau * (damping_force(body, step, all) - force - applied_force(body, step.gravity));
  add_pull(body, step, all, -1.0, g);
  const RayleighDamping& d = body.damping;
  fill_system(body, 1.0 + step.tau * d.alpha, step.tau * d.beta, step.tau * step.s, &step.tangent, step);
  add_pull_to_system(body, step);
  step.b = step.a * v - body.gather_free(g);
  step.rounding = rounding_of_balance(body, step, largest_stiffness(body, step));
}

void OneStepScheme::free_velocity(DeformableBody& body, DeformableStep& step, LinearSolver& solver) const {
  newton_solve(body, step, solver, *newton());
}

void OneStepScheme::advance(DeformableBody& body, const DeformableStep& step, const VecX& v) const {
  const VecX all = body.with_held(v);
  body.position = step.position(all);
  body.velocity = all;
  body.acceleration_known = false;
}

void applied_impulses(const DeformableBody& body, const DeformableStep& step, StepImpulses& out) {
  out.gravity.setZero(3 * body.nodes());
  for (int i = 0; i < body.nodes(); ++i)
    out.gravity.segment<3>(3 * i) = step.acting() * body.fem.node_mass()[i] * step.gravity;
  out.external = step.acting() * body.external_force;
  out.integrator.resize(0);
}

void OneStepScheme::impulses(DeformableBody& body, const DeformableStep& step, const VecX& v, StepImpulses& out) const {
  applied_impulses(body, step, out);
  body.fem.forces(step.position(v), out.elastic);
  out.elastic *= step.tau;
  out.damping = -step.tau * damping_force(body, step, v);
  add_pull(body, step, v, 1.0, out.external);
}

void advance_alone(const DeformableIntegrator& integrator, DeformableBody& body, const Vec3& gravity, double h,
                   LinearSolver& solver, DeformableStep& step) {
  integrator.begin(body, gravity, h, step);
  integrator.free_velocity(body, step, solver);
  integrator.advance(body, step, step.v_star);
}

}  // namespace impinge
