// A solver of the cone complementarity problem. No solver scores itself: residual.hpp is the judge.
#pragma once

#include "engine/core/method.hpp"
#include "engine/core/registry.hpp"
#include "engine/lcp/residual.hpp"

namespace impinge {

enum class StopReason {
  converged,      ///< the judge's residual is within the tolerance
  stagnated,      ///< the method can get no nearer: no step lowers the residual, or rounding hides it
  iteration_cap,  ///< max_iterations were made
  trivial,        ///< there was nothing to solve
  refused,        ///< the problem is not of the method's kind (applies() says why); λ is as it came
  contradiction  ///< no λ answers it: rows say the opposite of each other; λ is forces of which nothing moves that would
};

std::string_view name_of(StopReason reason);

struct LcpSettings {
  double tolerance = 1e-8;  ///< of the relative residual that `measure` names
  int max_iterations = 1000;
  Measure measure = Measure::natural_map;
  /// The bodies are on their way: digits that are dear change nothing that can be seen, as they do in what comes to rest.
  bool is_in_motion = false;
  /// if given, gets the relative residual before the first and after each iteration
  std::vector<double>* history = nullptr;
};

struct LcpResult {
  int iterations = 0;
  StopReason reason = StopReason::trivial;
  bool solved() const { return reason == StopReason::converged || reason == StopReason::trivial; }
};

class LcpSolver : public Method {
 public:
  /// Improves `lambda` (in: start, out: answer, N·s; entry i lies in its cone).
  virtual LcpResult solve(const ConeProblem& problem, const LcpSettings& settings, std::vector<Vec3>& lambda) const = 0;
  /// Why the method can't solve this problem; "" if it can. What it can't solve it refuses.
  virtual std::string applies(const ConeProblem&) const { return ""; }
  /// Whether it only chooses among other methods, by what the problem is like.
  virtual bool chooses_by_problem() const { return false; }
  /// Where answers to rounding are wanted, such methods are tried in this order; 0: no such method.
  virtual int reference_rank() const { return 0; }
};

const Registry<LcpSolver>& lcp_solvers();

/// Those for answers to rounding, the best first.
std::vector<const Entry<LcpSolver>*> reference_solvers();

}  // namespace impinge
