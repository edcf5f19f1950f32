#include "engine/world/act.hpp"

#include <algorithm>

#include "engine/geometry/rotation.hpp"
#include "engine/world/world.hpp"

namespace impinge {
namespace {

Mat3 turn_of(const Act& act) {
  const double length = act.axis.norm();
  return length == 0.0 ? Mat3(Mat3::Identity()) : rotation_exp(act.degrees * M_PI / 180.0 / length * act.axis);
}

}  // namespace

void World::act(const Act& act) {
  const BodyIndex index = bodies_.find(act.body);
  IMPINGE_ASSERT(!index.is_none());
  Body& body = bodies_[index];
  if (body.deleted) return;
  was_still_ = false;
  sleeping_.wake(bodies_, index);
  switch (act.verb) {
    case Act::pull: {
      const double stiffness =
          act.stiffness > 0.0 ? act.stiffness : default_stiffness(body.mass, parameters.simulation.frame_time);
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
      leave_contacts(index);
      body.shift(act.vector, turn_of(act));
      body.update_world_vertices();
      break;
    case Act::remove:
      leave_contacts(index);
      body.pull.reset();
      body.deleted = true;
  }
}

/// Wakes what rests on it, and forgets its impulses.
void World::leave_contacts(BodyIndex body) {
  std::vector<ContactCache::Item> others;
  std::vector<BodyIndex> touching;
  for (const ContactCache::Item& item : cache_.items()) {
    if (item.key.body_a != body && item.key.body_b != body) {
      others.push_back(item);
      continue;
    }
    const BodyIndex other = item.key.body_a == body ? item.key.body_b : item.key.body_a;
    if (!other.is_none() && bodies_[other].asleep) touching.push_back(other);
  }
  cache_.assign(std::move(others));
  for (const BodyIndex other : touching) sleeping_.wake(bodies_, other);
}

}  // namespace impinge
