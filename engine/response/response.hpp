// Collision response of one group: from the free velocity to one that the contacts allow. [Haapaoja16 §4.1]
#pragma once

#include "engine/contact/group_system.hpp"
#include "engine/lcp/lcp_solver.hpp"

namespace impinge {

struct ResponseResult {
  int iterations = 0;        ///< of the LCP solver
  int outer_iterations = 0;  ///< of an outer loop, where the method has one
  bool converged = true;
};

class Response {
 public:
  virtual ~Response() = default;
  /// Fills group.lambda and the Δv of its bodies such that the rows' bounds hold.
  virtual ResponseResult solve(GroupSystem& group, const LcpSolver& solver, const LcpSettings& settings) const = 0;
};

const Registry<Response>& responses();

}  // namespace impinge
