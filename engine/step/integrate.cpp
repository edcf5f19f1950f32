#include "engine/step/integrate.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/core/error.hpp"
#include "engine/step/tasks.hpp"

namespace impinge {
namespace {

/// The velocity of the group's centre of mass if nothing but its own rigid bodies holds it, else nothing.
std::optional<Vec3> free_velocity_of(const Bodies& bodies, const CollisionGroup& group, const ContactList& contacts) {
  if (!is_free(bodies, group, contacts)) return std::nullopt;
  double mass = 0.0;
  Vec3 mean = Vec3::Zero();
  for (const BodyIndex b : group.bodies) mass += bodies[b].mass, mean += bodies[b].mass * bodies[b].twist().linear;
  return mean / mass;
}

/// Recovery from overlap; where a group is free of the rest of the world it keeps its angular momentum too. That of a flight
/// is right as it is: the impulse acted on a common point, on the way.
void displace(Bodies& bodies, const SubStep& step) {
  const ContactList contacts = step.contacts({});
  for (GroupIndex g(0); g < step.groups.size(); ++g) {
    const CollisionGroup& group = step.groups[g];
    const std::vector<BodyVector>& by = step.results[g].displacement;
    if (by.empty()) continue;
    const std::optional<Vec3> velocity =
        step.results[g].follows_flight ? std::nullopt : free_velocity_of(bodies, group, contacts);
    for (std::size_t i = 0; i < group.bodies.size(); ++i) bodies[group.bodies[i]].displace(by[i], velocity);
  }
}

/// Bodies don't know their groups.
template <class Work>
void naming_group(const SubStep& step, BodyIndex body, Work&& work) {
  try {
    work();
  } catch (const DivergenceError& error) {
    throw DivergenceError(fmt::format("group {}, {}", step.group_of(body).value(), error.what()));
  }
}

}  // namespace

bool is_free(const Bodies& bodies, const CollisionGroup& group, const ContactList& contacts) {
  const auto is_rigid = [&](BodyIndex b) { return bodies[b].kind() == BodyKind::dynamic; };
  return std::all_of(group.contacts.begin(), group.contacts.end(), [&](ContactIndex i) {
    const Collision* c = contacts.collision(i);
    return c != nullptr && is_rigid(c->body_a) && is_rigid(c->body_b);
  });
}

void change_velocities(Bodies& bodies, const SubStep& step) {
  for (GroupIndex g(0); g < step.groups.size(); ++g)
    for (std::size_t i = 0; i < step.groups[g].bodies.size(); ++i) {
      const GroupResult& result = step.results[g];
      const bool is_blow = !result.struck.empty() && result.struck[i] != 0;
      bodies[step.groups[g].bodies[i]].change_velocity(result.velocity[i], is_blow);
    }
}

void advance(Bodies& bodies, const TimeIntegration& how, const SubStep& step) {
  const double end = step.time + step.time_step;
  for_each_active(bodies, [&](BodyIndex b, Body& body) {
    if (!body.asleep && !body.deleted) naming_group(step, b, [&] { body.advance(how, end); });
  });
}

void push_out(Bodies& bodies, const SubStep& step) {
  displace(bodies, step);
  for_each_active(bodies, [&](BodyIndex b, Body& body) {
    if (!body.has_freedom() || body.asleep) return;
    naming_group(step, b, [&] { body.check_finite(); });
    body.update_world_vertices();
  });
}

}  // namespace impinge
