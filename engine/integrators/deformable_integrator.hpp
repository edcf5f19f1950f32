// The schemes of time integration of deformable bodies, and what they share. [Haapaoja16 §2.1]
//
// Every implicit scheme here is the root of one residual, over the nodes that aren't held:
//   g(v) = M (v − v̂) + τ (D v − f(x₀ + Δq(v)) − f_ext),   Δq(v) = s v + d,   D = α M + β K'(x₀)
// backward Euler:  v̂ = v₀,                 τ = h,   s = h,      d = 0     (τ: see DeformableStep::acting)
// Newmark:         v̂ = v₀ + h (1 − γ) a₀,  τ = γ h, s = h β/γ,  d = (h − s) v₀ + h² (½ − β/γ) a₀
// with the derivative A = M + τ D + τ s K(x₀ + Δq(v)), symmetric. A linear solve at v is A v' = b, b = A v − g(v).
// K' is K, and of a body that is held nowhere K without what its elements do as rigid ones (elements/rigid_motions): stressed
// ones answer turning with forces, and strain rates with torque. A soft cube that hit a rod in empty space won a third of
// its spin from that, however small h. What is held has that of who holds it, and is damped as everybody does it.
// Where the forces are those of the end, K'(x₀) takes the turning that bends v away from a rotation about x₀ for a strain of
// h ω × (ω × r), and what damped it would brake whatever spins: D is applied to v − w there, w that of the body if it went on
// as a rigid one with the motion that it begins with (mean_turning).
// Contact adds Jᵀλ to b and reads its gap from x₀ + Δq(v).
#pragma once

#include "engine/bodies/deformable_body.hpp"
#include "engine/bodies/time_integration.hpp"

namespace impinge {

/// A scheme that is the root of g; it says what else it is by overriding.
class OneStepScheme : public DeformableIntegrator {
 public:
  void linearize(DeformableBody& body, const VecX& v, DeformableStep& step) const override;
  /// By Newton's method.
  void free_velocity(DeformableBody& body, DeformableStep& step, LinearSolver& solver) const override;
  void advance(DeformableBody& body, const DeformableStep& step, const VecX& v) const override;
  /// Of a scheme with v̂ = v₀ whose forces act for τ and are those of the end.
  void impulses(DeformableBody& body, const DeformableStep& step, const VecX& v, StepImpulses& out) const override;
};

const Registry<DeformableIntegrator>& integrators();

// What the schemes share.
/// Sets x₀, f(x₀), K'(x₀) where something is damped by it, K(x₀) as step.tangent where `with_tangent`, and the motion of held
/// nodes; the caller has set h, τ, s, v̂ and d.
void begin_step(DeformableBody& body, bool with_tangent, DeformableStep& step);
/// step.a = mass M + start K'(x₀) + now K, over the free nodes. `k` may be null where now = 0.
void fill_system(const DeformableBody& body, double mass, double start, double now, const BlockMatrix* k,
                 DeformableStep& step);
/// f_ext: gravity by nodal masses and the body's external force, N, over all nodes.
VecX applied_force(const DeformableBody& body, const Vec3& gravity);
/// D v = α M v + β K'(x₀) (v − w) over all nodes, N; w: DeformableStep::rigid.
VecX damping_force(const DeformableBody& body, const DeformableStep& step, const VecX& v);
/// Its potential, ½ α vᵀM v + ½ β (v − w)ᵀK'(x₀) (v − w), W.
double damping_potential(const DeformableBody& body, const DeformableStep& step, const VecX& v);
/// Fills `gravity` and `external` with what gravity and the body's external force give in the time in which they act.
void applied_impulses(const DeformableBody& body, const DeformableStep& step, StepImpulses& out);
/// Solves step.a v* = step.b, starting from the body's velocity.
void solve_free_velocity(const DeformableBody& body, DeformableStep& step, LinearSolver& solver);
/// g = M (v − v̂) + τ (damping − elastic − applied), forces in N over all nodes, and what pulls, kg m/s; `size`: the largest of
/// its parts.
VecX momentum_balance(const DeformableBody& body, const DeformableStep& step, const VecX& v, const VecX& elastic,
                      const VecX& damping, const VecX& applied, double& size);
/// The largest of a node with itself in step.tangent, N/m.
double largest_stiffness(const DeformableBody& body, const DeformableStep& step);
/// Forces are sums of products of stiffness and position: what of g can't be told from zero with that one, kg m/s.
double rounding_of_balance(const DeformableBody& body, const DeformableStep& step, double largest_stiffness);
/// −A⁻¹ g over the free nodes; false: there is none. step says how it fared.
bool newton_direction(LinearSolver& solver, const VecX& g, DeformableStep& step, VecX& direction);
/// Newton's method with a projected tangent and a line search on the incremental potential, whose gradient is g.
void newton_solve(DeformableBody& body, DeformableStep& step, LinearSolver& solver, const NewtonSettings& settings);
/// One sub-step from begin to advance, without contact.
void advance_alone(const DeformableIntegrator& integrator, DeformableBody& body, const Vec3& gravity, double h,
                   LinearSolver& solver, DeformableStep& step);

}  // namespace impinge
