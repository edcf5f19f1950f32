// The frame, spelled out. engine/README.md names the same twelve steps.
#include "engine/world/world.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/core/archive.hpp"
#include "engine/integrators/rigid_motion.hpp"
#include "engine/narrowphase/primitive.hpp"
#include "engine/response/group_judge.hpp"
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

ContactState state_of(const Vec3& lambda, double friction) {
  if (lambda.x() <= 0.0) return ContactState::open;
  // the solver puts sliding contacts on the cone to rounding; frictionless contacts slide
  return std::hypot(lambda.y(), lambda.z()) >= friction * lambda.x() * (1.0 - 1e-9) ? ContactState::slip : ContactState::stick;
}

constexpr double kLargest = 1e12;  // metres, m/s: beyond this nothing is resolved and squares overflow soon

void check_finite(const RigidBody& body, int frame, int group) {
  if (body.soft) {
    if (body.soft->fem.position.allFinite() && body.soft->fem.position.cwiseAbs().maxCoeff() < kLargest && body.soft->fem.velocity.allFinite()) return;
    throw DivergenceError(fmt::format("frame {}, group {}, body '{}': a node's position or velocity is no longer a finite number below {:g}; use more "
                                      "sub-steps, or a more stable material or integrator",
                                      frame, group, body.name, kLargest));
  }
  const bool fine = body.pose.position.cwiseAbs().maxCoeff() < kLargest && body.velocity.cwiseAbs().maxCoeff() < kLargest &&
                    body.angular_momentum.allFinite() && body.pose.rotation.allFinite();
  if (fine) return;
  throw DivergenceError(fmt::format("frame {}, group {}, body '{}': position or velocity is no longer a finite number below {:g}; use more "
                                    "sub-steps, or smaller velocities and forces",
                                    frame, group, body.name, kLargest));
}

}  // namespace

World::World() : stages_(std::make_unique<Stages>()) {}
World::~World() = default;

RigidBody& World::add_body(const BodyDescription& description) {
  bodies_.push_back(make_rigid_body(description));
  return bodies_.back();
}

void World::Stages::select(const Parameters& p) {
  if (linear_solver_name != p.simulation.linear_solver) {
    linear_solver_name = p.simulation.linear_solver;
    soft.clear();  // solvers are made with the name
  }
  if (integrator_name != p.simulation.integrator) integrator = make_named(integrators(), integrator_name = p.simulation.integrator);
  if (response_name != p.response.method) response = make_named(responses(), response_name = p.response.method);
  if (lcp_name != p.lcp.method) lcp = make_named(lcp_solvers(), lcp_name = p.lcp.method);
}

void World::Stages::make_collision_groups(std::span<const RigidBody> bodies) {
  std::vector<std::pair<int, int>> ends;
  for (const Collision& c : detection.collisions) ends.emplace_back(c.body_a, c.body_b);
  std::vector<char> joins;
  for (const RigidBody& body : bodies) joins.push_back(body.has_freedom());
  groups = make_groups(ends, joins);
}

void World::start() {
  for (std::size_t i = 0; i < bodies_.size(); ++i)
    for (std::size_t j = i + 1; j < bodies_.size(); ++j)
      if ((bodies_[i].has_freedom() || bodies_[j].has_freedom()) && !is_pair_supported(bodies_[i].shape, bodies_[j].shape))
        throw InputError(fmt::format("bodies '{}' ({}) and '{}' ({}) can meet, but this pair of shapes has no contact test", bodies_[i].name,
                                     shape_name(bodies_[i].shape), bodies_[j].name, shape_name(bodies_[j].shape)));
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
    for (int s = 0; s < parameters.simulation.substeps; ++s) substep(h);
  }
  publish(true);
}

