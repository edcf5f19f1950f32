// Many contacts of rigid bodies together: a heap's forces to a few digits, for a tenth of what Newton's steps cost there.
#pragma once

#include "engine/lcp/lcp_solver.hpp"

namespace impinge {

/// Improves `lambda` as LcpSolver::solve does, for as long as that promises much, from a λ that is near. It needs the
/// factors of rigid bodies (Delassus::body_space). The best λ that was met is returned.
LcpResult alternate_directions(const ConeProblem& problem, const LcpSettings& settings, std::vector<Vec3>& lambda);

}  // namespace impinge
