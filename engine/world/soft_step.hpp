// A deformable body's part in a sub-step: its open system A v = b, the solvers of A, and where contact finds it.
#pragma once

#include "engine/bodies/rigid_body.hpp"
#include "engine/integrators/deformable_integrator.hpp"

namespace impinge {

struct SoftStep {
  DeformableStep step;
  std::unique_ptr<LinearSolver> iterative;  ///< for the one right-hand side of v*
  std::unique_ptr<LinearSolver> direct;     ///< for the many of contact
  bool touched = false;                     ///< contact or attachments gave it an impulse in this sub-step
  VecX velocity_before;                     ///< over all nodes, m/s
  VecX displacement_velocity;               ///< (s v* + d)/Δt over all nodes, m/s: what contact and detection see

  /// Solvers for this body's matrix.
  void choose_solvers(const DeformableBody& body, const LinearSolverChoice& choice);
  /// Opens the sub-step and solves A v* = b without contact. Throws DivergenceError naming frame and body.
  void begin(RigidBody& body, const DeformableIntegrator& integrator, const Vec3& gravity, double h, int frame);
  /// A and b at the velocity v of the free nodes, for one more Newton iteration. v* stays. Returns ‖A v - b - impulse‖
  /// relative to the momenta in it: how far v is from the root that contact leaves.
  double relinearize(RigidBody& body, const DeformableIntegrator& integrator, const VecX& v, const VecX& impulse);
  /// v* = A⁻¹ b after relinearize.
  void resolve(RigidBody& body, int frame);

 private:
  void find_displacement_velocity(RigidBody& body);
};

}  // namespace impinge
