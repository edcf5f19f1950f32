// The frame, spelled out. engine/README.md names the same twelve steps.
#include "engine/world/world.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/core/archive.hpp"
#include "engine/core/interrupt.hpp"
#include "engine/integrators/rigid_motion.hpp"
#include "engine/world/world_stages.hpp"

namespace impinge {
namespace {

/// Scripted bodies move from pose(t) to pose(t + h): the velocity that does so exactly.
void drive_scripted(std::span<RigidBody> bodies, double time, double h) {
  for (RigidBody& body : bodies) {
    if (body.kind != BodyKind::scripted || body.motion.is_empty()) continue;
    const Pose now = body.motion.at(time), then = body.motion.at(time + h);
    body.velocity = (then.apply(body.center) - now.apply(body.center)) / h;
    body.scripted_angular_velocity = rotation_log(then.rotation * now.rotation.transpose()) / h;
  }
}

void place_scripted(std::span<RigidBody> bodies, double time) {
  for (RigidBody& body : bodies) {
    if (body.kind != BodyKind::scripted || body.motion.is_empty()) continue;
    const Pose file = body.motion.at(time);
    body.pose = {file.rotation, file.apply(body.center)};
    body.update_world_vertices();
  }
}

constexpr double kLargest = 1e12;  // metres, m/s: beyond this nothing is resolved and squares overflow soon

void check_state(const RigidBody& body, int frame, int group) {
  if (body.soft) {
    if (body.soft->fem.position.allFinite() && body.soft->fem.position.cwiseAbs().maxCoeff() < kLargest &&
        body.soft->fem.velocity.allFinite())
      return;
    throw DivergenceError(
        fmt::format("frame {}, group {}, body '{}': a node's position or velocity is no longer a finite number below "
                    "{:g}; use more "
                    "sub-steps, or a more stable material or integrator",
                    frame, group, body.name, kLargest));
  }
  // a maximum alone may pass over NaN
  const bool fine = body.pose.position.allFinite() && body.velocity.allFinite() &&
                    body.pose.position.cwiseAbs().maxCoeff() < kLargest &&
                    body.velocity.cwiseAbs().maxCoeff() < kLargest && body.angular_momentum.allFinite() &&
                    body.pose.rotation.allFinite();
  if (fine) return;
  throw DivergenceError(fmt::format(
      "frame {}, group {}, body '{}': position or velocity is no longer a finite number below {:g}; use more "
      "sub-steps, or smaller velocities and forces",
      frame, group, body.name, kLargest));
}

/// advance_rigid knows neither frame nor name.
void advance_or_name(RigidBody& body, double h, int frame, int group) {
  try {
    advance_rigid(body, h);
  } catch (const DivergenceError& error) {
    throw DivergenceError(
        fmt::format("frame {}, group {}, body '{}': {}; use more sub-steps, or smaller velocities and forces", frame,
                    group, body.name, error.what()));
  }
}

bool is_moving_body(std::span<const RigidBody> bodies, int b) {
  if (b < 0) return false;
  const RigidBody& body = bodies[b];
  if (body.has_freedom()) return !body.asleep;
  return body.kind == BodyKind::scripted && !(body.velocity.isZero(0.0) && body.scripted_angular_velocity.isZero(0.0));
}

}  // namespace

World::World() : stages_(std::make_unique<Stages>()) {}
World::~World() = default;

RigidBody& World::add_body(const BodyDescription& description) {
  bodies_.push_back(make_rigid_body(description));
  names_.add(description.name);
  return bodies_.back();
}

void World::Stages::choose_linear_solver(const LinearSolverChoice& wanted) {
  if (linear_solver == wanted) return;
  linear_solver = wanted;
  soft.clear();
}

void World::Stages::make_collision_groups(std::span<const RigidBody> bodies, std::span<const Attachment> attachments) {
  std::vector<std::pair<int, int>> ends;
  for (const Collision& c : detection.collisions) ends.emplace_back(c.body_a, c.body_b);
  const auto awake = [&](int b) { return b >= 0 && bodies[b].has_freedom() && !bodies[b].asleep; };
  for (const Attachment& a : attachments) {
    const int first = awake(a.a.body) ? a.a.body : a.b.body;
    if (awake(first))
      ends.emplace_back(first, first == a.a.body && a.b.body >= 0 ? a.b.body : first);
    else
      ends.emplace_back(-1, -1);
  }
  std::vector<char> joins;
  for (const RigidBody& body : bodies) joins.push_back(body.has_freedom());
  groups = make_groups(ends, joins);
}

void World::add_attachment(const AttachmentDescription& description) {
  attachments_.push_back(make_attachment(description, bodies_, names_));
}

void World::start() {
  frame_ = 0;
  time_ = 0.0;
  stages_->frame_stats = {};
  parameters_changed();
  place_scripted(bodies_, time_);
  drive_scripted(bodies_, time_, parameters.simulation.time_step());
  detect(parameters.simulation.time_step());
  publish(false);
}

void World::step() {
  FrameStats& stats = stages_->frame_stats;
  stats = {};
  ++frame_;
  {
    const StageTimer timer(stats.times.step_ms);
    const double h = parameters.simulation.time_step();
    for (int left = parameters.simulation.substeps; left > 0; --left) substep(h, left);
  }
  publish(true);
}

FrozenStep World::step_and_freeze() {
  FrozenStep frozen;
  stages_->frozen = &frozen;
  struct Reset {  // a step that diverges leaves nobody holding on to it
    Stages& stages;
    ~Reset() { stages.frozen = nullptr; }
  } reset{*stages_};
  step();
  frozen.frame = frame_;
  frozen.time_step = parameters.simulation.time_step();
  frozen.time = time_ - frozen.time_step;
  frozen.gravity = parameters.simulation.gravity;
  frozen.linear_solver = parameters.simulation.linear_solver;
  ParameterSet rows;
  parameters.bind(rows);
  for (const Parameter& row : rows.all()) frozen.settings.emplace_back(row.path, format_value(row.get()));
  for (const RigidBody& body : bodies_) frozen.bodies.push_back(body.name);
  return frozen;
}

void World::free_velocity(int index, double h) {
  check_interrupt();
  Stages& s = *stages_;
  RigidBody& body = bodies_[index];
  if (body.asleep || !body.has_freedom()) return;
  if (!body.soft) return apply_gravity(body, parameters.simulation.gravity, h);
  if (!s.soft[index]) {
    s.soft[index] = std::make_unique<SoftStep>();
    s.soft[index]->choose_solvers(body.soft->fem, s.linear_solver);
  }
  s.soft[index]->begin(body, *parameters.simulation.integrator, parameters.simulation.gravity, h, frame_);
}

void World::substep(double h, int left) {
  Stages& s = *stages_;
  StageTimes& times = s.frame_stats.times;
  // 2 begin
  s.choose_linear_solver(parameters.simulation.linear_solver);
  drive_scripted(bodies_, time_, h);
  for (RigidBody& body : bodies_)
    if (body.soft) body.soft->drive_held(time_, h, 1.0 / left);
  s.sleeping.wake_moved_supports(bodies_);

  // 3, 4 external forces, A v* = b
  s.before.resize(bodies_.size());
  s.soft.resize(bodies_.size());
  {
    const StageTimer timer(times.integrate_ms);
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      s.before[i] = {bodies_[i].velocity, bodies_[i].angular_velocity()};
      free_velocity(static_cast<int>(i), h);
    }
  }

