// The explicit baseline: velocities from the forces at the start, positions from the new velocities. For rigid bodies it is
// the same map as linearly_implicit_euler, because nothing but gravity acts between contacts.
#include "engine/integrators/integrator.hpp"
#include "engine/integrators/rigid_motion.hpp"

namespace impinge {
namespace {

class SymplecticEuler : public Integrator {
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

Entry<Integrator> symplectic_euler_integrator() { return entry<Integrator, SymplecticEuler>("symplectic_euler", "explicit baseline: new velocity first, then position"); }

}  // namespace impinge
