// Full constraint anticipation, CA [Haapaoja16 §4.1.2]: v = v* + Δv, Δv = A⁻¹ J^T λ, λ from the cone problem with
// W = J A⁻¹ J^T and q = J v* - bound. Exact up to the LCP solver's tolerance. For rigid bodies A⁻¹ is six numbers a body,
// so W stays factored.
#include "engine/response/response.hpp"
#include "engine/response/rigid_delassus.hpp"

namespace impinge {
namespace {

class ConstraintAnticipation : public Response {
 public:
  ResponseResult solve(GroupSystem& group, const LcpSolver& solver, const LcpSettings& settings) const override {
    RigidDelassus w(group);
    ConeProblem problem{&w, {}, {}};
    for (std::size_t i = 0; i < group.contacts.size(); ++i) {
      Vec3 q = group.contact_velocity(i, false);
      q.x() -= group.contacts[i].bound;
      problem.q.push_back(q);
      problem.mu.push_back(group.contacts[i].friction);
    }
    const LcpResult result = solver.solve(problem, settings, group.lambda);
    w.begin(group.lambda);  // Δv afresh from λ: no rounding is carried over from the sweeps
    return {result.iterations, 0, result.reason != StopReason::iteration_cap};
  }
};

}  // namespace

Entry<Response> constraint_anticipation_response() {
  return entry<Response, ConstraintAnticipation>("constraint_anticipation", "exact: Δv = A⁻¹ J^T λ with λ from J A⁻¹ J^T");
}

}  // namespace impinge
