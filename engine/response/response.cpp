#include "engine/response/response.hpp"

#include <fmt/format.h>

namespace impinge {

std::string Response::summary(const LcpSettings& lcp) const {
  if (!uses_cone_solver()) return "";
  return fmt::format("tolerance {}, at most {} iterations", shortest(lcp.tolerance), lcp.max_iterations);
}

std::vector<ResponseVariant> Response::variants(bool) const { return {{"", {}}}; }

ResponseResult result_of(const LcpResult& solve, int outer_iterations) {
  const bool at_limit = solve.reason == StopReason::iteration_cap;
  return {solve.iterations, outer_iterations, solve.reason, at_limit ? "lcp.max_iterations" : std::string_view()};
}

ConeProblem make_cone_problem(const GroupSystem& group) {
  ConeProblem problem;
  for (std::size_t i = 0; i < group.contacts.size(); ++i) {
    Vec3 q = group.contact_velocity(i, false);
    q.x() -= group.contacts[i].bound;
    problem.q.push_back(q);
    problem.mu.push_back(group.contacts[i].friction);
    problem.kind.push_back(group.contacts[i].kind);
  }
  return problem;
}

}  // namespace impinge
