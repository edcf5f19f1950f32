// Collision response of one group: from the free velocity to one that the contacts allow. [Haapaoja16 §4.1]
#pragma once

#include <functional>

#include "engine/contact/contact_settings.hpp"
#include "engine/contact/group_system.hpp"
#include "engine/core/method.hpp"
#include "engine/lcp/lcp_solver.hpp"

namespace impinge {

/// What a response is told of the sub-step, beside the settings of its own.
struct ResponseContext {
  LcpSettings lcp;                 ///< of cone problems; the tolerance holds for whatever else a method iterates
  double time_step = 1.0 / 240.0;  ///< Δt, s
  /// The part of a whole sub-step that Δt is, where one is made in pieces. What contacts start from was a whole one's, as a
  /// rule, and a method of few sweeps can't take back what is too much.
  double share = 1.0;
  /// Parts of the speed of a contact's scale, m/s, or numbers: of recovery from overlap, and slower impacts do not
  /// bounce.
  Threshold max_push_out = ContactSettings().max_push_out;
  Threshold restitution_threshold = ContactSettings().restitution_threshold;
  /// Of which the free velocities of rigid bodies hold Δt, m/s²: what a method with shorter steps gives bit by bit.
  Vec3 gravity = Vec3::Zero();
  /// The rows ask for positions that no longer overlap, not for velocities: to be solved to its residual, in whatever
  /// way of the method's does that.
  bool recovers_overlap = false;
  /// If given, a response with a loop of its own shows it the group, with λ and Δv as they stand, before the first and
  /// after each of its iterations.
  std::function<void(const GroupSystem&)> observe = {};
};

struct ResponseResult {
  int iterations = 0;        ///< of the LCP solver
  int outer_iterations = 0;  ///< of an outer loop, where the method has one
  StopReason ended = StopReason::converged;
  /// Of StopReason::iteration_cap: the limit that was met, by the path of the parameter that sets it, or in words where
  /// none does. It lives as long as the method.
  std::string_view limit = {};
  bool converged() const { return ended == StopReason::converged || ended == StopReason::trivial; }
};

/// Of a response that leaves everything to one solve of the cone problem.
ResponseResult result_of(const LcpResult& solve, int outer_iterations = 0);

/// A method's own setting of how many iterations it makes.
struct IterationSetting {
  int* count = nullptr;   ///< null: it has none; what it leaves to a cone solver ends at lcp.max_iterations
  bool is_exact = false;  ///< it makes so many in any case: they are part of the answer, not a limit
};

/// A way of running a response that comparisons show by itself.
struct ResponseVariant {
  std::string suffix;             ///< of its name there
  std::vector<RowText> rows;      ///< own rows that make it
  bool solves_in_a_loop = false;  ///< asks the cone solver in each of many iterations: dear to run with every solver
};

class Response : public Method {
 public:
  /// Fills group.lambda and the Δv of its bodies, Δv = A⁻¹ J^T λ, such that the rows' bounds hold (or the method's own
  /// law).
  virtual ResponseResult solve(GroupSystem& group, const LcpSolver& solver, const ResponseContext& context) const = 0;

  /// Whether the solver that solve() is given is asked for anything.
  virtual bool uses_cone_solver() const = 0;
  /// Whether the answer is that of Coulomb's law and complementarity to the cone solver's residual, with nothing of its
  /// own to stop by: what references are made with.
  virtual bool is_reference() const { return false; }
  /// Whether overlap is part of the method's own law (a spring's compression): nothing else may push it out then.
  virtual bool lives_on_overlap() const { return false; }
  /// Whether what it makes of an impact depends on the restitution of the two.
  virtual bool uses_restitution() const { return true; }
  /// Whether it ends after work that is fixed beforehand, wherever that leads, and follows the bodies' turns by itself:
  /// nothing of its answer is worth a solve more.
  virtual bool is_approximate() const { return lives_on_overlap(); }
  virtual IterationSetting iteration_setting() { return {}; }
  /// What it is set to, in words that follow its name: "tolerance 1e-08, at most 200 sweeps".
  virtual std::string summary(const LcpSettings& lcp) const;
  /// The ways that differ where A is not block diagonal in every deformable body of the problem, or where it is.
  virtual std::vector<ResponseVariant> variants(bool is_block_diagonal) const;
};

const Registry<Response>& responses();

/// q = J v* - bound and mu of the group's contacts; w is left to the caller.
ConeProblem make_cone_problem(const GroupSystem& group);

}  // namespace impinge
