// Stages 9 and 10 of a sub-step for one group: its system, the response, and what follows from the impulses.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/core/interrupt.hpp"
#include "engine/response/group_judge.hpp"
#include "engine/response/least_violation.hpp"
#include "engine/world/world_stages.hpp"

namespace impinge {
namespace {

constexpr std::uint64_t kAttachmentFeature = std::uint64_t{1} << 63;  // no pair of features has this bit

ContactState state_of(const Vec3& lambda, double friction) {
  if (lambda.x() <= 0.0) return ContactState::open;
  // the solver puts sliding contacts on the cone to rounding; frictionless contacts slide
  return std::hypot(lambda.y(), lambda.z()) >= friction * lambda.x() * (1.0 - 1e-9) ? ContactState::slip
                                                                                    : ContactState::stick;
}

/// Of a group that is left without an answer. A response that has one was asked by Newton iterations that have none.
UnsolvedGroups cause_of(const ResponseResult& result, bool contradicts) {
  if (contradicts) return {UnsolvedGroups::contradiction, "", 1};
  if (result.converged()) return {UnsolvedGroups::limit_met, "the Newton iterations of simulation.integrator", 1};
  if (result.ended == StopReason::iteration_cap) return {UnsolvedGroups::limit_met, std::string(result.limit), 1};
  return {result.ended == StopReason::refused ? UnsolvedGroups::refused : UnsolvedGroups::stalled, "", 1};
}

}  // namespace

ContactCache::Item World::Stages::cache_key(std::span<const Attachment> attachments, int contact) const {
  const int collisions = static_cast<int>(detection.collisions.size());
  if (contact < collisions) {
    const Collision& c = detection.collisions[contact];
    return {c.body_a, c.body_b, c.feature, Vec3::Zero()};
  }
  const Attachment& a = attachments[contact - collisions];
  return {a.a.body, a.b.body, kAttachmentFeature | static_cast<std::uint64_t>(contact - collisions), Vec3::Zero()};
}

void World::Stages::warm_start(std::span<const Attachment> attachments, const CollisionGroup& group,
                               GroupSystem& system) const {
  for (std::size_t i = 0; i < group.contacts.size(); ++i) {
    const ContactCache::Item key = cache_key(attachments, group.contacts[i]);
    const ContactRows& rows = system.contacts[i];
    Vec3 start = rows.directions * cache.find(key.body_a, key.body_b, key.feature);
    if (rows.has_one_row()) start.tail<2>().setZero();
    system.lambda[i] = rows.kind == RowKind::contact && start.x() <= 0.0 ? Vec3(Vec3::Zero()) : start;
  }
}

void World::Stages::freeze_geometry(std::span<const RigidBody> bodies, std::span<const Attachment> attachments,
                                    const CollisionGroup& group, FrozenGroup& frozen) const {
  for (const int b : group.bodies) (bodies[b].soft ? frozen.soft_bodies : frozen.rigid_bodies).push_back(b);
  const int collisions = static_cast<int>(detection.collisions.size());
  for (const int c : group.contacts) {
    const ContactCache::Item key = cache_key(attachments, c);
    if (c < collisions) {
      const Collision& at = detection.collisions[c];
      frozen.geometry.push_back(
          {at.body_a, at.body_b, at.triangle_a, at.triangle_b, at.point_a, at.point_b, key.feature});
    } else {
      const Attachment& at = attachments[c - collisions];
      frozen.geometry.push_back(
          {key.body_a, key.body_b, -1, -1, at.a.position(bodies), at.b.position(bodies), key.feature});
    }
  }
}

GroupSystem World::solve_group(CollisionGroup& group, double h) {
  Stages& s = *stages_;
  StageTimes& times = s.frame_stats.times;
  const DeformableIntegrator& integrator = *parameters.simulation.integrator;
  const Response& response = *parameters.response.method;
  const SubstepView view{bodies_,      s.before,   s.soft, s.detection.collisions,
                         attachments_, parameters, h,      integrator.is_explicit()};
  const ResponseContext context = response_context(parameters);
  std::optional<FrozenGroup> frozen;
  GroupSystem system;
  std::vector<Vec3> start;
  const auto solve = [&] {
    {
      const StageTimer timer(times.assemble_ms);
      system = make_group_system(view, group);
      if (!start.empty())
        system.lambda = start;
      else if (parameters.contact.warm_start)
        s.warm_start(attachments_, group, system);
    }
    if (s.freezing) frozen = freeze(system);  // before a later Newton iteration takes A anew
    const StageTimer timer(times.response_ms);
    const ResponseResult solved = [&] {
      try {
        return response.solve(system, *parameters.lcp.method, context);
      } catch (const DivergenceError& error) {  // a response knows neither frame nor names
        std::string names;
        for (int b : group.bodies)
          if (bodies_[b].soft) names += fmt::format("{}'{}'", names.empty() ? "" : ", ", bodies_[b].name);
        throw DivergenceError(fmt::format("frame {}, group {}, body {}: {}; use more sub-steps or a softer material",
                                          frame_, &group - s.groups.data(), names, error.what()));
      }
    }();
    s.frame_stats.lcp_iterations += solved.iterations;
    s.frame_stats.outer_iterations += solved.outer_iterations;
    return solved;
  };
  ResponseResult result = solve();

  // Newton schemes: the same contacts at each iterate, whose A and b are those of the motion that contact allows
  const NewtonSettings* newton = integrator.newton();
  bool at_root = newton == nullptr || system.soft.empty();
  for (int iteration = 0; !at_root && iteration < newton->max_iterations; ++iteration) {
    check_interrupt();
    {
      const StageTimer timer(times.assemble_ms);
      double residual = 0.0;
      int k = 0;
      for (int b : group.bodies) {
        if (!bodies_[b].soft) continue;
        const VecX v = s.soft[b]->step.v_star + system.soft_delta[k];
        residual = std::max(residual,
                            s.soft[b]->relinearize(bodies_[b], integrator, v, system.soft_impulse(k, system.lambda)));
        ++k;
      }
      at_root = residual <= newton->tolerance;
      if (at_root) break;
      for (int b : group.bodies)
        if (bodies_[b].soft) s.soft[b]->resolve(bodies_[b], frame_);
    }
    start = system.lambda;
    result = solve();
  }
  const bool contradicts = !result.converged() && !response.lives_on_overlap() && settle_contradiction(system);
  if (!result.converged() || !at_root) {
    ++s.frame_stats.unconverged;
    count_unsolved(s.frame_stats.unsolved, cause_of(result, contradicts));
  }
  if (frozen) {
    frozen->answer = {system.lambda, system.delta_velocity, system.delta_angular_velocity, system.soft_delta};
    s.freeze_geometry(bodies_, attachments_, group, *frozen);
    s.frozen->groups.push_back(std::move(*frozen));
  }

  // 12 (in part) the judge sees the group while its system stands
  const StageTimer timer(times.response_ms);
  const GroupVerdict verdict = judge_group(system);
  s.frame_stats.residual = larger(s.frame_stats.residual, verdict.residual());
  return system;
}

void World::push_out(const GroupSystem& solved, const CollisionGroup& group, double h) {
  Stages& s = *stages_;
  const auto move = [&](const std::vector<Vec3>& velocity, const std::vector<Vec3>& angular,
                        const std::vector<VecX>& nodes) {
    int rigid = 0, soft = 0;
    for (int b : group.bodies) {
      if (bodies_[b].soft) {
        s.soft_push[b] = h * nodes[soft++];
      } else {
        s.push[b] = {h * velocity[rigid], h * angular[rigid]};
        ++rigid;
      }
    }
  };
  if (!solved.position_velocity.empty()) return move(solved.position_velocity, solved.position_angular_velocity, {});
  const Response& response = *parameters.response.method;
  if (response.lives_on_overlap() || !needs_push_out(solved, parameters, h)) return;
  check_interrupt();
  const StageTimer timer(s.frame_stats.times.response_ms);
  GroupSystem recovery = make_push_out_system(solved, parameters, h);
  // positions only: a tenth of a percent of the overlap is accurate enough, the rest is seen again in the next sub-step
  ResponseContext loose = response_context(parameters);
  loose.lcp.tolerance = 1e-3;
  loose.recovers_overlap = true;
  const ResponseResult result = response.solve(recovery, *parameters.lcp.method, loose);
  s.frame_stats.lcp_iterations += result.iterations;
  s.frame_stats.outer_iterations += result.outer_iterations;
  if (!result.converged()) settle_contradiction(recovery);
  move(recovery.delta_velocity, recovery.delta_angular_velocity, recovery.soft_delta);
}

void World::take_group(const GroupSystem& system, int g) {
  Stages& s = *stages_;
  const CollisionGroup& group = s.groups[g];
  int rigid = 0, soft = 0;
  for (int b : group.bodies) {
    RigidBody& body = bodies_[b];
    if (body.soft) {
      s.soft[b]->step.v_star += system.soft_delta[soft++];
      s.soft[b]->touched = true;
      continue;
    }
    body.velocity += system.delta_velocity[rigid];
    body.angular_momentum += body.world_inertia() * system.delta_angular_velocity[rigid++];
  }
  const int collisions = static_cast<int>(s.detection.collisions.size());
  for (std::size_t i = 0; i < group.contacts.size(); ++i) {
    const Vec3& lambda = system.lambda[i];
    ContactCache::Item item = s.cache_key(attachments_, group.contacts[i]);
    item.impulse = system.contacts[i].directions.transpose() * lambda;
    if (!lambda.isZero(0.0)) s.solved.push_back(item);
    for (const auto& [dynamic, other] : {std::pair(item.body_a, item.body_b), std::pair(item.body_b, item.body_a)})
      if (other >= 0 && bodies_[other].kind == BodyKind::scripted) s.supports.emplace_back(dynamic, other);
    if (group.contacts[i] >= collisions) {
      s.attachment_impulse[group.contacts[i] - collisions] = item.impulse;
      continue;
    }
    const Collision& c = s.detection.collisions[group.contacts[i]];
    const double mu = system.contacts[i].friction;
    s.contacts.push_back({c, attach_point(bodies_[c.body_a], c.triangle_a, c.point_a),
                          attach_point(bodies_[c.body_b], c.triangle_b, c.point_b), c.normal, lambda, mu,
                          state_of(lambda, mu), g});
    if (c.normal_owner >= 0)
      s.contacts.back().local_normal = bodies_[c.normal_owner].pose.rotation.transpose() * c.normal;
  }
}

}  // namespace impinge
