// Iterative constraint anticipation, ICA [Haapaoja16 §4.1.4], [Otaduy09]: A⁻¹ of a deformable body is never asked for.
// An outer loop relaxes A Δv = J^T λ, an inner one solves contact on a J Q⁻¹ J^T that is sparse.
//
// form = "seed", as printed: inner c(i) = bound - J v* - J D⁻¹ (L + U) Δv(i-1), then one block Gauss-Seidel sweep
//   (D - L) Δv(i) = U Δv(i-1) + J^T λ(i).
// form = "accelerated": accelerated_anticipation.cpp.
// stop = "residual": natural map of (J v - bound, λ) and D⁻¹ (A Δv - J^T λ) by node, both in m/s against max |J v* -
// bound|: true
//   residuals.
// stop = "change": the seed's rule, a change of ‖A Δv - J^T λ‖ by less than 5 % between iterations; it stops far away.
//
// Rigid bodies, and deformable ones whose A is block diagonal, enter with Q = A: if there are no others one step is
// exact.
#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "engine/core/interrupt.hpp"
#include "engine/lcp/residual.hpp"
#include "engine/response/accelerated_anticipation.hpp"
#include "engine/response/operators/factored_delassus.hpp"

namespace impinge {
namespace {

/// One block Gauss-Seidel sweep on A x = b.
void gauss_seidel_sweep(const BlockMatrix& a, const std::vector<Mat3>& inverse, const VecX& b, VecX& x) {
  const BlockPattern& p = *a.pattern;
  for (int i = 0; i < p.rows; ++i) {
    Vec3 r = b.segment<3>(3 * i);
    for (int k = p.begin[i]; k < p.begin[i + 1]; ++k)
      if (k != p.diagonal[i]) r -= a.values[k] * x.segment<3>(3 * p.column[k]);
    x.segment<3>(3 * i) = inverse[i] * r;
  }
}

/// J of contact i times velocities of the deformable bodies.
Vec3 soft_velocity(const GroupSystem& group, const std::vector<VecX>& v, std::size_t i) {
  Vec3 relative = Vec3::Zero();
  for (const auto& [side, sign] : {std::pair(&group.contacts[i].a, 1.0), std::pair(&group.contacts[i].b, -1.0)})
    for (const NodeWeight& n : side->nodes) relative += sign * n.weight * v[side->deformable].segment<3>(3 * n.node);
  return group.contacts[i].directions * relative;
}

ResponseResult solve_seed(GroupSystem& group, const ConeProblem& base, const std::vector<std::vector<Mat3>>& inverse,
                          const LcpSolver& solver, const AnticipationSettings& settings,
                          const ResponseContext& context) {
  FactoredDelassus w(group, &inverse);
  ConeProblem problem = base;
  problem.w = &w;
  const double scale = velocity_scale(base);
  const double tolerance = context.lcp.tolerance * scale;

  std::vector<VecX> x, a_x, drift;  // Δv, A Δv and D⁻¹ (L + U) Δv
  for (const DeformableBlock& block : group.deformable) x.push_back(VecX::Zero(block.velocity.size()));
  a_x = drift = x;
  ResponseResult result;
  bool converged = false;
  double before = -1.0;
  const auto show = [&] {
    if (!context.observe) return;
    w.begin(group.lambda);
    group.deformable_delta = x;
    context.observe(group);
  };
  show();
  while (!converged && result.outer_iterations < settings.max_iterations) {
    check_interrupt();
    for (std::size_t s = 0; s < x.size(); ++s)
      for (std::size_t i = 0; i < inverse[s].size(); ++i) {
        const auto at = static_cast<Eigen::Index>(3 * i);
        drift[s].segment<3>(at) = x[s].segment<3>(at) - inverse[s][i] * a_x[s].segment<3>(at);
      }
    for (std::size_t i = 0; i < base.q.size(); ++i) problem.q[i] = base.q[i] + soft_velocity(group, drift, i);
    result.iterations += solver.solve(problem, context.lcp, group.lambda).iterations;
    ++result.outer_iterations;

    double norm = 0.0, momentum = 0.0;
    for (std::size_t s = 0; s < x.size(); ++s) {
      const VecX impulse = group.deformable_impulse(static_cast<int>(s), group.lambda);
      gauss_seidel_sweep(*group.deformable[s].a, inverse[s], impulse, x[s]);
      multiply(*group.deformable[s].a, x[s], a_x[s]);
      const VecX r = a_x[s] - impulse;
      norm += r.squaredNorm();
      for (std::size_t i = 0; i < inverse[s].size(); ++i)
        momentum = std::max(momentum, (inverse[s][i] * r.segment<3>(static_cast<Eigen::Index>(3 * i))).norm());
    }
    show();
    norm = std::sqrt(norm);
    if (settings.stop == AnticipationSettings::Stop::change) {
      converged = norm == 0.0 || (before >= 0.0 && std::abs(norm - before) < kSeedChange * before);
      before = norm;
    } else if (momentum <= tolerance) {
      w.begin(group.lambda);  // rigid Δv; the deformable bodies' is x
      group.deformable_delta = x;
      double worst = 0.0;
      for (std::size_t i = 0; i < base.q.size(); ++i)
        worst = std::max(
            worst, natural_map(base.kind[i], w.diagonal(i), w.row(i, false) + base.q[i], group.lambda[i], base.mu[i]));
      converged = worst <= tolerance;
    }
  }
  w.begin(group.lambda);
  group.deformable_delta = x;
  if (!converged) result.ended = StopReason::iteration_cap, result.limit = settings.limit;
  return result;
}

class IterativeConstraintAnticipation : public Response {
  using Settings = AnticipationSettings;

