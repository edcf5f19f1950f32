// Penalty forces: a spring and a damper at each contact, f = (-k d - b v_r) n. Nothing is solved for: overlap is what
// carries a load, weight/k at rest, and the work grows linearly with the contacts.
//
// Explicit: the forces of the sub-step's start; stable for Δt below about 2 √(m/k) only. Friction, which stops at most
// what slides, lags by a sub-step too: a body that should stick creeps at (m W - 1) a Δt, a what pulls it, W the
// tangential mobility at a contact. Implicit: those of its end, d = g0 + Δt u, which makes A + Δt² k n n^T + Δt b n n^T
// of A. Normal forces are those of a convex potential (contact_springs.hpp).
//
// Without a stiffness of its own a contact takes that of the mass m = 1/W_ii it feels: k = m/Δt² and critical damping
// when implicit, so that a lone body sinks by g Δt². Explicit, half of that, m such that all contacts that overlap may
// act at once: shared on a rigid body and on a node, or by the largest eigenvalue of J A⁻¹ J^T, whichever leaves more.
// Explicit springs of any stiffness that is stable let bodies overlap by what they move in a few sub-steps.
//
// Friction is regularised: |λ_t| = mu λ_n f(|u_t|/ε), f(y) = 2 y - y² up to y = 1 and 1 beyond it. It lies in Coulomb's
// cone but doesn't stick: what pulls with F_t < mu N creeps at ε (1 - √(1 - F_t/(mu N))). Restitution is what the
// damper leaves of it. Attachments and sliding points are no contacts, and hold: on springs that are stiff enough to be
// none, at the end of the sub-step in both forms. (On those of contacts a ball fell off the arm of a pendulum.)
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/response/contact_springs.hpp"
#include "engine/response/response.hpp"

namespace impinge {
namespace {

// of m/Δt², with critical damping: (ω Δt)² + 2 b Δt/m = 3.3 of the 4 that are stable
constexpr double kExplicitPart = 0.5;
constexpr double kHeld = 1e6;  // of 1/W_ii: what holds gives way by this part of what pulls it in a sub-step

struct Spring {
  double stiffness, damping;
};

enum class Form { end_of_step, start_of_step };

struct Settings {
  Form form = Form::end_of_step;
  double stiffness = 0.0;        // k, N/m, of one contact; 0: by the mass that it feels and Δt
  double damping = 0.0;          // b, N·s/m; 0 beside an automatic stiffness: critical
  Threshold slip_speed{4.9e-4};  // ε, part of the speed of a contact's scale
  int max_iterations = 200;
};

Spring spring_of(const Settings& s, double h, double mass, double part) {
  if (s.stiffness > 0.0) return {s.stiffness, s.damping};
  const double k = part * mass / (h * h);
  return {k, s.damping > 0.0 ? s.damping : 2.0 * std::sqrt(k * mass)};
}

/// At the end of the sub-step. A gap closes first, and only what is left of the motion meets spring and damper.
SpringLaw implicit_law(const ContactRows& rows, const Spring& spring, double h, double slip_speed) {
  const double slope = h * (spring.stiffness * h + spring.damping);
  const double offset = rows.gap > 0.0 ? -slope * rows.gap / h : -h * spring.stiffness * rows.gap;
  return {rows.kind, slope, offset, rows.friction, slip_speed};
}

/// Of what holds, which knows its error as a velocity Δx/Δt in u.
SpringLaw held_law(const ContactRows& rows, const Mat3& mobility) {
  const double least = rows.kind == RowKind::attachment ? mobility.diagonal().minCoeff() : mobility(0, 0);
  const double slope = least > 0.0 ? kHeld / least : 0.0;
  return {rows.kind, slope, slope * rows.bound};
}

/// At its start: a gap has no force yet.
SpringLaw explicit_law(const ContactRows& rows, const Spring& spring, double h, double slip_speed) {
  if (rows.gap >= 0.0) return {rows.kind, 0.0, 0.0, rows.friction, slip_speed};
  return {rows.kind, h * spring.damping, -h * spring.stiffness * rows.gap, rows.friction, slip_speed};
}

class Penalty : public Response {
 public:
  void declare(const Rows& rows) override {
    rows.add("form", settings_.form, {{Form::end_of_step, "implicit"}, {Form::start_of_step, "explicit"}},
             "Forces of the end of the sub-step (implicit), or of its start, stable for short sub-steps only "
             "(explicit).")
        .formerly("response.penalty_form");
    rows.add("stiffness", settings_.stiffness, {0.0, 1e15}, "N/m",
             "Spring of each contact; 0: by the mass that the contact feels and the sub-step.")
        .formerly("response.penalty_stiffness");
    rows.add("damping", settings_.damping, {0.0, 1e15}, "N·s/m",
             "Damper of each contact; 0 beside an automatic stiffness: critical damping.")
        .formerly("response.penalty_damping");
    rows.add("slip_speed", settings_.slip_speed, {0.0, 1e3, true}, "m/s",
             "Friction is full from this sliding speed on, and less below it; auto: 4.9e-4 √(g·size) of the smaller "
             "body that moves freely.")
        .formerly("response.penalty_slip_speed");
    limit_ = rows.add("max_iterations", settings_.max_iterations, {1, 1000000, true}, "",
                      "implicit: Newton steps at most for a group and sub-step.")
                 .path();
  }

  bool uses_cone_solver() const override { return false; }
  bool lives_on_overlap() const override { return true; }
  bool uses_restitution() const override { return false; }
  IterationSetting iteration_setting() override { return {&settings_.max_iterations}; }
  std::string summary(const LcpSettings&) const override {
    return fmt::format("{}, stiffness {}", settings_.form == Form::end_of_step ? "implicit" : "explicit",
                       settings_.stiffness > 0.0 ? shortest(settings_.stiffness) + " N/m" : "by mass and sub-step");
  }

