// The seed's scheme: backward Euler with one Newton iteration [Haapaoja16 §2.1],
//   A v = b,  A = M − Δt ∂f/∂v − Δt² ∂f/∂q,  b = Δt f(q₀, v₀) + (M − Δt ∂f/∂v) v₀.
// With Rayleigh damping ∂f/∂v = −D and f(q₀, v₀) = f(q₀) − D v₀, so D v₀ cancels: b = M v₀ + Δt (f(q₀) + f_ext).
#include "engine/integrators/deformable_integrator.hpp"
#include "engine/integrators/pull_spring.hpp"

namespace impinge {
namespace {

class LinearlyImplicitEuler : public OneStepScheme {
 public:
  void begin(DeformableBody& body, const Vec3& gravity, double h, DeformableStep& step) const override {
    step.time_step = step.s = h;
    step.tau = step.acting();
    step.gravity = gravity;
    step.offset.setZero(3 * body.nodes());
    step.v_hat = body.velocity;
    begin_step(body, true, step);
  }

  /// A and b belong to x₀; the velocity they are asked for doesn't matter.
  void linearize(DeformableBody& body, const VecX&, DeformableStep& step) const override {
    const double tau = step.tau;
    const RayleighDamping& d = body.damping;
    const double mass = 1.0 + tau * d.alpha, damping = tau * d.beta, stiffness = tau * step.s;
    fill_system(body, mass, damping, stiffness, &step.tangent, step);
    add_pull_to_system(body, step);
    VecX b;
    body.fem.multiply_mass(step.v_hat, b);
    b += tau * (step.force + applied_force(body, step.gravity));
    add_pull(body, step, body.held_velocity(), 1.0, b);
    if (!body.held_velocity().isZero(0.0)) {
      // columns of the held nodes, whose velocity is known
      VecX part;
      body.fem.multiply_mass(body.held_velocity(), part);
      b -= mass * part + stiffness * (step.tangent * body.held_velocity());
      if (damping != 0.0) b -= damping * (step.stiffness * body.held_velocity());
    }
    step.b = body.gather_free(b);
  }

  void impulses(DeformableBody& body, const DeformableStep& step, const VecX& v, StepImpulses& out) const override {
    const double tau = step.tau;
    applied_impulses(body, step, out);
    out.elastic = tau * step.force - tau * step.s * (step.tangent * v);
    out.damping = -tau * damping_force(body, step, v);
    add_pull(body, step, v, 1.0, out.external);
  }

  void free_velocity(DeformableBody& body, DeformableStep& step, LinearSolver& solver) const override {
    linearize(body, {}, step);
    solve_free_velocity(body, step, solver);
    body.keep_momentum(step.mass, step.b, step.v_star);
  }
};

}  // namespace

Entry<DeformableIntegrator> linearly_implicit_euler_integrator() {
  return entry<DeformableIntegrator, LinearlyImplicitEuler>(
      "linearly_implicit_euler", "backward Euler with one Newton iteration (the seed's scheme)");
}

}  // namespace impinge
