// Iterative constraint anticipation that converges whatever the stiffness: see accelerated_anticipation.cpp.
#pragma once

#include "engine/response/response.hpp"

namespace impinge {

struct AnticipationSettings {
  enum class Form { accelerated, seed } form = Form::accelerated;
  enum class Stop { residual, change } stop = Stop::residual;
  bool factorizes = true;     ///< leaves to constraint anticipation what that does quicker
  int max_iterations = 2000;  ///< of the outer loop
  std::string limit;          ///< the path of max_iterations
};

/// Fills group.lambda and the Δv; group.lambda holds the start. For groups with deformable bodies. `solver`: of the few
/// rows that are left where the sweeps stall.
ResponseResult solve_accelerated(GroupSystem& group, const ConeProblem& base, const LcpSolver& solver,
                                 const AnticipationSettings& settings, const ResponseContext& context);

/// The parameter that bounds the outer iterations of either form.
constexpr std::string_view kOuterLimit = "response.max_iterations";

/// The seed's outer stop rule: ‖A Δv - J^T λ‖ changes by less than this between iterations.
constexpr double kSeedChange = 0.05;

}  // namespace impinge
