// Many contacts of rigid bodies together: what the default solver begins with where Newton's method is too dear.
#pragma once

#include "engine/lcp/lcp_solver.hpp"

namespace impinge {

/// Whether W is kept as the factors of rigid bodies, and friction is Coulomb's cone.
bool can_alternate_directions(const ConeProblem& problem);

/// Improves `lambda` as LcpSolver::solve does. Tumbling piles end at the iterations' limit, with the best λ that was met.
LcpResult alternate_directions(const ConeProblem& problem, const LcpSettings& settings, std::vector<Vec3>& lambda);

}  // namespace impinge
