// The seed's scheme: backward Euler with one Newton iteration, A v* = b [Haapaoja16 §2.1]. For rigid bodies A = M and
// b = M v + Δt f, so v* = v + Δt g.
#include "engine/integrators/integrator.hpp"
#include "engine/integrators/rigid_motion.hpp"

namespace impinge {
namespace {

class LinearlyImplicitEuler : public Integrator {
 public:
  void free_velocity(std::span<RigidBody> bodies, const Vec3& gravity, double time_step) const override {
    for (RigidBody& body : bodies)
      if (body.is_dynamic() && !body.asleep) apply_gravity(body, gravity, time_step);
  }
  void advance(std::span<RigidBody> bodies, double time_step) const override {
    for (RigidBody& body : bodies)
      if (body.is_dynamic() && !body.asleep) advance_rigid(body, time_step);
  }
};

}  // namespace

Entry<Integrator> linearly_implicit_euler_integrator() { return entry<Integrator, LinearlyImplicitEuler>("linearly_implicit_euler", "backward Euler with one Newton iteration (the seed's scheme)"); }

}  // namespace impinge
