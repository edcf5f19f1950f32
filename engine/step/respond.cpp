#include "engine/step/respond.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/bodies/scale.hpp"
#include "engine/contact/recovery/passive_share.hpp"
#include "engine/contact/recovery/push_out.hpp"
#include "engine/core/error.hpp"
#include "engine/core/interrupt.hpp"
#include "engine/response/least_violation.hpp"
#include "engine/step/late_impacts.hpp"
#include "engine/step/roots/group_root.hpp"
#include "engine/step/tasks.hpp"
#include "engine/step/turns/landing.hpp"
#include "engine/step/turns/tension.hpp"
#include "engine/step/turns/turning.hpp"

namespace impinge {
namespace {

// positions only: a tenth of a percent of the overlap is accurate enough, the rest is seen again in the next sub-step
constexpr double kPushOutTolerance = 1e-3;
// of many that come to rest: it is of the widest gap that may close among them, and what it leaves they rest with
constexpr double kPushOutOfMany = 7e-4;
constexpr double kWorthwhile = 0.9;               // of what turning took before another solve: more is no gain
constexpr int kLonger = 2, kFewIterations = 100;  // of what the solve before turning took; and where that was nothing
constexpr double kEnergyTolerance = 1e-7,
                 kSlowedWins = 1e-3;        // of the energy; of what is slowed, which wins and loses some
constexpr std::size_t kManyContacts = 300;  // of a group whose solves are worth waiting with
// relative residuals: that tells where contacts are missed, and a large group may keep it; of sweeps that are told turns
constexpr double kRoughly = 1e-3, kTold = 1e-4;
// a task should last longer than it takes to wake a thread: some 20 µs
constexpr std::size_t kContactsPerTask = 16;

/// The solution of one group, from its system to the value that it hands on.
class GroupSolve {
 public:
  GroupSolve(Bodies& bodies, const AssemblyInput& input, const CollisionGroup& group, GroupIndex index,
             const Solving& how, int iterations)
      : bodies_(bodies), input_(input), group_(group), index_(index), how_(how), before_(iterations) {}

  GroupResult run() {
    make_system();
    is_rough_ = may_wait() && now_.deformable.empty();
    if (is_large()) trust_ = Trust::none;  // each other answer would be as dear as the first
    const std::vector<Vec3> start = system().lambda;
    solve_before_meeting();
    solve_slowed();
    if (how_.velocities == VelocityTime::end) land(start);
    pay_for_recovery();
    find_root();
    follow_turns();
    if (!is_usable() && !how_.response.lives_on_overlap()) result_.is_contradiction = settle_contradiction(system());
    close();
    return std::move(result_);
  }

 private:
  GroupSystem& system() { return now_.system; }

  void make_system() {
    const StageTimer timer(result_.assemble_ms);
    now_ = assemble(input_, group_);
    rounding_ = rounding_speed(bodies_, now_, input_.time_step);
    bounds_.clear();
    for (const ContactRows& row : system().contacts) bounds_.push_back(row.bound);
  }

  void solve() {
    ResponseContext context = how_.context;
    context.lcp.is_in_motion = moves();
    if (is_rough_) context.lcp.tolerance = std::max(context.lcp.tolerance, kRoughly);
    solve(context);
  }
  void solve(ResponseContext context) {
    // a share of what is rounding says nothing
    const double asked = most_asked(system());
    if (asked > 0.0 && asked <= rounding_ && !how_.response.lives_on_overlap())
      context.lcp.tolerance = std::max(context.lcp.tolerance, rounding_ / asked);
    if (how_.freezes) result_.frozen = freeze(system());  // before a later Newton iteration takes A anew
    if (how_.watcher != nullptr) how_.watcher->solving(index_, now_, how_);
    const StageTimer timer(result_.response_ms);
    try {
      result_.response = how_.response.solve(system(), how_.lcp, context);
    } catch (const DivergenceError& error) {  // a response knows no names
      std::string names;
      for (const BodyIndex b : now_.deformable)
        names += fmt::format("{}'{}'", names.empty() ? "" : ", ", bodies_[b].name);
      throw DivergenceError(fmt::format("group {}, body {}: {}; use more sub-steps or a softer material",
                                        index_.value(), names, error.what()));
    }
    count(result_.response);
    if (!result_.response.converged() && judge().relative == 0.0) result_.response.ended = StopReason::converged;
  }
  void solve_from(const std::vector<Vec3>& lambda) {
    system().lambda = lambda;
    solve();
  }
  GroupVerdict judge() { return judge_group(system(), nullptr, rounding_); }

