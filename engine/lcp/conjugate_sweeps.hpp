// A Gauss-Seidel sweep taken for a descent step (minus the gradient), made conjugate to the one before by Fletcher and
// Reeves' rule [SilcowitzHansen10]: a sweep at a time, for whoever decides after each whether to go on.
#pragma once

#include <limits>

#include "engine/lcp/cone_problem.hpp"

namespace impinge {

class ConjugateSweeps {
 public:
  explicit ConjugateSweeps(const ConeProblem& problem);

  /// From the operator's present λ, which is `lambda`; changes both. The momentum of the sweeps before is added first and
  /// may carry λ out of its cones; the sweep that follows brings it back, so λ is one that a sweep left. Returns what
  /// gauss_seidel_sweep does, m/s.
  double sweep(std::vector<Vec3>& lambda);

 private:
  const ConeProblem& problem_;
  std::vector<Vec3> step_, direction_;
  double size_before_ = std::numeric_limits<double>::infinity();  // so that the first step is taken as it is
};

}  // namespace impinge