void World::substep(double h) {
  Stages& s = *stages_;
  StageTimes& times = s.frame_stats.times;
  // 2 begin
  s.select(parameters);
  drive_scripted(bodies_, time_, h);
  s.sleeping.wake_moved_supports(bodies_);

  // 3, 4 external forces, A v* = b
  s.before.resize(bodies_.size());
  {
    const StageTimer timer(times.integrate_ms);
    for (std::size_t i = 0; i < bodies_.size(); ++i) s.before[i] = {bodies_[i].velocity, bodies_[i].angular_velocity()};
    for (RigidBody& body : bodies_)
      if (body.is_dynamic() && !body.asleep) apply_gravity(body, parameters.simulation.gravity, h);
    free_soft_velocity(h);
  }

  // 5, 6 detection; a collision with a sleeper wakes its island, which may touch more
  detect(h);

  {
    const StageTimer timer(times.assemble_ms);
    // 7 match with the last sub-step, 8 groups
    s.make_collision_groups(bodies_);
  }

  s.contacts.clear();
  std::vector<ContactCache::Item> solved;
  std::vector<std::pair<int, int>> supports;
  for (const ContactCache::Item& item : s.cache.items())  // sleepers keep their impulses for the day they wake
    if ((bodies_[item.body_a].asleep || !bodies_[item.body_a].has_freedom()) && (bodies_[item.body_b].asleep || !bodies_[item.body_b].has_freedom()))
      solved.push_back(item);
  std::vector<Twist> push(bodies_.size());
  std::vector<VecX> soft_push(bodies_.size());
  for (std::size_t g = 0; g < s.groups.size(); ++g) {
    CollisionGroup& group = s.groups[g];
    // 9 Jacobian and group system
    GroupSystem system;
    {
      const StageTimer timer(times.assemble_ms);
      system = make_group_system(bodies_, s.before, s.soft, group, s.detection.collisions, parameters, h);
      if (parameters.contact.warm_start)
        for (std::size_t i = 0; i < group.contacts.size(); ++i) {
          const Collision& c = s.detection.collisions[group.contacts[i]];
          Vec3 start = system.contacts[i].directions * s.cache.find(c.body_a, c.body_b, c.feature);
          if (system.contacts[i].friction == 0.0) start.tail<2>().setZero();
          system.lambda[i] = start.x() > 0.0 ? start : Vec3::Zero();
        }
    }
    // 10 response
    const ResponseSettings settings{{parameters.lcp.tolerance, parameters.lcp.max_iterations}, parameters.response.form, parameters.response.stop,
                                    parameters.response.max_iterations};
    {
      const StageTimer timer(times.response_ms);
      const ResponseResult result = s.response->solve(system, *s.lcp, settings);
      s.frame_stats.lcp_iterations += result.iterations;
      s.frame_stats.outer_iterations += result.outer_iterations;
      if (!result.converged) ++s.frame_stats.unconverged;
      // 12 (in part) the judge sees the group while its system stands
      const GroupVerdict verdict = judge_group(system);
      if (!(verdict.residual() <= s.frame_stats.residual)) s.frame_stats.residual = verdict.residual();
      if (needs_push_out(system, parameters)) {
        GroupSystem recovery = make_push_out_system(system, parameters, h);
        // positions only: a tenth of a percent of the overlap is accurate enough, the rest is seen again in the next sub-step
        ResponseSettings loose = settings;
        loose.lcp.tolerance = 1e-3;
        s.frame_stats.lcp_iterations += s.response->solve(recovery, *s.lcp, loose).iterations;
        int rigid = 0, deformable = 0;
        for (int b : group.bodies) {
          if (bodies_[b].soft) {
            soft_push[b] = h * recovery.soft[deformable].scale * recovery.soft_delta[deformable];
            ++deformable;
          } else {
            push[b] = {h * recovery.delta_velocity[rigid], h * recovery.delta_angular_velocity[rigid]};
            ++rigid;
          }
        }
      }
    }
    int rigid = 0, deformable = 0;
    for (int b : group.bodies) {
      RigidBody& body = bodies_[b];
      if (body.soft) {
        s.soft[b]->step.v_star += system.soft_delta[deformable++];
        continue;
      }
      body.velocity += system.delta_velocity[rigid];
      body.angular_momentum += body.world_inertia() * system.delta_angular_velocity[rigid++];
    }
    for (std::size_t i = 0; i < group.contacts.size(); ++i) {
      const Collision& c = s.detection.collisions[group.contacts[i]];
      const Vec3& lambda = system.lambda[i];
      if (!lambda.isZero(0.0)) solved.push_back({c.body_a, c.body_b, c.feature, system.contacts[i].directions.transpose() * lambda});
      for (const auto& [dynamic, other] : {std::pair(c.body_a, c.body_b), std::pair(c.body_b, c.body_a)})
        if (bodies_[other].kind == BodyKind::scripted) supports.emplace_back(dynamic, other);
      const double mu = system.contacts[i].friction;
      s.contacts.push_back({c, attach_point(bodies_[c.body_a], c.triangle_a, c.point_a), attach_point(bodies_[c.body_b], c.triangle_b, c.point_b), c.normal,
                            lambda, mu, state_of(lambda, mu), static_cast<int>(g)});
      if (c.normal_owner >= 0) s.contacts.back().local_normal = bodies_[c.normal_owner].pose.rotation.transpose() * c.normal;
    }
  }
  s.cache.assign(std::move(solved));

  // 11 integrate
  const StageTimer timer(times.integrate_ms);
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    RigidBody& body = bodies_[i];
    if (body.is_dynamic() && !body.asleep) advance_rigid(body, h);
    if (!body.soft) continue;
    s.integrator->advance(body.soft->fem, s.soft[i]->step, s.soft[i]->step.v_star);
    if (soft_push[i].size() == 0) continue;
    VecX displacement = VecX::Zero(body.soft->fem.position.size());
    body.soft->fem.scatter_free(soft_push[i], displacement);
    body.soft->fem.position += displacement;
  }
  for (const CollisionGroup& group : s.groups) {
    // a displacement changes x × p: where a group is free of the rest of the world, its spin takes the difference, so that
    // recovery from overlap keeps angular momentum too
    const bool closed = std::all_of(group.contacts.begin(), group.contacts.end(), [&](int c) {
      return bodies_[s.detection.collisions[c].body_a].is_dynamic() && bodies_[s.detection.collisions[c].body_b].is_dynamic();
    });
    double mass = 0.0;
    Vec3 mean = Vec3::Zero();
    for (int b : group.bodies) mass += bodies_[b].mass, mean += bodies_[b].mass * bodies_[b].velocity;
    mean /= mass;
    for (int b : group.bodies) {
      if (push[b].linear.isZero(0.0) && push[b].angular.isZero(0.0)) continue;
      displace_rigid(bodies_[b], push[b].linear, push[b].angular);
      if (closed) bodies_[b].angular_momentum -= push[b].linear.cross(bodies_[b].mass * (bodies_[b].velocity - mean));
    }
  }
  time_ += h;
  place_scripted(bodies_, time_);
  std::vector<int> group_of(bodies_.size(), -1);
  for (std::size_t g = 0; g < s.groups.size(); ++g)
    for (int b : s.groups[g].bodies) group_of[b] = static_cast<int>(g);
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (!bodies_[i].has_freedom() || bodies_[i].asleep) continue;
    check_finite(bodies_[i], frame_, group_of[i]);
    bodies_[i].update_world_vertices();
  }
  if (parameters.simulation.sleeping)
    s.sleeping.update(bodies_, s.groups, supports, parameters.simulation.sleep_speed, parameters.simulation.sleep_time, h);
}