  /// What is taut swings no faster than the sub-step sees, but where that would win energy, as of a chain that whips.
  void solve_slowed() {
    std::vector<SlowedBody> slowed;
    if (!how_.response.is_approximate() && !how_.response.lives_on_overlap() &&
        is_held(bodies_, group_, input_.contacts))
      slowed = slow_taut_bodies(system(), input_.time_step);
    if (slowed.empty()) return solve_expecting_turns();
    const std::vector<Vec3> start = system().lambda;
    solve_expecting_turns();
    if (!wins_energy(kSlowedWins)) return;
    forget_turns();
    for (const SlowedBody& body : slowed) system().rigid[body.block].inverse_inertia = body.inverse_inertia;
    system().lambda = start, system().assembled.reset();
    solve_expecting_turns();
  }

  /// Solves, by rows that know already what turning would take with the velocities expected; without where those have no
  /// answer; and from nothing, where what is started from was in the way.
  void solve_expecting_turns() {
    const std::vector<Vec3> start = system().lambda;
    are_told_ = expect_turns();
    solve();
    if (are_told_ && is_usable() && wins_energy() && limit_turning(system(), bounds_, how_.contact, input_.time_step))
      solve_from(start);
    if (are_told_ && (!is_usable() || wins_energy())) {
      forget_turns();
      solve_from(start);
    }
    if (result_.response.ended == StopReason::contradiction || is_usable() || !starts_too_high(system(), start)) return;
    solve_from(std::vector<Vec3>(start.size(), Vec3::Zero()));
  }

  /// What stands carries until what comes down does.
  void land(std::span<const Vec3> start) {
    if (now_.meeting > 0.0 || !how_.response.uses_cone_solver() || !is_usable()) return;
    landing_ = find_landing(system(), start, how_.contact, input_.time_step, [&](GroupSystem& standing) {
      const ResponseResult solved = how_.response.solve(standing, how_.lcp, how_.context);
      count(solved);
      return solved.converged();
    });
    if (!landing_) return;
    landing_->begin(system());
    solve();
    if (!is_usable()) forget_landing();
  }
  void forget_landing() {
    landing_->close(system()), landing_.reset();
    solve();
  }

  /// Attachments come together by velocities as far as that wins no energy, and by positions beyond. What floats would lose
  /// angular momentum by these.
  void pay_for_recovery() {
    if (now_.recovery.empty() || !now_.deformable.empty() || how_.response.lives_on_overlap()) return;
    if (floats(bodies_, group_, input_.contacts) || !wins_energy()) return;
    const AssembledGroup asked = now_;
    const ResponseResult response = result_.response;
    const std::optional<FrozenGroup> frozen = result_.frozen;
    const double won = energy_won(bodies_, asked).first;
    const bool is_answered = is_usable();
    const auto solve_for = [&](double share, const std::vector<Vec3>& start) {
      now_ = asked;
      ask_for_share(now_, share, input_.time_step);
      solve_from(start);
      return is_usable();
    };
    if (solve_for(0.0, std::vector<Vec3>(asked.system.lambda.size(), Vec3::Zero())) && is_answered) {
      const double share = passive_share(bodies_, now_, asked);
      const std::vector<Vec3> none = system().lambda;
      std::vector<Vec3> start = none;  // the answer, where no contact opens or slips
      for (std::size_t i = 0; i < start.size(); ++i) start[i] += share * (asked.system.lambda[i] - none[i]);
      if (!solve_for(share, start)) solve_for(0.0, none);
    }
    if ((is_answered && !is_usable()) || !(energy_won(bodies_, now_).first < won))
      now_ = asked, result_.response = response, result_.frozen = frozen;
  }

  /// What can't move holds two that meet in flight until they do, too: what it makes of their velocities without the meeting.
  void solve_before_meeting() {
    if (now_.meeting == 0.0) return;
    before_meeting_ = without_meeting(system());
    if (!before_meeting_.contacts.empty()) count(how_.response.solve(before_meeting_, how_.lcp, how_.context));
  }

