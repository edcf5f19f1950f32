// Backward Euler solved to the end: Newton's method with a line search. Unconditionally stable, damps (a vibration of ω
// loses a factor 1/√(1 + (ωh)²) a step).
#include "engine/integrators/deformable_integrator.hpp"
#include "engine/integrators/mean_turning.hpp"

namespace impinge {
namespace {

class ImplicitEuler : public OneStepScheme {
 public:
  void begin(DeformableBody& body, const Vec3& gravity, double h, DeformableStep& step) const override {
    step.time_step = step.s = h;
    step.tau = step.acting();
    step.gravity = gravity;
    step.offset.setZero(3 * body.nodes());
    step.v_hat = body.velocity;
    begin_step(body, false, step);
    if (body.damping.beta != 0.0) step.rigid = rigid_motion(body, h, TurningRule::exact);
  }
  const NewtonSettings* newton() const override { return &newton_; }
  void declare(const Rows& rows) override { newton_.declare(rows); }

 private:
  NewtonSettings newton_;
};

}  // namespace

Entry<DeformableIntegrator> implicit_euler_integrator() {
  return entry<DeformableIntegrator, ImplicitEuler>("implicit_euler",
                                                    "backward Euler, Newton's method with line search");
}

}  // namespace impinge
