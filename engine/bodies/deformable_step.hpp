// The open sub-step of a deformable body, as time integration fills it.
#pragma once

#include "engine/algebra/block_matrix.hpp"
#include "engine/algebra/linear_solver.hpp"

namespace impinge {

/// What changed the momenta M v of a sub-step that ends with a given velocity, by cause; over all nodes, kg m/s. At nodes
/// that are held it is what would have.
struct StepImpulses {
  VecX gravity, elastic, damping;
  VecX external;    ///< of the body's external force, and of who pulls it
  VecX integrator;  ///< of a scheme that remembers accelerations: what these are beside the forces; empty: nothing
};

/// Vectors over the free nodes (DeformableBody::free_node), x, y, z each. Keep it from one sub-step to the next: its
/// matrices are as large as the body, and begin() reuses them.
struct DeformableStep {
  double time_step = 0.0;  ///< h, s
  Vec3 gravity = Vec3::Zero();
  double tau = 0.0, s = 0.0;  ///< s
  double kick = 0.0;          ///< for how long forces act, s; 0: h
  VecX start;                 ///< x₀ over all nodes, m
  VecX offset;                ///< d over all nodes, m; of held nodes: how far they are moved
  VecX v_hat;                 ///< over all nodes, m/s
  VecX rigid;             ///< w over all nodes, m/s: what stiffness-proportional damping leaves alone; empty: nothing
  VecX force;             ///< elastic f(x₀) over all nodes, N
  BlockMatrix stiffness;  ///< K'(x₀) over all nodes, by which strain rates are damped, N/m; empty: none are
  BlockMatrix tangent;    ///< K(x₀ + Δq(v)) of the last linearization at v, or the only one, over all nodes, N/m
  BlockMatrix a;          ///< over the free nodes, kg
  double mass = 1.0;      ///< how much of M is in A: all of it that a motion of all nodes as one meets
  VecX b;                 ///< kg m/s
  double rounding = 0.0;  ///< of the balance A v - b of the last linearization at v, kg m/s: less is no force
  VecX v_star;            ///< solution without contact, m/s

  // how free_velocity fared
  int newton_iterations = 0;
  int linear_iterations = 0;
  double residual = 0.0;  ///< ‖g(v*)‖ relative to the first residual; of one-iteration schemes: of the linear solve
  bool converged = true;
  SolveStatus linear_status = SolveStatus::ok;

  double acting() const { return kick > 0.0 ? kick : time_step; }
  /// x₀ + s v + d over all nodes, m; v over all nodes too (DeformableBody::with_held).
  VecX position(const VecX& v) const { return start + s * v + offset; }
};

}  // namespace impinge