  /// Of many contacts by what is expected of them; of few by free velocities what rolls, whose turning impulses change
  /// little.
  bool expect_turns() {
    if (!follows_turns() || (is_large() && how_.expected.empty())) return false;
    if (!is_large() && !is_turning(bodies_, now_, how_.contact, input_.time_step)) return false;
    GroupSystem& s = system();
    s.clear_delta();
    for (std::size_t i = 0; is_large() && i < now_.rigid.size(); ++i) {
      const Collider& to = how_.expected[now_.rigid[i]];
      s.delta_velocity[i] = to.velocity - s.rigid[i].velocity;
      s.delta_angular_velocity[i] = to.angular_velocity - s.rigid[i].angular_velocity;
    }
    const bool are_told = ask_for_turning(s, look_at_ends(), bounds_, how_.contact, input_.time_step);
    s.clear_delta();
    return are_told;
  }

  /// Whether the answer is asked for only to see where it leads.
  bool may_wait() const { return how_.is_provisional && is_large() && !how_.response.is_approximate(); }
  bool is_large() const { return now_.contacts.size() >= kManyContacts; }
  bool follows_turns() const {
    if (how_.contact.turning_solves == 0 || now_.rigid.empty() || how_.response.is_approximate()) return false;
    if (now_.meeting > 0.0) return false;                                   // its ways are no straight ones
    return now_.deformable.empty() || how_.integrator.newton() == nullptr;  // A is that of the answer
  }

  bool moves() const { return is_on_its_way(bodies_, group_, how_.context.gravity, input_.time_step); }

  void forget_turns() { forget_turning(system(), bounds_), are_told_ = false; }

  /// Whether there is an answer to go on with: of many rigid bodies one that is near the exact one serves, too. So it does
  /// of sweeps that creep because rows are told turns by spins of before, and strain by what the one who drives them changes.
  bool is_usable() {
    if (result_.response.converged()) return true;
    if (are_told_ && !how_.response.uses_cone_solver() && is_driven(bodies_, group_, input_.contacts) &&
        judge().relative <= kTold)
      return true;
    if (!is_large() || !now_.deformable.empty() || how_.response.is_approximate()) return false;
    return judge().relative <= kRoughly;
  }

  /// Newton schemes: the same contacts at each iterate, whose A and b are those of the motion that contact allows.
  void find_root() {
    const NewtonSettings* newton = how_.integrator.newton();
    if (newton == nullptr || now_.deformable.empty()) return;
    GroupRoot root(bodies_, how_.integrator, *newton, now_);
    const auto look = [&] {
      result_.root_residual = root.residual_of(now_);
      return result_.is_at_root = result_.root_residual <= newton->tolerance;
    };
    for (int i = 0; i < newton->max_iterations; ++i) {
      check_interrupt();
      {
        const StageTimer timer(result_.assemble_ms);
        if (look()) return;
        root.go_on(now_, i + 1 == newton->max_iterations);
      }
      const std::vector<Vec3> lambda = system().lambda;
      make_system();
      if (!lambda.empty()) system().lambda = lambda;
      root.keep_bounds(system());
      solve();
    }
    if (root.is_controlled()) look();
  }

  /// Rigid bodies: the same rows, told how much nearer their points come because bodies turn on the way. An answer that
  /// can't be had, or does no better than the one before, is not taken; what takes far longer than the one before can't.
  void follow_turns() {
    bool is_deep = follow_turns_once();
    if (is_deep && landing_) forget_landing(), is_deep = follow_turns_once();
    // where bodies turn otherwise than was counted on, with less of that
    for (; is_deep && trust_ != Trust::none; is_deep = follow_turns_once()) {
      trust_ = trust_ == Trust::facets ? Trust::lifts : Trust::none;
      forget_turns();
      if (trust_ == Trust::lifts) are_told_ = expect_turns();
      solve();
    }
  }

