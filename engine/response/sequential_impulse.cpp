// Sequential impulses [Catto05]: one contact after another, on accumulated impulses that are clamped, in a number of
// sweeps that is bounded beforehand. Friction is Coulomb's cone by projection of the accumulated tangential impulse.
//
// Impacts come first, each as a collision of its own pair: a contact that bodies approach through gets the impulse that
// returns -e times its approach, and so on until none approaches; a shot runs through Newton's cradle that way. What
// contacts are pressed together with by forces is left to the sweeps, which bounce nothing.
#include <fmt/format.h>

#include <algorithm>

#include "engine/core/interrupt.hpp"
#include "engine/response/operators/delassus_by_contact.hpp"
#include "engine/response/passive_impulses.hpp"
#include "engine/response/response.hpp"

namespace impinge {
namespace {

class SequentialImpulse : public Response {
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
    const std::size_t m = group.contacts.size();
    const bool impacts =
        std::any_of(group.contacts.begin(), group.contacts.end(), [](const ContactRows& c) { return is_impact(c); });
    if (impacts) group.lambda.assign(m, Vec3::Zero());  // the impulses of a resting state say nothing about an impact
    DelassusByContact w(group);
    const double tolerance = context.lcp.tolerance * velocity_scale(make_cone_problem(group));

    ResponseResult result;
    bool converged = false;
    std::vector<double> impact(m, 0.0), bound(m);
    for (std::size_t i = 0; i < m; ++i) bound[i] = group.contacts[i].bound;
    if (impacts) collide(group, w, context, result, impact, bound);
    w.show(context.observe);
    while (!converged && result.iterations < settings_.iterations) {
      check_interrupt();
      double largest = 0.0;
      for (std::size_t i = 0; i < m; ++i) {
        Vec3 u = w.velocity(i);
        u.x() -= bound[i];
        Vec3 start = group.lambda[i];
        start.x() -= impact[i];  // what an impact gave is not taken back
        Vec3 next = relaxed_normal_first(group.contacts[i], w.diagonal(i), u, start, impact[i]);
        const Vec3 change = next - group.lambda[i];
        if (change.isZero(0.0)) continue;
        w.change(i, change);
        largest = std::max(largest, (w.diagonal(i) * change).norm());
      }
      ++result.iterations;
      w.show(context.observe);
      // a small change is not a small residual, where contacts press on each other through what bends; what an impact gave
      // is no answer to the bound
      converged = largest <= tolerance && w.natural_residual(bound, impact) <= tolerance;
    }
    if (!converged) result.ended = StopReason::iteration_cap, result.limit = limit_;
    if (!w.finish()) result.ended = StopReason::stagnated;
    return result;
  }

 private:
  static bool is_impact(const ContactRows& c) {
    return c.kind == RowKind::contact && c.restitution > 0.0 && c.bound > 0.0;
  }

  /// The bound without a bounce: a gap may close, an overlap may not grow.
  static double closed_bound(const ContactRows& c, double h) { return c.gap >= 0.0 ? -c.gap / h : 0.0; }

  /// relaxed_impulse with a floor of `impact` under the normal impulse; `lambda` holds what is above it.
  static Vec3 relaxed_normal_first(const ContactRows& rows, const Mat3& w, Vec3 u, Vec3 lambda, double impact) {
    if (impact == 0.0) return relaxed_impulse(rows, w, u, lambda);
    const double before = lambda.x();
    lambda.x() = std::max(0.0, before - u.x() / w(0, 0));
    u += w.col(0) * (lambda.x() - before);
    lambda.x() += impact;
    if (!rows.has_one_row()) relax_friction(w, u, rows.friction, lambda);
    return lambda;
  }

