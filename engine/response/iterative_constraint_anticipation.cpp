// Iterative constraint anticipation, ICA [Haapaoja16 §4.1.4], [Otaduy09]: A⁻¹ of a deformable body is never asked for. An
// outer loop relaxes A Δv = J^T λ with the block diagonal of A, an inner one solves contact on J D⁻¹ J^T, which is sparse.
//
// form = "seed", as printed: inner c(i) = bound - J v* - J D⁻¹ (L + U) Δv(i-1), then one block Gauss-Seidel sweep
//   (D - L) Δv(i) = U Δv(i-1) + J^T λ(i).
// form = "accelerated": each outer step minimises the quadratic that lies above ½ Δv^T A Δv and touches it at an extrapolated
//   point y: with Q = c·D, c >= λ_max(D⁻¹A), w = y - Q⁻¹ A y, contact on J Q⁻¹ J^T, Δv = w + Q⁻¹ J^T λ; y by Nesterov's
//   rule with restart. D alone (c = 1) diverges: λ_max(D⁻¹A) is 2.2 to 3.2 on tetrahedral meshes.
// stop = "residual": natural map of (J v - bound, λ) and ‖A Δv - J^T λ‖ in the norm of D⁻¹, both true residuals.
// stop = "change": the seed's rule, a change of ‖A Δv - J^T λ‖ by less than 5 % between iterations; it stops far away.
//
// Rigid bodies enter with D = A: one step moves them exactly.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "engine/lcp/residual.hpp"
#include "engine/response/factored_delassus.hpp"
#include "engine/response/response.hpp"

namespace impinge {
namespace {

constexpr double kSeedChange = 0.05;
constexpr double kSafety = 1.02;  // the power method approaches λ_max from below
constexpr int kPowerIterations = 12;

struct Relaxation {
  std::vector<std::vector<Mat3>> inverse;  // D⁻¹, or Q⁻¹, by deformable body and node
  std::vector<VecX> a_delta;               // A Δv
};

VecX apply_blocks(const std::vector<Mat3>& blocks, const VecX& x) {
  VecX y(x.size());
  for (std::size_t i = 0; i < blocks.size(); ++i) y.segment<3>(3 * static_cast<Eigen::Index>(i)) = blocks[i] * x.segment<3>(3 * static_cast<Eigen::Index>(i));
  return y;
}

std::vector<Mat3> inverse_diagonal(const BlockMatrix& a) {
  std::vector<Mat3> inverse;
  for (int i = 0; i < a.pattern->rows; ++i) inverse.push_back(a.values[a.pattern->diagonal[i]].inverse());
  return inverse;
}

/// λ_max(D⁻¹A) by the power method from a fixed start; at most 4, the nodes of a tetrahedron.
double largest_eigenvalue(const BlockMatrix& a, const std::vector<Mat3>& inverse) {
  VecX x(a.rows());
  for (Eigen::Index i = 0; i < x.size(); ++i) x[i] = 1.0 + 0.5 * std::sin(12.9898 * static_cast<double>(i + 1));  // no symmetry to be caught in
  double value = 1.0;
  for (int k = 0; k < kPowerIterations; ++k) {
    const VecX y = apply_blocks(inverse, a * x);
    value = y.norm() / x.norm();
    x = y / y.norm();
  }
  return std::min(4.0, kSafety * value);
}

/// One block Gauss-Seidel sweep on A x = b.
void sweep(const BlockMatrix& a, const std::vector<Mat3>& inverse, const VecX& b, VecX& x) {
  const BlockPattern& p = *a.pattern;
  for (int i = 0; i < p.rows; ++i) {
    Vec3 r = b.segment<3>(3 * i);
    for (int k = p.begin[i]; k < p.begin[i + 1]; ++k)
      if (k != p.diagonal[i]) r -= a.values[k] * x.segment<3>(3 * p.column[k]);
    x.segment<3>(3 * i) = inverse[i] * r;
  }
}

class IterativeConstraintAnticipation : public Response {
 public:
  ResponseResult solve(GroupSystem& group, const LcpSolver& solver, const ResponseSettings& settings) const override {
    group.clear_delta();
    const ConeProblem base = make_cone_problem(group);
    double scale = 0.0;
    for (const Vec3& q : base.q) scale = std::max(scale, q.norm());
    const bool seed = settings.form == "seed";

    std::vector<std::vector<Mat3>> diagonal, inverse;
    for (const SoftBlock& block : group.soft) {
      diagonal.push_back(inverse_diagonal(*block.a));
      inverse.push_back(diagonal.back());
      if (seed) continue;
      const double c = largest_eigenvalue(*block.a, diagonal.back());
      for (Mat3& m : inverse.back()) m /= c;
    }
    FactoredDelassus w(group, &inverse);
    ConeProblem problem = base;
    problem.w = &w;

    ResponseResult result;
    std::vector<VecX> x, y;  // Δv of the deformable bodies, and where the next step starts from
    for (const SoftBlock& block : group.soft) x.push_back(VecX::Zero(block.velocity.size()));
    y = x;
    double momentum_before = -1.0, theta = 1.0;
    // an inner solve need not be more accurate than the outer step that uses it
    LcpSettings inner = settings.lcp;
    inner.tolerance = std::max(0.1 * settings.lcp.tolerance, 1e-14);
    result.converged = false;
    while (result.outer_iterations < settings.max_outer_iterations) {
      // what the bodies do without a change of λ: for rigid bodies nothing, since D = A
      std::vector<VecX> drift;
      for (std::size_t s = 0; s < x.size(); ++s) drift.push_back(y[s] - apply_blocks(inverse[s], *group.soft[s].a * y[s]));
      for (std::size_t i = 0; i < base.q.size(); ++i) problem.q[i] = base.q[i] + soft_velocity(group, drift, i);
      inner.max_iterations = seed || x.empty() ? settings.lcp.max_iterations : std::min(settings.lcp.max_iterations, 20);
      const LcpResult solved = solver.solve(problem, inner, group.lambda);
      result.iterations += solved.iterations;
      w.begin(group.lambda);
      ++result.outer_iterations;

      const std::vector<VecX> last = x;
      for (std::size_t s = 0; s < x.size(); ++s) {
        if (seed) {
          sweep(*group.soft[s].a, diagonal[s], group.soft_impulse(static_cast<int>(s), group.lambda), x[s]);
          y[s] = x[s];
        } else {
          x[s] = drift[s] + group.soft_delta[s];
        }
      }
      if (!seed) extrapolate(x, last, y, theta);

      const double momentum = momentum_residual(group, diagonal, x);
      if (settings.stop == "change") {
        const bool settled = momentum_before >= 0.0 && std::abs(momentum - momentum_before) < kSeedChange * momentum_before;
        momentum_before = momentum;
        if (settled || momentum == 0.0) result.converged = true;
      } else {
        result.converged = momentum <= settings.lcp.tolerance && contact_residual(group, base, w, x) <= settings.lcp.tolerance * scale;
      }
      if (x.empty()) result.converged = solved.solved();
      if (result.converged || x.empty()) break;  // D = A for rigid bodies: one step is all
    }
    w.begin(group.lambda);
    group.soft_delta = x;
    return result;
  }

