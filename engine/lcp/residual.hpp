// The judge: how far a λ is from solving the problem, computed apart from every solver. Solvers stop by the same
// formulas.
#pragma once

#include "engine/lcp/cone_problem.hpp"

namespace impinge {

/// One measured quantity: the largest over the contacts, and where. Relative: divided by what such a quantity is in the
/// problem, so that it doesn't depend on units; 0 where that is 0.
struct Measured {
  double absolute = 0.0, relative = 0.0;
  int worst = -1;  ///< contact; -1 where all are 0
};

struct Residual {
  double natural_map = 0.0;      ///< max_i |λ_i - P_K(λ_i - ρ_i û_i)| / ρ_i with ρ_i = 3 / trace W_ii, m/s
  double complementarity = 0.0;  ///< max_i |λ_i·û_i|, J
  double cone_violation = 0.0;   ///< max_i max(0, |λ_t| - mu λ_n), N·s
  int worst = -1;                ///< contact of the largest natural-map residual

  Measured map;      ///< natural_map; relative to max |q|
  Measured product;  ///< complementarity; relative to max |q| max |λ|
  Measured cone;     ///< cone_violation; relative to max |λ|
  /// As published with the friction-contact library FCLib and Siconos: √Σ|λ_i - P_K(λ_i - û_i)|² with ρ = 1, which
  /// mixes units, over max(‖q‖, ‖λ‖, ‖u‖). [AcaryBremondHuber18]
  double siconos = 0.0;
};

/// Which relative residual a tolerance is meant for.
enum class Measure { natural_map, siconos };

/// Residual of (problem, lambda). Calls problem.w->begin(lambda).
Residual judge(const ConeProblem& problem, const std::vector<Vec3>& lambda);

/// The natural-map residual of contact i for its u, m/s; of an equation what is left of u. 0 where W_ii = 0: both
/// bodies are held, nothing can respond.
double natural_map(const ConeProblem& problem, std::size_t i, const Vec3& u, const Vec3& lambda);

/// The same, of one contact by itself.
double natural_map(const Mat3& w_ii, const Vec3& u, const Vec3& lambda, double mu, FrictionLaw law = FrictionLaw::cone);
double natural_map(RowKind kind, const Mat3& w_ii, const Vec3& u, const Vec3& lambda, double mu);

/// What natural maps are relative to: max |q|, of the rows that there are.
double velocity_scale(const ConeProblem& problem);

/// The relative residual by `measure`, for u = W λ + q. NaN where something isn't finite.
double relative_residual(const ConeProblem& problem, const std::vector<Vec3>& u, const std::vector<Vec3>& lambda,
                         Measure measure);

}  // namespace impinge
