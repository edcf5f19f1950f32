// Collision response of one group: from the free velocity to one that the contacts allow. [Haapaoja16 §4.1]
#pragma once

#include <functional>

#include "engine/contact/group_system.hpp"
#include "engine/lcp/lcp_solver.hpp"

namespace impinge {

struct ResponseSettings {
  LcpSettings lcp;
  // of responses with an outer loop
  std::string form = "accelerated";  ///< or "seed": the printed scheme
  std::string stop = "residual";     ///< or "change": the seed's 5 % rule
  int max_outer_iterations = 2000;
  // of responses that have a law of their own instead of complementarity, or a bounded number of sweeps
  double time_step = 1.0 / 240.0;         ///< Δt of the sub-step, s
  double max_push_out = 1.0;              ///< m/s
  double restitution_threshold = 0.01;    ///< m/s
  int impulse_iterations = 200;           ///< sweeps at most
  std::string penalty_form = "implicit";  ///< or "explicit"
  double penalty_stiffness = 0.0;         ///< k, N/m, of one contact; 0: by the mass that it feels and Δt
  double penalty_damping = 0.0;           ///< b, N·s/m; 0 beside an automatic stiffness: critical
  double penalty_slip_speed = 1e-3;       ///< ε_v, m/s: below it the regularised friction is not full
  double soft_frequency = 30.0;           ///< Hz
  double soft_damping_ratio = 10.0;
  int soft_iterations = 2;        ///< sweeps of a sub-step
  int soft_relax_iterations = 1;  ///< sweeps without recovery after them
  /// If given, a response with a loop of its own shows it the group, with λ and Δv as they stand, before the first and
  /// after each of its iterations.
  std::function<void(const GroupSystem&)> observe;
};

struct ResponseResult {
  int iterations = 0;        ///< of the LCP solver
  int outer_iterations = 0;  ///< of an outer loop, where the method has one
  StopReason ended = StopReason::converged;
  /// of StopReason::iteration_cap: the limit that was met, by the path of the parameter that sets it, or in words where
  /// none does
  std::string_view limit = {};
  bool converged() const { return ended == StopReason::converged || ended == StopReason::trivial; }
};

/// Of a response that leaves everything to one solve of the cone problem.
ResponseResult result_of(const LcpResult& solve, int outer_iterations = 0);

class Response {
 public:
  virtual ~Response() = default;
  /// Fills group.lambda and the Δv of its bodies, Δv = A⁻¹ J^T λ, such that the rows' bounds hold (or the method's own
  /// law).
  virtual ResponseResult solve(GroupSystem& group, const LcpSolver& solver, const ResponseSettings& settings) const = 0;
  /// Whether overlap is part of the method's own law (a spring's compression): nothing else may push it out then.
  virtual bool lives_on_overlap() const { return false; }
};

const Registry<Response>& responses();

/// q = J v* - bound and mu of the group's contacts; w is left to the caller.
ConeProblem make_cone_problem(const GroupSystem& group);

}  // namespace impinge
