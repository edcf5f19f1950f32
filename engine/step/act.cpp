#include "engine/step/act.hpp"

#include <map>
#include <set>

#include "engine/contact/contact_cache.hpp"
#include "engine/core/error.hpp"
#include "engine/geometry/rotation.hpp"
#include "engine/step/sleeping.hpp"

namespace impinge {
namespace {

/// Wakes what rests on it, and forgets its impulses.
void leave_contacts(BodyIndex body, Bodies& bodies, Sleeping& sleeping, ContactCache& cache) {
  std::vector<ContactCache::Item> others;
  std::vector<BodyIndex> touching;
  const std::vector<ContactCache::Item> items = cache.items();
  for (const ContactCache::Item& item : items) {
    if (item.key.body_a != body && item.key.body_b != body) {
      others.push_back(item);
      continue;
    }
    const BodyIndex other = item.key.body_a == body ? item.key.body_b : item.key.body_a;
    if (!other.is_none() && bodies[other].asleep) touching.push_back(other);
  }
  cache.assign(std::move(others));
  for (const BodyIndex other : touching) sleeping.wake(bodies, other);
}

/// What goes on to act for the half of a sub-step by which velocities lag (Body::lag) is what acted before. Where that
/// ends, bodies go on from the velocities that they show: this one, and all that hangs together with it.
void catch_up(BodyIndex first, Bodies& bodies, const ContactCache& cache) {
  bool lags = false;
  for (const Body& body : bodies) lags |= body.lag != 0.0;
  if (!lags) return;
  std::map<BodyIndex, std::vector<BodyIndex>> touching;
  for (const ContactCache::Item& item : cache.items())
    touching[item.key.body_a].push_back(item.key.body_b), touching[item.key.body_b].push_back(item.key.body_a);
  std::vector<BodyIndex> open = {first};
  std::set<BodyIndex> known = {first};
  while (!open.empty()) {
    const BodyIndex at = open.back();
    open.pop_back();
    bodies[at].catch_up();
    for (const BodyIndex other : touching[at])
      if (!other.is_none() && bodies[other].has_freedom() && known.insert(other).second) open.push_back(other);
  }
}

}  // namespace

Mat3 turn_of(const Act& act) {
  const double length = act.axis.norm();
  return length == 0.0 ? Mat3(Mat3::Identity()) : rotation_exp(act.degrees * M_PI / 180.0 / length * act.axis);
}

void act_on(Bodies& bodies, const Act& act, double frame_time, Sleeping& sleeping, ContactCache& cache) {
  const BodyIndex index = bodies.find(act.body);
  IMPINGE_ASSERT(!index.is_none());
  Body& body = bodies[index];
  if (body.deleted) return;
  sleeping.wake(bodies, index);
  if (act.verb != Act::push) catch_up(index, bodies, cache);
  switch (act.verb) {
    case Act::pull: {
      const double stiffness = act.stiffness > 0.0 ? act.stiffness : default_stiffness(body.mass, frame_time);
      body.pull = Pull{body.own_point(*act.point), act.vector, stiffness, critical_damping(stiffness, body.mass)};
      break;
    }
    case Act::release:
      body.pull.reset();
      break;
    case Act::push:
      body.push(act.vector, act.point);
      break;
    case Act::move:
      leave_contacts(index, bodies, sleeping, cache);
      body.shift(act.vector, turn_of(act));
      body.update_world_vertices();
      break;
    case Act::remove:
      leave_contacts(index, bodies, sleeping, cache);
      body.pull.reset();
      body.come_to_rest();
      body.deleted = true;
      break;
    case Act::add:
      throw InternalError("a body that is there is added");
  }
}

}  // namespace impinge
