// Full constraint anticipation, CA [Haapaoja16 §4.1.2]: v = v* + Δv, Δv = A⁻¹ J^T λ, λ from the cone problem with
// W = J A⁻¹ J^T and q = J v* - bound. Exact up to the LCP solver's tolerance. For rigid bodies A⁻¹ is six numbers a
// body, so W stays factored, and so it is where explicit schemes leave one block a node; any other deformable body's A
// is factorized once for all its contacts and W is dense.
#include <algorithm>

#include "engine/response/operators/assembled_delassus.hpp"
#include "engine/response/operators/delassus_of.hpp"
#include "engine/response/operators/factored_delassus.hpp"
#include "engine/response/response.hpp"

namespace impinge {
namespace {

class ConstraintAnticipation : public Response {
 public:
  bool uses_cone_solver() const override { return true; }
  bool is_reference() const override { return true; }

  ResponseResult solve(GroupSystem& group, const LcpSolver& solver, const ResponseContext& context) const override {
    group.clear_delta();
    ConeProblem problem = make_cone_problem(group);
    // explicit schemes: A of a deformable body is one block a node, and W has factors as for rigid bodies
    if (std::all_of(group.deformable.begin(), group.deformable.end(),
                    [](const DeformableBlock& b) { return b.is_diagonal; })) {
      const std::vector<std::vector<Mat3>> inverse = inverse_node_blocks(group);
      FactoredDelassus w(group, &inverse);
      problem.w = &w;
      const LcpResult result = solver.solve(problem, context.lcp, group.lambda);
      w.begin(group.lambda);  // Δv afresh from λ: no rounding is carried over from the sweeps
      return result_of(result);
    }
    const std::unique_ptr<Delassus> w = delassus_of(group);
    problem.w = w.get();
    const LcpResult result = solver.solve(problem, context.lcp, group.lambda);
    apply_impulses(group);
    return result_of(result);
  }
};

}  // namespace

Entry<Response> constraint_anticipation_response() {
  return entry<Response, ConstraintAnticipation>("constraint_anticipation",
                                                 "exact: Δv = A⁻¹ J^T λ with λ from J A⁻¹ J^T");
}

}  // namespace impinge
