// Simultaneous impulses: all contacts answer at once to the velocities before the sweep (Jacobi). Taken as they are,
// the answers of a body's contacts add up to too much; each contact gets its share of the body's mass instead
// [Tonge12], which makes blockdiag(D) ⪰ W an upper bound: without friction the sweep never raises the energy. Slower
// than one after another, but no order of contacts is favoured and all answers are independent.
#include <algorithm>

#include "engine/core/interrupt.hpp"
#include "engine/response/operators/contact_mobility.hpp"
#include "engine/response/response.hpp"

namespace impinge {
namespace {

class SimultaneousImpulse : public Response {
 public:
  ResponseResult solve(GroupSystem& group, const LcpSolver&, const ResponseSettings& settings) const override {
    ContactMobility mobility(group);
    const double scale = velocity_scale(make_cone_problem(group));
    ResponseResult result;
    bool converged = false;
    std::vector<Vec3> change(group.contacts.size());
    mobility.show(settings.observe);
    while (!converged && result.iterations < settings.impulse_iterations) {
      check_interrupt();
      double largest = 0.0;
      for (std::size_t i = 0; i < group.contacts.size(); ++i) {
        Vec3 u = mobility.velocity(i);
        u.x() -= group.contacts[i].bound;
        change[i] =
            relaxed_impulse(group.contacts[i], mobility.split_diagonal(i), u, group.lambda[i]) - group.lambda[i];
        largest = std::max(largest, (mobility.split_diagonal(i) * change[i]).norm());
      }
      for (std::size_t i = 0; i < group.contacts.size(); ++i)
        if (!change[i].isZero(0.0)) mobility.change(i, change[i]);
      ++result.iterations;
      mobility.show(settings.observe);
      converged = largest <= settings.lcp.tolerance * scale;
    }
    if (!converged) result.ended = StopReason::iteration_cap, result.limit = "response.impulse_iterations";
    if (!mobility.finish()) result.ended = StopReason::stagnated;
    return result;
  }
};

}  // namespace

Entry<Response> simultaneous_impulse_response() {
  return entry<Response, SimultaneousImpulse>("simultaneous_impulse",
                                              "all contacts at once, each with its share of the mass");
}

}  // namespace impinge