  // 5, 6 detection; a collision with a sleeper wakes its island, which may touch more
  detect(h);

  {
    const StageTimer timer(times.assemble_ms);
    // 8 groups; 7, the match with the last sub-step, comes with the system of each (solve_group)
    s.make_collision_groups(bodies_, attachments_);
  }

  s.contacts.clear();
  s.solved.clear();
  s.supports.clear();
  s.attachment_impulse.assign(attachments_.size(), Vec3::Zero());
  s.push.assign(bodies_.size(), {});
  s.soft_push.assign(bodies_.size(), {});
  for (const ContactCache::Item& item : s.cache.items()) {  // sleepers keep their impulses for the day they wake
    const auto rests = [&](int b) { return b < 0 || bodies_[b].asleep || !bodies_[b].has_freedom(); };
    if (rests(item.body_a) && rests(item.body_b)) s.solved.push_back(item);
  }
  s.freezing = s.frozen != nullptr && left == 1;
  for (std::size_t g = 0; g < s.groups.size(); ++g) {
    check_interrupt();
    // 9 Jacobian and group system, 10 response
    const GroupSystem system = solve_group(s.groups[g], h);
    push_out(system, s.groups[g], h);
    take_group(system, static_cast<int>(g));
  }
  s.cache.assign(std::move(s.solved));

