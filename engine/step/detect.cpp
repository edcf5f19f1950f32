#include "engine/step/detect.hpp"

#include <algorithm>

#include "engine/core/interrupt.hpp"
#include "engine/step/find_collisions.hpp"
#include "engine/step/find_pairs.hpp"

namespace impinge {
namespace {

/// What collisions and moving attachments join.
std::vector<BodyEnds> touching(const Bodies& bodies, const ContactList& contacts) {
  const auto is_moving = [&](BodyIndex b) { return !b.is_none() && bodies[b].is_moving(); };
  std::vector<BodyEnds> ends;
  for (const Collision& c : contacts.collisions) ends.emplace_back(c.body_a, c.body_b);
  for (const Attachment& a : contacts.attachments)
    if (is_moving(a.a.body) || is_moving(a.b.body)) ends.emplace_back(a.a.body, a.b.body);
  return ends;
}

/// Contacts that are asked for take the place of those of the same features.
void add_asked(const std::vector<Collision>& asked, std::vector<Collision>& collisions) {
  if (asked.empty()) return;
  const auto pair_of = [](const Collision& c) { return std::pair(c.body_a, c.body_b); };
  for (const Collision& wanted : asked) {
    const auto known = std::find_if(collisions.begin(), collisions.end(), [&](const Collision& c) {
      return pair_of(c) == pair_of(wanted) && c.feature == wanted.feature;
    });
    if (known != collisions.end())
      *known = wanted;
    else
      collisions.push_back(wanted);
  }
  std::stable_sort(collisions.begin(), collisions.end(),
                   [&](const Collision& l, const Collision& r) { return pair_of(l) < pair_of(r); });
}

}  // namespace

void detect(Bodies& bodies, std::span<const Attachment> attachments, const Detecting& by, const TimeIntegration& how,
            Sleeping& sleeping, SubStep& step, StageTimes& times) {
  for (;;) {
    {
      const StageTimer timer(times.broad_ms);
      make_colliders(bodies, step.colliders);
      step.boxes.update(bodies, step.colliders, by.contact, step.time_step);
      find_pairs(bodies, step.colliders, step.boxes.by_body, by.contact, step.time_step, by.broad_phase, step.pairs);
    }
    check_interrupt();
    {
      const StageTimer timer(times.narrow_ms);
      find_collisions(step.colliders, step.pairs, by.contact, step.time_step, by.either_may_stop, by.narrow_phase,
                      step.triangle_pairs, step.collisions);
      add_asked(step.brought, step.collisions);
      add_asked(step.asked, step.collisions);
    }
    const std::vector<BodyIndex> woken = sleeping.wake_touched(bodies, touching(bodies, step.contacts(attachments)));
    if (woken.empty()) break;
    for (const BodyIndex b : woken) bodies[b].find_free_velocity(how);
  }
  if (bodies.all_active())
    step.later.clear();  // who asks for it makes it of all
  else
    step.begin_later(bodies);
}

}  // namespace impinge
