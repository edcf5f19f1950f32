// The judge: how far a λ is from solving the problem, computed apart from every solver.
#pragma once

#include "engine/lcp/cone_problem.hpp"

namespace impinge {

struct Residual {
  double natural_map = 0.0;      ///< max_i |λ_i - P_K(λ_i - ρ_i û_i)| / ρ_i with ρ_i = 3 / trace W_ii, m/s
  double complementarity = 0.0;  ///< max_i |λ_i·û_i|, J
  double cone_violation = 0.0;   ///< max_i max(0, |λ_t| - mu λ_n), N·s
  int worst = -1;                ///< contact of the largest natural-map residual
};

/// Residual of (problem, lambda). Calls problem.w->begin(lambda).
Residual judge(const ConeProblem& problem, const std::vector<Vec3>& lambda);

/// The natural-map residual of one contact, m/s.
double natural_map(const Mat3& w_ii, const Vec3& u, const Vec3& lambda, double mu);

/// The same for rows of any kind: of an equation it is what is left of u, m/s.
double natural_map(RowKind kind, const Mat3& w_ii, const Vec3& u, const Vec3& lambda, double mu);

}  // namespace impinge