  check_interrupt();
  // 11 integrate
  const StageTimer timer(times.integrate_ms);
  integrate(h);
  if (parameters.simulation.sleeping)
    s.sleeping.update(bodies_, s.groups, s.supports, parameters.simulation.sleep_speed,
                      parameters.simulation.sleep_time, h);
}

void World::integrate(double h) {
  Stages& s = *stages_;
  std::vector<int> group_of(bodies_.size(), -1);
  for (std::size_t g = 0; g < s.groups.size(); ++g)
    for (int b : s.groups[g].bodies) group_of[b] = static_cast<int>(g);
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    RigidBody& body = bodies_[i];
    if (body.asleep) continue;
    if (body.is_dynamic()) advance_or_name(body, h, frame_, group_of[i]);
    if (!body.soft) continue;
    DeformableBody& fem = body.soft->fem;
    parameters.simulation.integrator->advance(fem, s.soft[i]->step, s.soft[i]->step.v_star);
    if (s.soft_push[i].size() > 0) {
      VecX displacement = VecX::Zero(fem.position.size());
      fem.scatter_free(s.soft_push[i], displacement);
      fem.position += displacement;
    }
    // Newmark's accelerations are those of the elastic forces alone: contact acts at the end of the step [Kane99], or a
    // body that lands would bounce back with the speed it came with
    if (s.soft[i]->touched) fem.acceleration_known = false;
    body.velocity = fem.momentum() / body.mass;
  }
  for (const CollisionGroup& group : s.groups) {
    // a displacement changes x × p: where a group is free of the rest of the world, its spin takes the difference, so
    // that recovery from overlap keeps angular momentum too
    const auto is_free = [&](int c) {
      if (c >= static_cast<int>(s.detection.collisions.size())) return false;
      return bodies_[s.detection.collisions[c].body_a].is_dynamic() &&
             bodies_[s.detection.collisions[c].body_b].is_dynamic();
    };
    const bool closed = std::all_of(group.contacts.begin(), group.contacts.end(), is_free);
    double mass = 0.0;
    Vec3 mean = Vec3::Zero();
    for (int b : group.bodies) mass += bodies_[b].mass, mean += bodies_[b].mass * bodies_[b].velocity;
    mean /= mass;
    for (int b : group.bodies) {
      if (s.push[b].linear.isZero(0.0) && s.push[b].angular.isZero(0.0)) continue;
      displace_rigid(bodies_[b], s.push[b].linear, s.push[b].angular);
      if (closed) bodies_[b].angular_momentum -= s.push[b].linear.cross(bodies_[b].mass * (bodies_[b].velocity - mean));
    }
  }
  time_ += h;
  place_scripted(bodies_, time_);
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (!bodies_[i].has_freedom() || bodies_[i].asleep) continue;
    check_state(bodies_[i], frame_, group_of[i]);
    bodies_[i].update_world_vertices();
  }
}

void World::detect(double h) {
  Stages& s = *stages_;
  for (;;) {
    check_interrupt();
    s.detection.run(bodies_, parameters, h, s.frame_stats.times);
    std::vector<std::pair<int, int>> ends;
    for (const Collision& c : s.detection.collisions) ends.emplace_back(c.body_a, c.body_b);
    for (const Attachment& a : attachments_)
      if (is_moving_body(bodies_, a.a.body) || is_moving_body(bodies_, a.b.body)) ends.emplace_back(a.a.body, a.b.body);
    std::vector<char> was_asleep;
    for (const RigidBody& body : bodies_) was_asleep.push_back(body.asleep);
    if (!s.sleeping.wake_touched(bodies_, ends)) return;
    for (std::size_t i = 0; i < bodies_.size(); ++i)  // the woken fall freely like all others in this sub-step
      if (was_asleep[i] && !bodies_[i].asleep) free_velocity(static_cast<int>(i), h);
  }
}

void World::parameters_changed() {
  // only what the model reads counts: a change of the view must not wake a sleeper, or pictures would change states
  ByteWriter settings;
  ParameterSet rows;
  parameters.bind(rows);
  for (const Parameter& row : rows.all()) settings.put(hash_bytes(format_value(row.get())));
  for (const RigidBody& body : bodies_)
    settings.put(body.friction), settings.put(body.restitution), settings.put(body.mass);
  const std::uint64_t hash = hash_bytes(settings.bytes());
  if (hash != stages_->settings_seen) stages_->sleeping.wake_all(bodies_);
  stages_->settings_seen = hash;
}

}  // namespace impinge
