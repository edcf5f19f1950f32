// The frame, spelled out. engine/README.md names the same twelve steps.
#include "engine/world/world.hpp"

#include <fmt/format.h>

#include "engine/bodies/scale.hpp"
#include "engine/contact/contact_reduction.hpp"
#include "engine/core/archive.hpp"
#include "engine/core/interrupt.hpp"
#include "engine/core/settings_error.hpp"
#include "engine/ledger/ledger.hpp"
#include "engine/step/act.hpp"
#include "engine/step/drive.hpp"
#include "engine/step/end_pose.hpp"
#include "engine/step/free_velocities.hpp"
#include "engine/step/integrate.hpp"
#include "engine/step/remember.hpp"
#include "engine/step/second_look.hpp"
#include "engine/step/step_watcher.hpp"

namespace impinge {
namespace {

/// Of a group that is left without an answer. A response that has one was asked by Newton iterations that have none.
UnsolvedGroups cause_of(const GroupResult& result) {
  if (result.is_contradiction || result.response.ended == StopReason::contradiction)
    return {SolveEnd::contradiction, "", 1};
  const ResponseResult& solve = result.response;
  if (solve.converged()) return {SolveEnd::cap, std::string(kRootLimit), 1};
  if (solve.ended == StopReason::iteration_cap) return {SolveEnd::cap, std::string(solve.limit), 1};
  return {solve.ended == StopReason::refused ? SolveEnd::refused : SolveEnd::stalled, "", 1};
}

}  // namespace

World::World() : sub_step_(std::make_unique<SubStep>()) {}
World::~World() = default;

Body& World::add_body(const BodyDescription& description) {
  was_still_ = false;
  return bodies_.add(make_body(description));
}

Body& World::add_absent_body(const BodyDescription& description) {
  Body& body = add_body(description);
  ByteWriter start;
  body.save(start);
  starts_[BodyIndex(bodies_.size().value() - 1)] = start.take();
  body.absent = body.deleted = true;
  return body;
}

void World::remove_absent_body() {
  IMPINGE_ASSERT(!bodies_.is_empty() && bodies_.back().absent);
  starts_.erase(BodyIndex(bodies_.size().value() - 1));
  bodies_.remove_last();
}

void World::bring_to_life(BodyIndex index) {
  Body& body = bodies_[index];
  if (!body.absent) return;
  IMPINGE_ASSERT(index == 0 || !bodies_[BodyIndex(index.value() - 1)].absent);
  ByteReader start(starts_.at(index));
  body.restore(start);
  body.update_world_vertices();
  body.absent = false;
}

void World::add_attachment(const AttachmentDescription& description) {
  const int number = attachments_.empty() ? 0 : attachments_.back().number + 1;
  for (Attachment& attachment : make_attachment(description, bodies_, number))
    attachments_.push_back(std::move(attachment));
  if (!description.collide && !description.body_b.empty())
    bodies_.keep_from_touching(bodies_.find(description.body_a), bodies_.find(description.body_b));
}

void World::start() {
  time_ = 0.0;
  parameters_changed();
  place(bodies_, time_);
  find_at_start();
}

void World::start_restored() { find_at_start(); }

void World::find_at_start() {
  frame_ = 0;
  stats_ = {};
  unsafe_.clear();
  const double h = parameters.simulation.time_step();
  for (Body& body : bodies_)
    if (!body.has_freedom() && !body.deleted) body.drive(time_, h, 1.0);
  sub_step_->time = time_, sub_step_->time_step = h;
  detect(bodies_, attachments_, detecting(parameters), time_integration(parameters), sleeping_, *sub_step_,
         stats_.times);
  drop_what_never_carries();
  publish_found();
}

void World::show_start(StepWatcher& watcher) const {
  IMPINGE_ASSERT(frame_ == 0 && !sub_step_->colliders.empty());
  watcher.found(bodies_, *sub_step_);
}

void World::step() { advance(nullptr); }

FrozenStep World::step_and_freeze() {
  FrozenStep frozen;
  advance(&frozen);
  frozen.frame = frame_;
  frozen.time_step = parameters.simulation.time_step();
  frozen.time = time_ - frozen.time_step;
  frozen.gravity = parameters.simulation.gravity;
  frozen.linear_solver = parameters.simulation.linear_solver;
  ParameterSet rows;
  parameters.bind_model(rows);
  for (const Parameter& row : rows.all()) frozen.settings.emplace_back(row.path, format_value(row.get()));
  frozen.bodies = bodies_.names();
  return frozen;
}

void World::advance(FrozenStep* frozen) {
  if (was_still_ && frozen == nullptr && watcher_ == nullptr) return repeat_still_frame();
  const bool still = is_still();
  was_still_ = false;
  let_rest();
  stats_ = {};
  unsafe_.clear();
  ++frame_;
  keep_ledger();
  if (ledger_) {
    std::vector<Balance> before;
    for (const BodyShare& share : shares_) before.push_back(share.balance);
    ledger_->open_frame(bodies_, parameters.simulation.gravity, before);
  }
  try {
    const StageTimer timer(stats_.times.step_ms);
    const double h = parameters.simulation.time_step();
    for (int left = parameters.simulation.substeps; left > 0; --left) substep(h, left, left == 1 ? frozen : nullptr);
  } catch (const DivergenceError& error) {  // the stages know no frame
    throw DivergenceError(fmt::format("frame {}, {}", frame_, error.what()));
  }
  if (ledger_) stats_.ledger = ledger_->so_far(bodies_);
  publish_solved();
  was_still_ = still && is_still();
}

void World::keep_ledger() {
  if (!parameters.record.ledger)
    ledger_.reset();
  else if (!ledger_)
    ledger_ = std::make_unique<Ledger>();
}

void World::drop_what_never_carries() {
  const ContactSettings& contact = parameters.contact;
  sub_step_->dropped.clear();
  // what lives on overlap has a spring a contact: fewer would be softer
  if (contact.reduction == Reduction::none || contact.points != ContactPoints::proximity ||
      parameters.response.method->lives_on_overlap())
    return;
  SubStep& s = *sub_step_;
  s.dropped = reduce_contacts(bodies_, cache_, s.colliders, s.asked, contact, s.collisions);
}

void World::make_motion(double h, double share, bool freezes) {
  SubStep& s = *sub_step_;
  StageTimes& times = stats_.times;
  TimeIntegration how = time_integration(parameters);
  how.time_step = h;
  const auto timed = [](double& total_ms, auto&& stage) {
    const StageTimer timer(total_ms);
    stage();
  };

  if (ledger_) ledger_->open_motion(bodies_);

  // 2 begin
  s.time = time_, s.time_step = h;
  drive(bodies_, time_, h, share);
  sleeping_.wake_moved_supports(bodies_);

  // 3 external forces, 4 A v* = b
  timed(times.integrate_ms, [&] { find_free_velocities(bodies_, how); });
  reached(StepStage::free_motion);

  // 5 broad phase, 6 narrow phase
  detect(bodies_, attachments_, detecting(parameters), how, sleeping_, s, times);
  for (const StepStage stage : {StepStage::broad_phase, StepStage::narrow_phase}) reached(stage);
  timed(times.narrow_ms, [&] { drop_what_never_carries(); });
  reached(StepStage::reduction);
  if (watcher_ != nullptr) watcher_->found(bodies_, s);
  const ContactList contacts = s.contacts(attachments_);

  timed(times.assemble_ms, [&] {
    // 7 match with the last sub-step
    s.start.clear();
    if (parameters.contact.warm_start) s.start = remembered_impulses(s.tried ? *s.tried : cache_, contacts);
    // 8 groups
    s.groups = find_groups(bodies_, contacts);
  });
  reached(StepStage::groups);

  // 9 Jacobian and group systems, 10 response
  Solving solve = solving(parameters);
  solve.context.time_step = h;
  solve.context.share = h / parameters.simulation.time_step();
  solve.rebounds = &s.rebounds;
  solve.drift_time = s.drift_time;
  solve.freezes = freezes;
  solve.keeps_rows = ledger_ != nullptr;
  if (watcher_ != nullptr) solve.watcher = watcher_->solve_watcher(s);
  const bool is_looked_at = may_look_again() && !s.groups.empty();
  solve.is_provisional = is_looked_at;
  s.results.clear(), s.seen_at_end.clear();
  respond(bodies_, contacts, s.start, s.groups, {}, solve, s.results, times);
  reached(StepStage::response);
  solve.watcher = nullptr;  // of the groups as they were found
  if (is_looked_at) look_again(solve);

  check_interrupt();
  // 11 integrate
  timed(times.integrate_ms, [&] {
    if (ledger_) ledger_->freed(bodies_, how);
    change_velocities(bodies_, s);
    if (ledger_) ledger_->solved(bodies_, s, how);
    reached(StepStage::push_out);
    guard_.follow(bodies_, how, time_ + h);
    impinge::advance(bodies_, how, s);
    if (ledger_) ledger_->advanced(bodies_);
    push_out(bodies_, s);
    if (ledger_) ledger_->pushed_out(bodies_);
  });
  reached(StepStage::integration);
}

void World::reached(StepStage stage) {
  if (watcher_ != nullptr) watcher_->reached(stage, bodies_, *sub_step_);
}

/// Between 10 and 11: contacts that only the response leads to, and then the answers that waited for them.
void World::look_again(Solving& how) {
  SubStep& s = *sub_step_;
  const Detecting by = detecting(parameters);
  SecondLook look(bodies_, by, s);
  int left = parameters.contact.second_looks;
  for (;;) {
    how.expected = look.take_velocities();
    const bool is_missed = left > 0 && look.find(stats_.times);
    const bool is_answer =
        std::none_of(s.results.begin(), s.results.end(), [](const GroupResult& r) { return r.is_provisional; });
    if (!is_missed && is_answer) return;
    const SolvedBefore before(s, s.contacts(attachments_));
    const double missed = is_missed ? look.missed_speed() : 0.0;
    if (is_missed) look.add(cache_), --left;
    how.is_provisional = is_missed;
    stats_.lcp_iterations += before.solve_changed(bodies_, attachments_, how, s, stats_.times);
    if (is_missed && before.was_better(s, missed)) {
      stats_.lcp_iterations += before.restore(s);
      left = 0;
      continue;
    }
    reached(StepStage::second_look);
    if (watcher_ != nullptr) watcher_->found(bodies_, s);
  }
}

/// Whether solved velocities are looked at again.
bool World::may_look_again() const {
  if (parameters.contact.points != ContactPoints::proximity || parameters.contact.second_looks == 0 ||
      parameters.response.method->is_approximate())
    return false;
  // Newton schemes have taken A and b of their bodies where the first answer led
  if (parameters.simulation.integrator->newton() != nullptr)
    for (const Body& body : bodies_)
      if (body.kind() == BodyKind::deformable && !body.deleted) return false;
  return true;
}

void World::take_results(FrozenStep* frozen) {
  SubStep& s = *sub_step_;
  const bool work_is_fixed = parameters.response.method->iteration_setting().is_exact;
  remember_impulses(bodies_, s.results, cache_);
  for (GroupIndex g(0); g < s.groups.size(); ++g) {
    const GroupResult& result = s.results[g];
    s.groups[g].contacts = result.contacts;
    stats_.lcp_iterations += result.iterations;
    stats_.outer_iterations += result.outer_iterations;
    if (!result.is_answered())
      stats_.take_unsolved(cause_of(result),
                           larger(result.verdict.relative, result.is_at_root ? 0.0 : result.root_residual));
    else if (work_is_fixed && !(result.verdict.relative <= parameters.lcp.tolerance))
      stats_.take_fixed();
    stats_.residual_coulomb = larger(stats_.residual_coulomb, result.verdict.relative);
    stats_.residual = larger(stats_.residual, result.verdict.residual());
  }
  stats_.substep_penetration = deepest_shown(bodies_, detecting(parameters), s.results, stats_.substep_penetration);
  if (frozen != nullptr)
    for (GroupResult& result : s.results) frozen->groups.push_back(std::move(*result.frozen));
  time_ += s.time_step;
  if (ledger_) ledger_->kept(bodies_);
  const Parameters::Simulation& p = parameters.simulation;
  if (!p.sleeping) return;
  sleeping_.update(bodies_, s.groups, find_supports(bodies_, s.results), push_out_speeds(bodies_, s.groups, s.results),
                   {p.sleep_speed, p.sleep_time, scale_gravity(p.gravity)}, s.time_step);
  if (ledger_) ledger_->rested(bodies_);
}

void World::act(const Act& act) {
  look_at_all();
  keep_ledger();
  const auto doing = [&] {
    if (act.verb == Act::add)
      bring_to_life(bodies_.find(act.body));
    else
      act_on(bodies_, act, parameters.simulation.frame_time, sleeping_, cache_);
  };
  ledger_ ? ledger_->act(bodies_, act, parameters.simulation.gravity, doing) : doing();
}

/// Of what only the model reads: a change of the view must not wake a sleeper, or pictures would change states. The first
/// is of the parameters, one a body follows, 0 of an absent one.
std::vector<std::uint64_t> World::settings() {
  ByteWriter all;
  ParameterSet rows;
  parameters.bind_model(rows);
  for (const Parameter& row : rows.all()) all.put(hash_bytes(format_value(row.get())));
  std::vector<std::uint64_t> hashes = {hash_bytes(all.bytes())};
  for (const Body& body : bodies_) {
    ByteWriter own;
    own.put(body.friction.value_or(-1.0)), own.put(body.restitution.value_or(-1.0)), own.put(body.mass);
    hashes.push_back(body.absent ? 0 : hash_bytes(own.bytes()));
  }
  return hashes;
}

void World::parameters_changed() {
  const Response& response = *parameters.response.method;
  if (parameters.simulation.velocities == VelocityTime::middle && response.is_approximate() &&
      !response.lives_on_overlap())
    throw SettingsError(
        {"simulation.velocities", "response.method"},
        fmt::format("simulation.velocities is middle with response.method {}, which moves bodies in shorter steps of "
                    "its own; middle is for the responses that move them once a sub-step; choose another one, or "
                    "velocities = \"end\"",
                    parameters.response.method.name()));
  look_at_all();
  std::vector<std::uint64_t> now = settings();
  const std::size_t both = std::min(now.size(), settings_seen_.size());
  bool is_changed = settings_seen_.empty();
  // what has come to life was not changed by that
  for (std::size_t i = 0; i < both; ++i)
    is_changed |= now[i] != settings_seen_[i] && now[i] != 0 && settings_seen_[i] != 0;
  if (is_changed) sleeping_.wake_all(bodies_);
  settings_seen_ = std::move(now);
}

}  // namespace impinge
