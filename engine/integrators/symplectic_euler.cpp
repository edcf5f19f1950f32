// Symplectic Euler, the explicit baseline: M v = M v₀ + h (f(x₀) + f_ext − D v₀), x = x₀ + h v. A = M, so contact is
// cheap; stable only for h < 2/ω_max, ω_max the highest frequency of the mesh (its smallest, stiffest tetrahedron).
#include "engine/integrators/deformable_integrator.hpp"
#include "engine/integrators/pull_spring.hpp"

namespace impinge {
namespace {

class SymplecticEuler : public OneStepScheme {
 public:
  void begin(DeformableBody& body, const Vec3& gravity, double h, DeformableStep& step) const override {
    step.time_step = step.s = h;
    step.tau = step.acting();
    step.gravity = gravity;
    step.offset.setZero(3 * body.nodes());
    step.v_hat = body.velocity;
    begin_step(body, false, step);
  }

  void linearize(DeformableBody& body, const VecX&, DeformableStep& step) const override {
    fill_system(body, 1.0, 0.0, 0.0, nullptr, step);
    VecX b;
    body.fem.multiply_mass(step.v_hat - body.held_velocity(), b);
    b += step.tau * (step.force + applied_force(body, step.gravity) - damping_force(body, step, step.v_hat));
    add_limited_pull(body, step, b);
    step.b = body.gather_free(b);
  }

  void free_velocity(DeformableBody& body, DeformableStep& step, LinearSolver& solver) const override {
    linearize(body, {}, step);
    if (body.fem.mass_kind() == MassKind::consistent) return solve_free_velocity(body, step, solver);
    step.v_star.resize(body.dofs());
    for (int i = 0; i < body.free_nodes(); ++i)
      step.v_star.segment<3>(3 * i) = step.b.segment<3>(3 * i) / body.fem.node_mass()[body.free_node()[i]];
  }
  void impulses(DeformableBody& body, const DeformableStep& step, const VecX&, StepImpulses& out) const override {
    applied_impulses(body, step, out);
    out.elastic = step.tau * step.force;
    out.damping = -step.tau * damping_force(body, step, step.v_hat);
    add_limited_pull(body, step, out.external);
  }
  bool is_explicit() const override { return true; }
};

}  // namespace

Entry<DeformableIntegrator> symplectic_euler_integrator() {
  return entry<DeformableIntegrator, SymplecticEuler>("symplectic_euler", "explicit baseline, A = M");
}

}  // namespace impinge
