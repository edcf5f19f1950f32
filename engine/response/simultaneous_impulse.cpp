// Simultaneous impulses: all contacts answer at once to the velocities before the sweep (Jacobi). Taken as they are,
// the answers of a body's contacts add up to too much; each contact gets its share of the body's mass instead
// [Tonge12], which makes blockdiag(D) ⪰ W an upper bound: without friction the sweep never raises the energy. Slower
// than one after another, but no order of contacts is favoured and all answers are independent.
#include <fmt/format.h>

#include <algorithm>

#include "engine/core/interrupt.hpp"
#include "engine/response/operators/delassus_by_contact.hpp"
#include "engine/response/response.hpp"

namespace impinge {
namespace {

class SimultaneousImpulse : public Response {
 public:
  void declare(const Rows& rows) override {
    limit_ =
        rows.add("iterations", settings_.iterations, {1, 1000000, true}, "", "Sweeps at most for a group and sub-step.")
            .formerly("response.impulse_iterations")
            .path();
  }

  bool uses_cone_solver() const override { return false; }
  IterationSetting iteration_setting() override { return {&settings_.iterations}; }
  std::string summary(const LcpSettings& lcp) const override {
    return fmt::format("tolerance {}, at most {} sweeps", shortest(lcp.tolerance), settings_.iterations);
  }

  ResponseResult solve(GroupSystem& group, const LcpSolver&, const ResponseContext& context) const override {
    DelassusByContact w(group);
    const double tolerance = context.lcp.tolerance * velocity_scale(make_cone_problem(group));
    std::vector<double> bound;
    for (const ContactRows& rows : group.contacts) bound.push_back(rows.bound);
    ResponseResult result;
    bool converged = false;
    std::vector<Vec3> change(group.contacts.size());
    w.show(context.observe);
    while (!converged && result.iterations < settings_.iterations) {
      check_interrupt();
      double largest = 0.0;
      for (std::size_t i = 0; i < group.contacts.size(); ++i) {
        Vec3 u = w.velocity(i);
        u.x() -= group.contacts[i].bound;
        change[i] = relaxed_impulse(group.contacts[i], w.split_diagonal(i), u, group.lambda[i]) - group.lambda[i];
        largest = std::max(largest, (w.split_diagonal(i) * change[i]).norm());
      }
      for (std::size_t i = 0; i < group.contacts.size(); ++i)
        if (!change[i].isZero(0.0)) w.change(i, change[i]);
      ++result.iterations;
      w.show(context.observe);
      converged = largest <= tolerance && w.natural_residual(bound) <= tolerance;  // not a small change alone
    }
    if (!converged) result.ended = StopReason::iteration_cap, result.limit = limit_;
    if (!w.finish()) result.ended = StopReason::stagnated;
    return result;
  }

 private:
  struct Settings {
    int iterations = 200;
  } settings_;
  std::string limit_;
};

}  // namespace

Entry<Response> simultaneous_impulse_response() {
  return entry<Response, SimultaneousImpulse>("simultaneous_impulse",
                                              "all contacts at once, each with its share of the mass");
}

}  // namespace impinge
