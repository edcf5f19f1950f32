// Iterative constraint anticipation that converges whatever the stiffness: see accelerated_anticipation.cpp.
#pragma once

#include "engine/response/response.hpp"

namespace impinge {

/// Fills group.lambda and the Δv; group.lambda holds the start. For groups with deformable bodies. `solver`: of the few
/// rows that are left where the sweeps stall.
ResponseResult solve_accelerated(GroupSystem& group, const ConeProblem& base, const LcpSolver& solver,
                                 const ResponseSettings& settings);

/// The parameter that bounds the outer iterations of either form.
constexpr std::string_view kOuterLimit = "response.max_iterations";

/// The seed's outer stop rule: ‖A Δv - J^T λ‖ changes by less than this between iterations.
constexpr double kSeedChange = 0.05;

}  // namespace impinge
