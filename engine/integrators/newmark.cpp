// Newmark's scheme [Newmark59]: x₁ = x₀ + h v₀ + h² ((½ − β) a₀ + β a₁), v₁ = v₀ + h ((1 − γ) a₀ + γ a₁), solved for v₁
// by Newton's method. β = ¼, γ = ½ (constant average acceleration): second order, no damping of its own in linear
// problems. Stiffness-proportional damping brakes what turns, by 4 β (μ + λ) V (ω h)² ω of a stiff body's angular momentum
// a second: K(x₀) has a strain in the velocities of the step's end. Without the turning of the whole, as other schemes have
// it (mean_turning.hpp), the scheme has nothing that holds it: a stiff cube that turned by 0.08 radians a step had 200 times
// its energy after a second, where the brake keeps it. Who wants spins kept takes energy_momentum.
#include "engine/integrators/deformable_integrator.hpp"
#include "engine/integrators/pull_spring.hpp"

namespace impinge {
namespace {

class Newmark : public OneStepScheme {
 public:
  void declare(const Rows& rows) override {
    newton_.declare(rows);
    rows.add("beta", settings_.beta, {0.05, 0.5}, "", "How much of the end's acceleration enters the positions.");
    rows.add("gamma", settings_.gamma, {0.5, 1.0}, "", "How much of it enters the velocities; above 1/2 it damps.");
  }

  void begin(DeformableBody& body, const Vec3& gravity, double h, DeformableStep& step) const override {
    const auto [beta, gamma] = settings_;
    step.time_step = h;
    step.tau = gamma * h;
    step.s = h * beta / gamma;
    step.gravity = gravity;
    step.offset.setZero(3 * body.nodes());
    begin_step(body, false, step);
    if (!body.acceleration_known) accelerate(body, step);
    step.v_hat = body.velocity + (1.0 - gamma) * h * body.acceleration;
    const VecX d = (h - step.s) * body.velocity + h * h * (0.5 - beta / gamma) * body.acceleration;
    for (const int i : body.free_node()) step.offset.segment<3>(3 * i) = d.segment<3>(3 * i);
  }

  void advance(DeformableBody& body, const DeformableStep& step, const VecX& v) const override {
    const double gamma = settings_.gamma;
    const VecX before = body.velocity;
    OneStepScheme::advance(body, step, v);
    body.acceleration = (body.velocity - before) / (gamma * step.time_step) - (1.0 - gamma) / gamma * body.acceleration;
    for (int i = 0; i < body.nodes(); ++i)
      if (body.is_held(i)) body.acceleration.segment<3>(3 * i).setZero();
    body.acceleration_known = true;
  }
  /// The part of the sub-step that a₀ makes is split by the forces at its start; what a₀ is beside these, the scheme has
  /// remembered from sub-steps before.
  void impulses(DeformableBody& body, const DeformableStep& step, const VecX& v, StepImpulses& out) const override {
    const double start = (1.0 - settings_.gamma) * step.time_step;
    applied_impulses(body, step, out);
    const VecX damping = damping_force(body, step, body.velocity);
    body.fem.multiply_mass(body.acceleration, out.integrator);
    out.integrator = start * (out.integrator - step.force - applied_force(body, step.gravity) + damping);
    body.fem.forces(step.position(v), out.elastic);
    out.elastic = start * step.force + step.tau * out.elastic;
    out.damping = -start * damping - step.tau * damping_force(body, step, v);
    add_pull(body, step, v, 1.0, out.external);
  }
  const NewtonSettings* newton() const override { return &newton_; }
  bool may_stagger() const override { return false; }

 private:
  struct Settings {
    double beta = 0.25, gamma = 0.5;
  };

  /// M a₀ = f(x₀) + f_ext − D v₀, once: later accelerations follow from the velocities.
  static void accelerate(DeformableBody& body, DeformableStep& step) {
    fill_system(body, 1.0, 0.0, 0.0, nullptr, step);
    const VecX force = step.force + applied_force(body, step.gravity) - damping_force(body, step, body.velocity);
    const std::unique_ptr<LinearSolver> solver = make_linear_solver("conjugate_gradient");
    solver->tolerance = 1e-13;
    solver->analyze(*body.free_pattern());
    VecX a = VecX::Zero(body.dofs());
    if (solver->factorize(step.a) == SolveStatus::ok) solver->solve(body.gather_free(force), a);
    body.acceleration.setZero();
    body.scatter_free(a, body.acceleration);
    body.acceleration_known = true;
  }

  NewtonSettings newton_;
  Settings settings_;
};

}  // namespace

Entry<DeformableIntegrator> newmark_integrator() {
  return entry<DeformableIntegrator, Newmark>(
      "newmark", "Newmark's scheme, Newton's method with line search; stiffness damping brakes spins");
}

}  // namespace impinge
