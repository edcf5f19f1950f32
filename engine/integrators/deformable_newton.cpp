// Newton's method for an implicit sub-step, as the minimization of its incremental potential
//   φ(v) = ½ (v − v̂)ᵀ M (v − v̂) + τ/2 vᵀ D v − τ f_extᵀ v + (τ/s) Ψ(x₀ + s v + d),   ∇φ = g,
// [Gast15]: with a projected tangent each step is a descent direction, and halving it until φ falls makes the
// iteration converge from anywhere, inverted elements included where the material allows them.
#include <algorithm>
#include <cmath>

#include "engine/core/interrupt.hpp"
#include "engine/integrators/deformable_integrator.hpp"
#include "engine/integrators/pull_spring.hpp"

namespace impinge {
namespace {

constexpr int kHalvings = 30;  // of a step that does not lower the incremental potential, at most

class IncrementalPotential {
 public:
  IncrementalPotential(DeformableBody& body, const DeformableStep& step)
      : body_(body), step_(step), applied_(applied_force(body, step.gravity)) {}

  double value(const VecX& v, double elastic) const {
    VecX inertia;
    const VecX difference = v - step_.v_hat;
    body_.fem.multiply_mass(difference, inertia);
    return 0.5 * dot(difference, inertia) + step_.tau * (damping_potential(body_, step_, v) - dot(applied_, v)) +
           step_.tau / step_.s * elastic + pull_potential(body_, step_, v);
  }
  double value(const VecX& v) const { return value(v, body_.fem.energy(step_.position(v))); }

  /// g at v, and the size of the largest of its parts, kg m/s.
  VecX gradient(const VecX& v, const VecX& elastic_force, double& size) const {
    VecX inertia, momentum;
    body_.fem.multiply_mass(v - step_.v_hat, inertia);
    body_.fem.multiply_mass(step_.v_hat, momentum);
    const VecX damping = damping_force(body_, step_, v);
    VecX g = inertia + step_.tau * (damping - elastic_force - applied_);
    const Vec3 pulled = add_pull(body_, step_, v, -1.0, g);
    size = std::max({momentum.norm(), inertia.norm(), step_.tau * damping.norm(), step_.tau * elastic_force.norm(),
                     step_.tau * applied_.norm(), pulled.norm()});
    return g;
  }

 private:
  DeformableBody& body_;
  const DeformableStep& step_;
  VecX applied_;
};

}  // namespace

void newton_solve(DeformableBody& body, DeformableStep& step, LinearSolver& solver, const NewtonSettings& settings) {
  IncrementalPotential potential(body, step);
  if (step.tangent.pattern != body.fem.pattern()) step.tangent = BlockMatrix(body.fem.pattern());
  BlockMatrix& k = step.tangent;
  VecX force, v = body.with_held(body.gather_free(body.velocity));
  double first_residual = 0.0;
  step.converged = false;
  for (step.newton_iterations = 0;; ++step.newton_iterations) {
    check_interrupt();
    const double elastic = body.fem.stiffness(step.position(v), Tangent::projected, force, k);
    double size = 0.0;
    const VecX g = body.gather_free(potential.gradient(v, force, size));
    const double residual = g.norm();
    if (step.newton_iterations == 0) first_residual = residual;
    step.residual = first_residual > 0.0 ? residual / first_residual : 0.0;

    const RayleighDamping& d = body.damping;
    fill_system(body, 1.0 + step.tau * d.alpha, step.tau * d.beta, step.tau * step.s, &k, step);
    add_pull_to_system(body, step);
    const VecX v_free = body.gather_free(v);
    step.b = step.a * v_free - g;
    // forces are sums of products of stiffness and position, so they can't be told from zero below their rounding
    double largest = 0.0;
    for (int i = 0; i < body.nodes(); ++i)
      largest = std::max(largest, k.values[body.fem.pattern()->diagonal[i]].trace());
    const double extent = step.start.cwiseAbs().maxCoeff();
    const double rounding = 1e-15 * step.tau * largest * extent * std::sqrt(static_cast<double>(body.nodes()));
    const double potential_rounding = 1e-15 * step.tau / step.s * largest * extent * extent;
    if (residual <= settings.tolerance * size + rounding) {
      step.converged = true;
      break;
    }
    if (step.newton_iterations >= settings.max_iterations || !std::isfinite(residual)) break;

    step.linear_status = solver.factorize(step.a);
    if (step.linear_status != SolveStatus::ok) break;
    VecX direction = VecX::Zero(g.size());
    const SolveReport report = solver.solve(-g, direction);
    step.linear_iterations += report.iterations;
    step.linear_status = report.status;
    if (report.status != SolveStatus::ok && report.status != SolveStatus::not_converged) break;

    const double slope = dot(direction, g), before = potential.value(v, elastic);
    bool lowered = false;
    VecX trial = v;
    double length = 1.0;
    for (int i = 0; i <= kHalvings && !lowered; ++i, length *= 0.5) {
      body.scatter_free(v_free + length * direction, trial);
      const double after = potential.value(trial);
      // close to the solution the fall is below the rounding of φ: then the full step is right
      lowered = after <= before + 1e-4 * length * slope + 1e-14 * std::abs(before) + potential_rounding;
    }
    if (!lowered) break;
    v = trial;
  }
  step.v_star = body.gather_free(v);
}

}  // namespace impinge
