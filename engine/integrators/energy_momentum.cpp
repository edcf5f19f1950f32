// The energy-momentum scheme [SimoTarnow92, Gonzalez00]: the midpoint rule with forces that do exactly the work by which the
// elastic energy falls (elements/discrete_gradient),
//   M (v₁ − v₀) = h (f̄(x₀, x₁) + f_ext − D v̄),   x₁ = x₀ + h v̄,   v̄ = (v₀ + v₁)/2.
// Second order; energy, momentum and angular momentum of what flies are kept, however stiff it is and however far it turns.
//
// f̄ has no potential and its derivative is not symmetric, which contact asks of A. So A takes half of the projected K in the
// middle: what it makes of a motion has no torque either, so that a stiff body's residual is none of its turning. Steps are
// shortened until the residual falls.
#include <algorithm>
#include <cmath>

#include "engine/core/interrupt.hpp"
#include "engine/integrators/deformable_integrator.hpp"
#include "engine/integrators/mean_turning.hpp"
#include "engine/integrators/pull_spring.hpp"

namespace impinge {
namespace {

constexpr int kResidualHalvings = 10;  // of a step that does not lower the residual

class EnergyMomentum : public OneStepScheme {
 public:
  void declare(const Rows& rows) override { newton_.declare(rows); }

  void begin(DeformableBody& body, const Vec3& gravity, double h, DeformableStep& step) const override {
    step.time_step = step.tau = h;
    step.s = 0.5 * h;
    step.gravity = gravity;
    step.offset.setZero(3 * body.nodes());
    step.v_hat = body.velocity;
    begin_step(body, false, step);
    if (body.damping.beta != 0.0) step.rigid = rigid_motion(body, h, TurningRule::midpoint);
    for (const int i : body.free_node()) step.offset.segment<3>(3 * i) = 0.5 * h * body.velocity.segment<3>(3 * i);
  }

  void linearize(DeformableBody& body, const VecX& v, DeformableStep& step) const override {
    double size = 0.0;
    find_system(body, v, step);
    step.b = step.a * v - residual(body, v, step, size);
    step.rounding = rounding_of_balance(body, step, largest_stiffness(body, step));
  }

  void free_velocity(DeformableBody& body, DeformableStep& step, LinearSolver& solver) const override {
    VecX v = body.gather_free(body.velocity);
    double size = 0.0;
    VecX g = residual(body, v, step, size);
    const double first = g.norm();
    step.converged = false;
    for (step.newton_iterations = 0;; ++step.newton_iterations) {
      check_interrupt();
      step.residual = first > 0.0 ? g.norm() / first : 0.0;
      find_system(body, v, step);
      step.b = step.a * v - g;
      step.converged =
          g.norm() <= newton_.tolerance * size + rounding_of_balance(body, step, largest_stiffness(body, step));
      if (step.converged || step.newton_iterations >= newton_.max_iterations || !std::isfinite(g.norm())) break;
      VecX direction;
      if (!newton_direction(solver, g, step, direction)) break;
      body.keep_momentum(step.mass, -g, direction);
      if (!go_down(body, step, direction, v, g, size)) break;
    }
    step.v_star = v;
  }

  void impulses(DeformableBody& body, const DeformableStep& step, const VecX& v, StepImpulses& out) const override {
    applied_impulses(body, step, out);
    body.fem.mean_forces(step.start, step.position(v), out.elastic);
    out.elastic *= step.tau;
    out.damping = -step.tau * damping_force(body, step, 0.5 * (step.v_hat + v));
    add_pull(body, step, v, 1.0, out.external);
  }
  const NewtonSettings* newton() const override { return &newton_; }
  bool may_stagger() const override { return false; }

 private:
  void find_system(DeformableBody& body, const VecX& v, DeformableStep& step) const {
    if (step.tangent.pattern != body.fem.pattern()) step.tangent = BlockMatrix(body.fem.pattern());
    VecX force;
    const VecX middle = 0.5 * (step.start + step.position(body.with_held(v)));
    body.fem.stiffness(middle, Tangent::projected, force, step.tangent);
    const RayleighDamping& d = body.damping;
    const double half = 0.5 * step.tau;
    fill_system(body, 1.0 + half * d.alpha, half * d.beta, half * step.s, &step.tangent, step);
    add_pull_to_system(body, step);
  }

  /// g over the free nodes, and the size of the largest of its parts, kg m/s.
  VecX residual(DeformableBody& body, const VecX& v, const DeformableStep& step, double& size) const {
    const VecX all = body.with_held(v);
    VecX elastic;
    body.fem.mean_forces(step.start, step.position(all), elastic);
    return body.gather_free(momentum_balance(body, step, all, elastic,
                                             damping_force(body, step, 0.5 * (step.v_hat + all)),
                                             applied_force(body, step.gravity), size));
  }

  /// As much of the direction as lowers the residual; false: none does.
  bool go_down(DeformableBody& body, const DeformableStep& step, const VecX& direction, VecX& v, VecX& g,
               double& size) const {
    double length = 1.0;
    for (int i = 0; i <= kResidualHalvings; ++i, length *= 0.5) {
      const VecX trial = v + length * direction;
      VecX after = residual(body, trial, step, size);
      if (!(after.norm() < g.norm())) continue;
      v = trial, g = std::move(after);
      return true;
    }
    return false;
  }

  NewtonSettings newton_;
};

}  // namespace

Entry<DeformableIntegrator> energy_momentum_integrator() {
  return entry<DeformableIntegrator, EnergyMomentum>("energy_momentum",
                                                     "midpoint rule with forces that keep energy and angular momentum");
}

}  // namespace impinge