  ResponseResult solve(GroupSystem& group, const LcpSolver&, const ResponseContext& context) const override {
    group.clear_delta();
    const GroupOperator a(group);
    const bool is_implicit = settings_.form == Form::end_of_step;
    SpringSolver linear(group, a, is_implicit ? 1.0 : INFINITY);
    ResponseResult result;
    if (is_implicit) {
      result = solve_laws(a, laws(group, a, context.time_step), context, group, linear);
    } else {
      take_explicit(group, a, context.time_step);
      if (std::any_of(group.contacts.begin(), group.contacts.end(), holds)) result = hold(group, a, linear, context);
    }
    if (!apply_springs(a, group, linear)) result.ended = StopReason::stagnated;
    return result;
  }

 private:
  static bool holds(const ContactRows& rows) { return rows.kind != RowKind::contact; }
  double slip_speed(const ContactRows& rows) const { return settings_.slip_speed.at(rows.scale.speed); }

  std::vector<SpringLaw> laws(const GroupSystem& group, const GroupOperator& a, double h) const {
    std::vector<SpringLaw> law;
    for (std::size_t i = 0; i < group.contacts.size(); ++i) {
      const ContactRows& rows = group.contacts[i];
      const Mat3 mobility = a.block_mobility(i);
      const double mass = mobility(0, 0) > 0.0 ? 1.0 / mobility(0, 0) : 0.0;
      law.push_back(holds(rows) ? held_law(rows, mobility)
                                : implicit_law(rows, spring_of(settings_, h, mass, 1.0), h, slip_speed(rows)));
    }
    return law;
  }

  ResponseResult solve_laws(const GroupOperator& a, const std::vector<SpringLaw>& law, const ResponseContext& context,
                            GroupSystem& group, SpringSolver& linear) const {
    const SpringsResult springs =
        solve_springs(a, law, std::max(1e-12, context.lcp.tolerance), settings_.max_iterations, group, linear);
    ResponseResult result;
    result.iterations = springs.iterations;
    if (!springs.converged) result.ended = StopReason::iteration_cap, result.limit = limit_;
    return result;
  }

  void take_explicit(GroupSystem& group, const GroupOperator& a, double h) const {
    std::vector<char> act;  // a gap has no spring yet, so there is nothing to share with it
    for (const ContactRows& rows : group.contacts) act.push_back(!holds(rows) && rows.gap < 0.0);
    const std::vector<Mat3> shared = a.shared_mobility(act);
    const double together = group.deformable.empty() ? 0.0 : a.largest_normal_eigenvalue(act);
    for (std::size_t i = 0; i < group.contacts.size(); ++i) {
      const ContactRows& rows = group.contacts[i];
      group.lambda[i].setZero();
      if (holds(rows)) continue;
      const Mat3& mobility = shared[i];
      double mass = mobility(0, 0) > 0.0 ? 1.0 / mobility(0, 0) : 0.0;
      if (together > 0.0 && act[i]) mass = std::max(mass, 1.0 / (together * a.block_mobility(i)(0, 0)));
      const SpringLaw law = explicit_law(rows, spring_of(settings_, h, mass, kExplicitPart), h, slip_speed(rows));
      Vec3 u = group.contact_velocity(i, false);
      u.x() = rows.velocity_before;
      Vec3& lambda = group.lambda[i] = law.impulse(u, law.normal(u));
      // friction of the start may not turn the sliding round: all of a body's contacts together at most stop it
      const double half = 0.5 * (mobility(1, 1) - mobility(2, 2)), mean = 0.5 * (mobility(1, 1) + mobility(2, 2));
      const double most = u.tail<2>().norm() / (mean + std::hypot(half, mobility(1, 2))),
                   size = lambda.tail<2>().norm();
      if (size > most) lambda.tail<2>() *= most / size;
    }
  }

  /// What holds, against what the contacts' forces make of the velocities.
  ResponseResult hold(GroupSystem& group, const GroupOperator& a, const SpringSolver& linear,
                      const ResponseContext& context) const {
    const bool is_pushed = apply_springs(a, group, linear);
    GroupSystem pushed = group;
    for (std::size_t b = 0; b < pushed.rigid.size(); ++b)
      pushed.rigid[b].velocity += group.delta_velocity[b],
          pushed.rigid[b].angular_velocity += group.delta_angular_velocity[b];
    for (std::size_t k = 0; k < pushed.deformable.size(); ++k)
      pushed.deformable[k].velocity += group.deformable_delta[k];
    pushed.clear_delta();
    const GroupOperator of_pushed(pushed);
    std::vector<SpringLaw> law(group.contacts.size());
    for (std::size_t i = 0; i < law.size(); ++i)
      if (holds(group.contacts[i])) law[i] = held_law(group.contacts[i], a.block_mobility(i));
    SpringSolver solver(pushed, of_pushed);
    ResponseResult result = solve_laws(of_pushed, law, context, pushed, solver);
    for (std::size_t i = 0; i < law.size(); ++i)
      if (holds(group.contacts[i])) group.lambda[i] = pushed.lambda[i];
    if (!is_pushed) result.ended = StopReason::stagnated;
    return result;
  }

  Settings settings_;
  std::string limit_;
};

}  // namespace

Entry<Response> penalty_response() {
  return entry<Response, Penalty>("penalty",
                                  "a spring and damper at each contact, explicit or implicit; regularised friction");
}

}  // namespace impinge