 public:
  void declare(const Rows& rows) override {
    rows.add("form", settings_.form, {{Settings::Form::accelerated, "accelerated"}, {Settings::Form::seed, "seed"}},
             "The convergent form, or the one that the seed prints.")
        .formerly("response.form");
    rows.add("stop", settings_.stop, {{Settings::Stop::residual, "residual"}, {Settings::Stop::change, "change"}},
             "Stop rule: a true residual (lcp.tolerance), or the seed's change of less than 5 %.")
        .formerly("response.stop");
    rows.add(
        "factorizes", settings_.factorizes,
        "Leaves a group to constraint anticipation where that is quicker (stiff or small bodies), not only where the "
        "iteration stalls. Of the accelerated form with stop = residual.");
    settings_.limit = rows.add("max_iterations", settings_.max_iterations, {1, 1000000, true}, "",
                               "Outer iterations at most for a group and sub-step.")
                          .formerly("response.max_iterations")
                          .path();
  }

  bool uses_cone_solver() const override { return true; }
  IterationSetting iteration_setting() override { return {&settings_.max_iterations}; }
  std::string summary(const LcpSettings& lcp) const override {
    return fmt::format("{}{}, tolerance {}, at most {} outer iterations",
                       settings_.form == Settings::Form::seed ? "the seed's form" : "accelerated",
                       settings_.stop == Settings::Stop::change ? ", 5 % rule" : "", shortest(lcp.tolerance),
                       settings_.max_iterations);
  }
  /// The forms that this method is known in, where its loop has something to do: how far the printed one and its 5 %
  /// rule are from the solution.
  std::vector<ResponseVariant> variants(bool is_block_diagonal) const override {
    if (is_block_diagonal) return {{"", {}}};
    return {{"", {{"form", "accelerated"}, {"stop", "residual"}, {"factorizes", "false"}}},
            {"_5_percent", {{"form", "accelerated"}, {"stop", "change"}}},
            {"_seed", {{"form", "seed"}, {"stop", "residual"}}, true},
            {"_seed_5_percent", {{"form", "seed"}, {"stop", "change"}}, true}};
  }

  ResponseResult solve(GroupSystem& group, const LcpSolver& solver, const ResponseContext& context) const override {
    group.clear_delta();
    ConeProblem problem = make_cone_problem(group);
    const bool one_step = std::all_of(group.deformable.begin(), group.deformable.end(),
                                      [](const DeformableBlock& b) { return b.is_diagonal; });
    if (!one_step && (settings_.form != Settings::Form::seed || context.recovers_overlap))
      return solve_accelerated(group, problem, solver, settings_, context);
    const std::vector<std::vector<Mat3>> inverse = inverse_node_blocks(group);
    if (!one_step) return solve_seed(group, problem, inverse, solver, settings_, context);
    FactoredDelassus w(group, &inverse);
    problem.w = &w;
    const LcpResult result = solver.solve(problem, context.lcp, group.lambda);
    w.begin(group.lambda);
    return result_of(result, 1);
  }

 private:
  Settings settings_;
};

}  // namespace

Entry<Response> iterative_constraint_anticipation_response() {
  return entry<Response, IterativeConstraintAnticipation>(
      "iterative_constraint_anticipation", "relaxes A by its block diagonal; the seed's form and an accelerated one");
}

}  // namespace impinge