  /// Whether contacts end deeper than positions may take back.
  bool follow_turns_once() {
    if (!follows_turns() || !is_usable()) return false;
    EndRows ends = look_at_ends();
    double lost = most_lost(system(), ends, how_.contact, input_.time_step);
    if (lost == 0.0) return false;
    result_.is_provisional = may_wait();
    if (result_.is_provisional) return false;
    ResponseContext context = how_.context;
    context.lcp.is_in_motion = moves();
    context.lcp.max_iterations =
        std::min(context.lcp.max_iterations, kLonger * std::max(before_, result_.response.iterations) + kFewIterations);
    // what is on its way and had no exact answer without turning has none with it
    const bool is_loose = !result_.response.converged() && context.lcp.is_in_motion;
    if (is_loose) context.lcp.tolerance = std::max(context.lcp.tolerance, judge().relative);
    for (int i = 0; i < how_.contact.turning_solves && lost > 0.0; ++i) {
      check_interrupt();
      GroupSystem system_before = system();
      const ResponseResult response_before = result_.response;
      std::optional<FrozenGroup> frozen_before = result_.frozen;
      ask_for_turning(system(), ends, bounds_, how_.contact, input_.time_step);
      solve(context);
      if (is_loose && !(judge().relative <= how_.context.lcp.tolerance))
        result_.response.ended = response_before.ended, result_.response.limit = response_before.limit;
      double now = INFINITY;
      EndRows ends_now;
      if (is_usable() && !wins_energy())
        ends_now = look_at_ends(), now = most_lost(system(), ends_now, how_.contact, input_.time_step);
      if (!(now < lost)) {
        system() = std::move(system_before);
        result_.response = response_before, result_.frozen = std::move(frozen_before);
        break;
      }
      ends = std::move(ends_now);
      if (now > kWorthwhile * lost) break;
      lost = now;
    }
    return ends_deep(system(), ends, how_.contact);
  }

  EndRows look_at_ends() const {
    return rows_at_end(bodies_, now_, input_.contacts, how_.contact, input_.time_step, trust_);
  }

  /// Unless it is driven by somebody, who may give it some.
  bool wins_energy(double tolerance = kEnergyTolerance) const {
    if (is_driven(bodies_, group_, input_.contacts)) return false;
    const auto [won, free] = energy_won(bodies_, now_);
    return won > free * tolerance;
  }

  void close() {
    const StageTimer timer(result_.response_ms);
    result_.verdict = judge();  // of stage 12: the judge sees the group while its system stands
    result_.is_usable = result_.is_at_root && is_usable();
    if (is_rough_ && !(result_.verdict.relative <= how_.context.lcp.tolerance)) result_.is_provisional = true;
    if (result_.frozen) keep_answer(bodies_, now_, input_.contacts, *result_.frozen);
    if (landing_) landing_->close(system());
    result_.velocity = now_.by_body(group_, system().delta_velocity, spins(), system().deformable_delta);
    if (how_.velocities == VelocityTime::middle)
      result_.struck = struck_bodies(now_, group_, input_.contacts, how_.contact);
    push_out();
    follow_flight();
    keep_contacts(bodies_, now_, input_.contacts, index_, result_);
    if (how_.keeps_rows) keep_rows(bodies_, now_, group_, input_.contacts, result_);
  }

  void push_out() {
    const GroupSystem& s = system();
    if (!s.position_velocity.empty())
      return displace(now_.by_body(group_, s.position_velocity, s.position_angular_velocity, {}), 1.0);
    if (how_.response.lives_on_overlap()) return;
    // pulled together by positions what floats and turns would lose angular momentum: the next piece takes all by velocity
    if (!now_.drift.empty() && floats(bodies_, group_, input_.contacts)) now_.drift.clear();
    if (!needs_push_out(s, now_.drift, how_.contact, input_.time_step)) return follow_rebounds();
    check_interrupt();
    GroupSystem recovery = make_push_out_system(s, now_.drift, how_.contact, input_.time_step);
    ResponseContext loose = how_.context;
    loose.lcp.is_in_motion = moves();
    loose.lcp.tolerance = is_large() && !loose.lcp.is_in_motion ? kPushOutOfMany : kPushOutTolerance;
    loose.recovers_overlap = true;
    const ResponseResult solved = how_.response.solve(recovery, how_.lcp, loose);
    count(solved);
    if (!solved.converged()) settle_contradiction(recovery);
    // where bodies are wedged the way out is longer than the overlap: it is gone a part a sub-step, in the same proportions
    std::vector<BodyVector> velocity =
        now_.by_body(group_, recovery.delta_velocity, recovery.delta_angular_velocity, recovery.deformable_delta);
    for (std::size_t i = 0; i < velocity.size(); ++i)
      result_.push_out.push_back(fastest_point(velocity[i], bodies_[group_.bodies[i]].radius));
    const double share =
        share_of_push_out(bodies_, group_, how_.contact.max_push_out, input_.gravity, result_.push_out);
    for (double& speed : result_.push_out) speed *= share;
    displace(std::move(velocity), share);
  }

