// What bodies ask of time integration. The schemes are in integrators/.
#pragma once

#include "engine/algebra/linear_solver.hpp"
#include "engine/core/method.hpp"
#include "engine/core/types.hpp"

namespace impinge {

class DeformableBody;
struct DeformableStep;
struct StepImpulses;

/// Of the schemes that are solved to the root of g.
struct NewtonSettings {
  double tolerance = 1e-6;  ///< on ‖g‖ relative to the forces and momenta that make it up
  int max_iterations = 50;

  void declare(const Rows& rows);
};

/// What the velocity of a deformable body's sub-step has to satisfy, A v = b, and what it does to the positions, Δq(v).
/// For rigid bodies, where A = M and b = M v + Δt f, all schemes are the same map (rigid_body.hpp).
class DeformableIntegrator : public Method {
 public:
  /// Opens a sub-step of h seconds: x₀, v̂, τ, s, d, and K(x₀) where it is needed. gravity: m/s².
  virtual void begin(DeformableBody& body, const Vec3& gravity, double h, DeformableStep& step) const = 0;
  /// A and b at the velocity v of the free nodes.
  virtual void linearize(DeformableBody& body, const VecX& v, DeformableStep& step) const = 0;
  /// v* and the A and b it was last solved with. `solver` must have been analyzed with body.free_pattern().
  virtual void free_velocity(DeformableBody& body, DeformableStep& step, LinearSolver& solver) const = 0;
  /// Closes the sub-step with the velocity v of the free nodes (v* or what contact made of it).
  virtual void advance(DeformableBody& body, const DeformableStep& step, const VecX& v) const = 0;
  /// Of the open sub-step, if it ends with v (over all nodes) and the body still has the velocity before it: what the
  /// scheme's equation says, without contact and what its solution is short of.
  virtual void impulses(DeformableBody& body, const DeformableStep& step, const VecX& v, StepImpulses& out) const = 0;
  /// Of a scheme whose free_velocity iterates to the root of g, so that contact has to be solved in each of its
  /// iterations; null for others.
  virtual const NewtonSettings* newton() const { return nullptr; }
  /// Whether A = M: with lumped mass its blocks stand alone.
  virtual bool is_explicit() const { return false; }
  /// Whether its velocities may be those of the middle: x₁ = x₀ + Δt v₁, with forces that act for as long as
  /// DeformableStep::acting says. One with positions of its own has velocities of the end.
  virtual bool may_stagger() const { return true; }
};

/// What the velocities that a sub-step finds, v₁ of x₁ = x₀ + Δt v₁, are taken for.
enum class VelocityTime : std::uint8_t {
  end,    ///< those of its end: symplectic Euler
  middle  ///< those of its middle: leapfrog; the first sub-step of a motion gives half of the forces
};

/// How a sub-step is integrated.
struct TimeIntegration {
  const DeformableIntegrator& integrator;
  const LinearSolverChoice& linear_solver;  ///< of deformable bodies' systems
  Vec3 gravity = Vec3::Zero();              ///< m/s²
  double time_step = 0.0;                   ///< Δt, s
  VelocityTime velocities = VelocityTime::end;

  /// How late in the sub-step the velocities belong that it finds, s.
  double ahead() const { return velocities == VelocityTime::middle ? 0.5 * time_step : time_step; }
};

}  // namespace impinge
