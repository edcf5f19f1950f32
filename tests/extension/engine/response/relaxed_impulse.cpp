// Simultaneous impulses that go only a part of their way in each sweep.
#include <fmt/format.h>

#include <algorithm>

#include "engine/response/operators/delassus_by_contact.hpp"
#include "engine/response/response.hpp"

namespace impinge {
namespace {

class RelaxedImpulse : public Response {
 public:
  void declare(const Rows& rows) override {
    rows.add("relaxation", settings_.relaxation, {0.05, 1.0}, "", "Part of the way that a sweep goes.");
    limit_ = rows.add("iterations", settings_.iterations, {1, 1000000, true}, "", "Sweeps at most for a group.").path();
  }
  bool uses_cone_solver() const override { return false; }
  IterationSetting iteration_setting() override { return {&settings_.iterations}; }
  std::string summary(const LcpSettings& lcp) const override {
    return fmt::format("relaxation {}, tolerance {}, at most {} sweeps", shortest(settings_.relaxation),
                       shortest(lcp.tolerance), settings_.iterations);
  }

  ResponseResult solve(GroupSystem& group, const LcpSolver&, const ResponseContext& context) const override {
    DelassusByContact w(group);
    const double goal = context.lcp.tolerance * velocity_scale(make_cone_problem(group));
    ResponseResult result;
    std::vector<Vec3> change(group.contacts.size());
    double largest = 2.0 * goal;
    while (largest > goal && result.iterations < settings_.iterations) {
      largest = 0.0;
      for (std::size_t i = 0; i < change.size(); ++i) {
        Vec3 u = w.velocity(i);
        u.x() -= group.contacts[i].bound;
        change[i] = relaxed_impulse(group.contacts[i], w.split_diagonal(i), u, group.lambda[i]) - group.lambda[i];
        largest = std::max(largest, (w.split_diagonal(i) * change[i]).norm());
      }
      for (std::size_t i = 0; i < change.size(); ++i)
        if (!change[i].isZero(0.0)) w.change(i, settings_.relaxation * change[i]);
      ++result.iterations;
    }
    if (largest > goal) result.ended = StopReason::iteration_cap, result.limit = limit_;
    if (!w.finish()) result.ended = StopReason::stagnated;
    return result;
  }

 private:
  struct Settings {
    double relaxation = 0.8;
    int iterations = 300;
  } settings_;
  std::string limit_;
};

}  // namespace

Entry<Response> relaxed_impulse_response() {
  return entry<Response, RelaxedImpulse>("relaxed_impulse", "simultaneous impulses, a part of the way a sweep");
}

}  // namespace impinge