  /// Rebounds act when their gaps close, not when the sub-step begins: until then bodies move by their free velocities. Of
  /// a group that floats that would be a turn about its centre, which only spins could take back: with energy from nowhere.
  void follow_rebounds() {
    if (now_.meeting > 0.0) return;
    const std::optional<LateImpacts> late = late_impacts(system(), input_.time_step);
    if (late && !floats(bodies_, group_, input_.contacts))
      result_.displacement = now_.by_body(group_, late->linear, late->angular, {});
  }

  /// Until then the bodies go on: what that is beside the way of the velocities that they end with.
  void follow_flight() {
    if (now_.meeting == 0.0) return;
    const LateImpacts ways = ways_until_meeting(bodies_, now_, before_meeting_, input_.time_step);
    std::vector<BodyVector> all = now_.by_body(group_, ways.linear, ways.angular, {});
    for (std::size_t i = 0; i < result_.displacement.size(); ++i) all[i].twist += result_.displacement[i].twist;
    result_.displacement = std::move(all);
    result_.follows_flight = true, result_.taken.reset();  // the impulse acted on a common point, on the way
  }

  std::vector<Vec3> spins() const {
    const auto& changes = now_.system.delta_angular_velocity;
    return now_.meeting == 0.0 ? changes : spins_as_they_stand(bodies_, now_, changes);
  }

  void displace(std::vector<BodyVector> velocity, double share) {
    const double h = share * input_.time_step;
    for (BodyVector& by : velocity) by = {{h * by.twist.linear, h * by.twist.angular}, h * by.nodes};
    result_.displacement = std::move(velocity);
    if (floats(bodies_, group_, input_.contacts)) result_.taken = std::max(0.0, -energy_won(bodies_, now_).first);
  }

  void count(const ResponseResult& solved) {
    result_.iterations += solved.iterations;
    result_.outer_iterations += solved.outer_iterations;
  }

  Bodies& bodies_;
  const AssemblyInput& input_;
  const CollisionGroup& group_;
  GroupIndex index_;
  const Solving& how_;
  std::vector<double> bounds_;  // by row, before anybody asked for turning
  double rounding_ = 0.0;       // m/s: what the rows' velocities are known to
  const int before_;            // iterations that the answer took which it begins with
  AssembledGroup now_;
  GroupSystem before_meeting_;  // solved, where two meet in flight
  std::optional<Landing> landing_;
  bool is_rough_ = false, are_told_ = false;  // the latter: rows are, what turning takes
  Trust trust_ = Trust::facets;
  GroupResult result_;
};

}  // namespace

GroupResult respond_to_group(Bodies& bodies, const AssemblyInput& input, const CollisionGroup& group, GroupIndex index,
                             const Solving& how, int iterations) {
  return GroupSolve(bodies, input, group, index, how, iterations).run();
}

void respond(Bodies& bodies, const ContactList& contacts, std::span<const Vec3> start,
             std::span<const CollisionGroup> groups, const std::vector<char>& is_known, const Solving& how,
             std::vector<GroupResult>& results, StageTimes& times) {
  const AssemblyInput input{bodies,      contacts,     start,          how.contact,    how.context.time_step,
                            how.gravity, how.rebounds, how.velocities, how.drift_time, how.response.is_approximate()};
  results.resize(groups.size());
  std::vector<std::size_t> wanted;
  for (std::size_t g = 0; g < groups.size(); ++g)
    if (is_known.empty() || is_known[g] == 0) wanted.push_back(g);
  double wall_ms = 0.0;
  {
    const StageTimer timer(wall_ms);
    for_each_in_tasks(
        wanted.size(), kContactsPerTask, [&](std::size_t i) { return groups[wanted[i]].contacts.size(); },
        [&](std::size_t i) {
          const std::size_t g = wanted[i];
          results[g] = respond_to_group(bodies, input, groups[g], GroupIndex(g), how, results[g].response.iterations);
        });
  }
  // threads work side by side: what the stages share of the time that passed
  double assemble_ms = 0.0, all_ms = 0.0;
  for (const std::size_t g : wanted)
    assemble_ms += results[g].assemble_ms, all_ms += results[g].assemble_ms + results[g].response_ms;
  const double share = all_ms > 0.0 ? assemble_ms / all_ms : 0.0;
  times.assemble_ms += share * wall_ms;
  times.response_ms += (1.0 - share) * wall_ms;
}

}  // namespace impinge