  void collide(GroupSystem& group, DelassusByContact& w, const ResponseContext& context, ResponseResult& result,
               std::vector<double>& impact, std::vector<double>& bound) const {
    const std::size_t m = group.contacts.size();
    std::vector<double> approach(m);  // what J v* holds beside the velocity before the sub-step: forces
    double fastest = 0.0;
    for (std::size_t i = 0; i < m; ++i) {
      approach[i] = group.contacts[i].velocity_before - group.contact_velocity(i, false).x();
      fastest = std::max(fastest, -group.contacts[i].velocity_before);
    }
    const double slow = 1e-9 * fastest;  // what is left of rounding
    const auto closes = [&](std::size_t i) {
      const ContactRows& rows = group.contacts[i];
      if (rows.kind != RowKind::contact || rows.restitution == 0.0 || !(w.diagonal(i)(0, 0) > 0.0)) return false;
      const double normal = w.velocity(i).x();
      const double least = std::max(slow, context.restitution_threshold.at(rows.scale.speed));
      return normal + approach[i] < -least && rows.gap + context.time_step * normal < 0.0;
    };
    for (bool more = true; more && result.iterations < settings_.iterations; ++result.iterations) {
      check_interrupt();
      more = false;
      for (std::size_t first = 0, last = 0; first < m; first = last) {
        std::vector<std::size_t> closing;
        for (; last < m && are_of_one_pair(group.contacts[first], group.contacts[last]); ++last)
          if (closes(last)) closing.push_back(last);
        if (closing.empty()) continue;
        strike(group, w, closing, approach, slow);
        for (const std::size_t i : closing) {
          impact[i] = group.lambda[i].x();
          // the bounce is done: from here on the contact may only not close
          bound[i] = std::min(bound[i], closed_bound(group.contacts[i], context.time_step));
        }
        more = true;
      }
    }
    // a bound that asks for a bounce which no longer takes place, since another impact turned the bodies away
    for (std::size_t i = 0; i < m; ++i)
      if (is_impact(group.contacts[i]) && impact[i] == 0.0)
        bound[i] = std::min(bound[i], closed_bound(group.contacts[i], context.time_step));
  }

  static bool are_of_one_pair(const ContactRows& l, const ContactRows& r) {
    return l.a.rigid == r.a.rigid && l.b.rigid == r.b.rigid && l.a.deformable == r.a.deformable &&
           l.b.deformable == r.b.deformable;
  }

  /// The contacts of a pair that close get together what returns -e of each one's approach: one after the other those of a
  /// face would turn it away from what the last ones had to return. With friction that may win energy: less of all of it
  /// then.
  static void strike(GroupSystem& group, DelassusByContact& w, const std::vector<std::size_t>& closing,
                     const std::vector<double>& approach, double slow) {
    const auto velocity = [&](std::size_t i) { return Vec3(w.velocity(i) + approach[i] * Vec3::UnitX()); };
    std::vector<double> wanted, given(closing.size(), 0.0);  // m/s; N·s
    std::vector<Vec3> before, start;
    for (const std::size_t i : closing) {
      before.push_back(velocity(i)), start.push_back(group.lambda[i]);
      wanted.push_back(-group.contacts[i].restitution * before.back().x());
    }
    for (int sweep = 0; sweep < kMostStrikes; ++sweep) {
      double largest = 0.0;
      for (std::size_t k = 0; k < closing.size(); ++k) {
        const std::size_t i = closing[k];
        const Vec3 u = w.velocity(i);
        const double missing = wanted[k] - (u.x() + approach[i]);
        const double more = std::max(-given[k], missing / w.diagonal(i)(0, 0));
        given[k] += more;
        Vec3 next = group.lambda[i];
        next.x() += more;
        if (group.contacts[i].friction > 0.0)
          relax_friction(w.diagonal(i), u + w.diagonal(i).col(0) * more, group.contacts[i].friction, next);
        const Vec3 change = next - group.lambda[i];
        if (change.isZero(0.0)) continue;
        w.change(i, change);
        largest = std::max(largest, (w.diagonal(i) * change).norm());
      }
      if (largest <= slow || closing.size() == 1) break;
    }
    double came = 0.0, left = 0.0;
    for (std::size_t k = 0; k < closing.size(); ++k) {
      const Vec3 impulse = group.lambda[closing[k]] - start[k];
      came += impulse.dot(before[k]), left += impulse.dot(velocity(closing[k]));
    }
    const double less = passive_share(came, left) - 1.0;
    if (less == 0.0) return;
    for (std::size_t k = 0; k < closing.size(); ++k) w.change(closing[k], less * (group.lambda[closing[k]] - start[k]));
  }

  static constexpr int kMostStrikes = 200;  // sweeps over a pair's contacts

  struct Settings {
    int iterations = 200;
  } settings_;
  std::string limit_;
};

}  // namespace

Entry<Response> sequential_impulse_response() {
  return entry<Response, SequentialImpulse>("sequential_impulse", "one contact after another on accumulated impulses");
}

}  // namespace impinge