void World::free_soft_velocity(double h) {
  Stages& s = *stages_;
  s.soft.resize(bodies_.size());
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (!bodies_[i].soft) continue;
    SoftBody& soft = *bodies_[i].soft;
    if (!s.soft[i]) {
      s.soft[i] = std::make_unique<SoftStep>();
      s.soft[i]->iterative = make_linear_solver(s.linear_solver_name, soft.fem.dofs(), 1);
      s.soft[i]->direct = make_linear_solver(s.linear_solver_name, soft.fem.dofs(), 100);
      s.soft[i]->iterative->analyze(*soft.fem.free_pattern());
      s.soft[i]->direct->analyze(*soft.fem.free_pattern());
    }
    SoftStep& step = *s.soft[i];
    step.velocity_before = soft.fem.velocity;
    s.integrator->begin(soft.fem, parameters.simulation.gravity, h, step.step);
    s.integrator->free_velocity(soft.fem, step.step, *step.iterative);
    if (step.step.linear_status == SolveStatus::not_finite || step.step.linear_status == SolveStatus::not_positive_definite)
      throw DivergenceError(fmt::format("frame {}, body '{}': its system matrix is {}; use more sub-steps or a softer material", frame_, bodies_[i].name,
                                        step.step.linear_status == SolveStatus::not_finite ? "not finite" : "not positive definite"));
    step.displacement_velocity = (step.step.s * with_held(soft.fem, step.step.v_star) + step.step.offset) / h;
    interpolate(soft.embedding, soft.fem.fem.rest(), step.displacement_velocity, soft.surface_velocity);
  }
}

void World::detect(double h) {
  Stages& s = *stages_;
  for (;;) {
    s.detection.run(bodies_, parameters, h, s.frame_stats.times);
    std::vector<char> was_asleep;
    for (const RigidBody& body : bodies_) was_asleep.push_back(body.asleep);
    if (!s.sleeping.wake_touched(bodies_, s.detection.collisions)) return;
    for (std::size_t i = 0; i < bodies_.size(); ++i)  // the woken fall freely like all others in this sub-step
      if (was_asleep[i] && !bodies_[i].asleep)
        apply_gravity(bodies_[i], parameters.simulation.gravity, h);
  }
}

void World::parameters_changed() {
  stages_->select(parameters);
  // only what the model reads counts: a change of the view must not wake a sleeper, or pictures would change states
  ByteWriter settings;
  ParameterSet rows;
  parameters.bind(rows);
  for (const Parameter& row : rows.all()) settings.put(hash_bytes(format_value(row.get())));
  for (const RigidBody& body : bodies_) settings.put(body.friction), settings.put(body.restitution), settings.put(body.mass);
  const std::uint64_t hash = hash_bytes(settings.bytes());
  if (hash != stages_->settings_seen) stages_->sleeping.wake_all(bodies_);
  stages_->settings_seen = hash;
}

}  // namespace impinge
