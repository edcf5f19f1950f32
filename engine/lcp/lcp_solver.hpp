// A solver of the cone complementarity problem. No solver scores itself: residual.hpp is the judge.
#pragma once

#include "engine/core/registry.hpp"
#include "engine/lcp/cone_problem.hpp"

namespace impinge {

enum class StopReason { converged, iteration_cap, trivial };

struct LcpSettings {
  double tolerance = 1e-8;    ///< natural-map residual relative to max |q| (m/s)
  int max_iterations = 1000;
};

struct LcpResult {
  int iterations = 0;
  StopReason reason = StopReason::trivial;
};

class LcpSolver {
 public:
  virtual ~LcpSolver() = default;
  /// Improves `lambda` (in: start, out: answer, N·s; entry i lies in its cone).
  virtual LcpResult solve(const ConeProblem& problem, const LcpSettings& settings, std::vector<Vec3>& lambda) const = 0;
};

const Registry<LcpSolver>& lcp_solvers();

}  // namespace impinge