 private:
  /// J Δv of contact i for given Δv of the deformable bodies only.
  static Vec3 soft_velocity(const GroupSystem& group, const std::vector<VecX>& delta, std::size_t i) {
    Vec3 relative = Vec3::Zero();
    for (const auto& [side, sign] : {std::pair(&group.contacts[i].a, 1.0), std::pair(&group.contacts[i].b, -1.0)})
      for (const NodeWeight& n : side->nodes)
        relative += sign * n.weight * delta[side->soft].segment<3>(3 * n.node);
    return group.contacts[i].directions * relative;
  }

  /// Nesterov's extrapolation, restarted where the step turned against it.
  static void extrapolate(const std::vector<VecX>& x, const std::vector<VecX>& last, std::vector<VecX>& y, double& theta) {
    double turn = 0.0;
    for (std::size_t s = 0; s < x.size(); ++s) turn += (y[s] - x[s]).dot(x[s] - last[s]);
    if (turn > 0.0) theta = 1.0;
    const double next = 0.5 * (1.0 + std::sqrt(1.0 + 4.0 * theta * theta));
    const double beta = turn > 0.0 ? 0.0 : (theta - 1.0) / next;
    for (std::size_t s = 0; s < x.size(); ++s) y[s] = x[s] + beta * (x[s] - last[s]);
    theta = next;
  }

  /// ‖A Δv - J^T λ‖ / ‖J^T λ‖ over the deformable bodies, in the norm of D⁻¹.
  static double momentum_residual(const GroupSystem& group, const std::vector<std::vector<Mat3>>& diagonal, const std::vector<VecX>& x) {
    double error = 0.0, size = 0.0;
    for (std::size_t s = 0; s < x.size(); ++s) {
      const VecX impulse = group.soft_impulse(static_cast<int>(s), group.lambda), r = *group.soft[s].a * x[s] - impulse;
      error += r.dot(apply_blocks(diagonal[s], r));
      size += impulse.dot(apply_blocks(diagonal[s], impulse));
    }
    return size > 0.0 ? std::sqrt(error / size) : std::sqrt(error);
  }

  /// The natural map at the present Δv and λ, in m/s; ρ by the diagonal of J Q⁻¹ J^T.
  static double contact_residual(GroupSystem& group, const ConeProblem& base, FactoredDelassus& w, const std::vector<VecX>& x) {
    const std::vector<VecX> kept = group.soft_delta;
    group.soft_delta = x;
    double worst = 0.0;
    for (std::size_t i = 0; i < base.q.size(); ++i)
      worst = std::max(worst, natural_map(w.diagonal(i), w.row(i, false) + base.q[i], group.lambda[i], base.mu[i]));
    group.soft_delta = kept;
    return worst;
  }
};

}  // namespace

Entry<Response> iterative_constraint_anticipation_response() {
  return entry<Response, IterativeConstraintAnticipation>("iterative_constraint_anticipation",
                                                          "relaxes A by its block diagonal; the seed's form and an accelerated one");
}

}  // namespace impinge
