// Time integration of deformable bodies: what the velocity of a sub-step has to satisfy, A v = b, and what it does to
// the positions, Δq(v). For rigid bodies, where A = M and b = M v + Δt f, all schemes are the same map (rigid_motion.hpp).
// [Haapaoja16 §2.1]
//
// Every implicit scheme here is the root of one residual, over the nodes that aren't held:
//   g(v) = M (v − v̂) + τ (D v − f(x₀ + Δq(v)) − f_ext),   Δq(v) = s v + d,   D = α M + β K(x₀)
// backward Euler:  v̂ = v₀,                 τ = h,   s = h,      d = 0
// Newmark:         v̂ = v₀ + h (1 − γ) a₀,  τ = γ h, s = h β/γ,  d = (h − s) v₀ + h² (½ − β/γ) a₀
// with the derivative A = M + τ D + τ s K(x₀ + Δq(v)), symmetric. A linear solve at v is A v' = b, b = A v − g(v).
// Contact adds Jᵀλ to b and reads its gap from x₀ + Δq(v).
#pragma once

#include "engine/algebra/linear_solver.hpp"
#include "engine/bodies/deformable_body.hpp"
#include "engine/core/method.hpp"

namespace impinge {

/// One body's sub-step. Vectors over the free nodes (DeformableBody::free_node), x, y, z each. Keep it from one
/// sub-step to the next: its matrices are as large as the body, and begin() reuses them.
struct DeformableStep {
  double time_step = 0.0;  ///< h, s
  Vec3 gravity = Vec3::Zero();
  double tau = 0.0, s = 0.0;  ///< s
  VecX start;                 ///< x₀ over all nodes, m
  VecX offset;                ///< d over all nodes, m; of held nodes: how far they are moved
  VecX v_hat;                 ///< over all nodes, m/s
  VecX force;                 ///< elastic f(x₀) over all nodes, N
  BlockMatrix stiffness;      ///< K(x₀) over all nodes, N/m; empty where nothing needs it
  BlockMatrix tangent;  ///< K(x₀ + Δq(v)) of the last linearization at v, over all nodes, N/m; Newton schemes only
  BlockMatrix a;        ///< over the free nodes, kg
  VecX b;               ///< kg m/s
  VecX v_star;          ///< solution without contact, m/s

  // how free_velocity fared
  int newton_iterations = 0;
  int linear_iterations = 0;
  double residual = 0.0;  ///< ‖g(v*)‖ relative to the first residual; of one-iteration schemes: of the linear solve
  bool converged = true;
  SolveStatus linear_status = SolveStatus::ok;

  /// x₀ + s v + d over all nodes, m; v over all nodes too (with_held).
  VecX position(const VecX& v) const { return start + s * v + offset; }
};

/// Of the schemes that are solved to the root of g.
struct NewtonSettings {
  double tolerance = 1e-6;  ///< on ‖g‖ relative to the forces and momenta that make it up
  int max_iterations = 50;

  void declare(const Rows& rows);
};

class DeformableIntegrator : public Method {
 public:
  /// Opens a sub-step of h seconds: x₀, v̂, τ, s, d, and K(x₀) where it is needed. gravity: m/s².
  virtual void begin(DeformableBody& body, const Vec3& gravity, double h, DeformableStep& step) const = 0;
  /// A and b at the velocity v of the free nodes.
  virtual void linearize(DeformableBody& body, const VecX& v, DeformableStep& step) const;
  /// v* and the A and b it was last solved with, by Newton's method unless overridden. `solver` must have been analyzed with body.free_pattern().
  virtual void free_velocity(DeformableBody& body, DeformableStep& step, LinearSolver& solver) const;
  /// Closes the sub-step with the velocity v of the free nodes (v* or what contact made of it).
  virtual void advance(DeformableBody& body, const DeformableStep& step, const VecX& v) const;
  /// Of a scheme whose free_velocity iterates to the root of g, so that contact has to be solved in each of its
  /// iterations; null for others.
  virtual const NewtonSettings* newton() const { return nullptr; }
  /// Whether A = M: with lumped mass its blocks stand alone.
  virtual bool is_explicit() const { return false; }
};

const Registry<DeformableIntegrator>& integrators();

// What the schemes share.
/// Sets x₀, f(x₀), K(x₀) where `with_stiffness`, and the motion of held nodes; the caller has set h, τ, s, v̂ and d.
void begin_step(DeformableBody& body, bool with_stiffness, DeformableStep& step);
/// step.a = mass M + start K(x₀) + now K, over the free nodes. `k` may be null where now = 0.
void fill_system(const DeformableBody& body, double mass, double start, double now, const BlockMatrix* k,
                 DeformableStep& step);
/// f_ext: gravity by nodal masses and the body's external force, N, over all nodes.
VecX applied_force(const DeformableBody& body, const Vec3& gravity);
/// D v = α M v + β K(x₀) v over all nodes, N.
VecX damping_force(const DeformableBody& body, const DeformableStep& step, const VecX& v);
/// `free` with the prescribed velocities of held nodes, over all nodes.
VecX with_held(const DeformableBody& body, const VecX& free);
/// Solves step.a v* = step.b, starting from the body's velocity.
void solve_free_velocity(const DeformableBody& body, DeformableStep& step, LinearSolver& solver);
/// Newton's method with a projected tangent and a line search on the incremental potential, whose gradient is g.
void newton_solve(DeformableBody& body, DeformableStep& step, LinearSolver& solver, const NewtonSettings& settings);
/// One sub-step from begin to advance, without contact.
void advance_alone(const DeformableIntegrator& integrator, DeformableBody& body, const Vec3& gravity, double h,
                   LinearSolver& solver, DeformableStep& step);

}  // namespace impinge
