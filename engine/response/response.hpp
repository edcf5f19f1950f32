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
  /// If given, a response with a loop of its own shows it the group, with λ and Δv as they stand, before the first and after
  /// each of its iterations.
  std::function<void(const GroupSystem&)> observe;
};

struct ResponseResult {
  int iterations = 0;        ///< of the LCP solver
  int outer_iterations = 0;  ///< of an outer loop, where the method has one
  bool converged = true;
};

class Response {
 public:
  virtual ~Response() = default;
  /// Fills group.lambda and the Δv of its bodies such that the rows' bounds hold.
  virtual ResponseResult solve(GroupSystem& group, const LcpSolver& solver, const ResponseSettings& settings) const = 0;
};

const Registry<Response>& responses();

/// q = J v* - bound and mu of the group's contacts; w is left to the caller.
ConeProblem make_cone_problem(const GroupSystem& group);

}  // namespace impinge
