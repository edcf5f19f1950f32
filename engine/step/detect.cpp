#include "engine/step/detect.hpp"

#include <algorithm>
#include <set>

#include "engine/core/interrupt.hpp"
#include "engine/shapes/primitives.hpp"
#include "engine/shapes/surface_of_revolution.hpp"
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

/// In pair order.
void sort_by_pair(std::vector<Collision>& collisions) {
  std::stable_sort(collisions.begin(), collisions.end(), [](const Collision& l, const Collision& r) {
    return std::pair(l.body_a, l.body_b) < std::pair(r.body_a, r.body_b);
  });
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
  sort_by_pair(collisions);
}

/// By body: whether somebody touches it who keeps it from flying freely, by contacts that count. What is round about an axis may
/// touch what can't move, which holds it until then (GroupSolve::solve_before_meeting); of others that do new places come round
/// in a turn, which only looks at the end find.
template <class Counts>
std::vector<char> held_bodies(const Bodies& bodies, const std::vector<Collision>& collisions, Counts&& counts) {
  std::vector<char> held(static_cast<std::size_t>(bodies.size().value()), 0);
  const auto hold = [&](BodyIndex own, BodyIndex other) {
    if (bodies[other].has_freedom() || round_solid(*bodies[own].shape) == nullptr) held[own] = 1;
  };
  for (const Collision& c : collisions)
    if (counts(c)) hold(c.body_a, c.body_b), hold(c.body_b, c.body_a);
  return held;
}

bool is_of_any(const Collision& c, const std::vector<BodyPair>& sorted) {
  return std::binary_search(sorted.begin(), sorted.end(), BodyPair{c.body_a, c.body_b});
}

/// Of two that approach and touch nobody else, those where they meet take the place of those that planes between them would
/// make at the start: impulses can wait until then without anybody noticing (step/late_impacts).
void follow_flights(const Bodies& bodies, std::span<const Attachment> attachments, const Detecting& by,
                    const std::vector<Approach>& approaches, SubStep& step) {
  step.before_flights.clear();
  if (approaches.empty()) return;
  std::vector<BodyPair> pairs;
  std::vector<int> count(step.colliders.size(), 0);  // by body: whom it comes upon, and what it hangs on
  for (const Approach& approach : approaches) {
    pairs.push_back(approach.pair);
    ++count[approach.pair.a], ++count[approach.pair.b];
  }
  for (const Attachment& a : attachments)
    for (const BodyIndex b : {a.a.body, a.b.body})
      if (!b.is_none()) ++count[b];
  const std::vector<char> held =
      held_bodies(bodies, step.collisions, [&](const Collision& c) { return !is_of_any(c, pairs); });
  const auto is_alone = [&](BodyIndex b) { return !bodies[b].has_freedom() || (count[b] == 1 && held[b] == 0); };
  const auto was_asked = [&](const BodyPair& pair) {
    const auto is_of = [&](const Collision& c) { return c.body_a == pair.a && c.body_b == pair.b; };
    return std::any_of(step.asked.begin(), step.asked.end(), is_of) ||
           std::any_of(step.brought.begin(), step.brought.end(), is_of);
  };
  std::vector<Collision> met;
  std::vector<BodyPair> changed;
  for (const Approach& approach : approaches) {
    const auto& [a, b, margin] = approach.pair;
    if (!is_alone(a) || !is_alone(b) || was_asked(approach.pair)) continue;
    const std::vector<Collision> found = collisions_of(approach, step.colliders, by, step.time_step);
    if (found.empty()) continue;
    met.insert(met.end(), found.begin(), found.end());
    changed.push_back(approach.pair);
  }
  if (met.empty()) return;
  std::erase_if(step.collisions, [&](const Collision& c) {
    if (!is_of_any(c, changed)) return false;
    step.before_flights.push_back(c);
    return true;
  });
  step.collisions.insert(step.collisions.end(), met.begin(), met.end());
  sort_by_pair(step.collisions);
}

}  // namespace

void detect(Bodies& bodies, std::span<const Attachment> attachments, const Detecting& by, const TimeIntegration& how,
            Sleeping& sleeping, SubStep& step, StageTimes& times) {
  std::vector<Approach> approaches;
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
      find_collisions(step.colliders, step.pairs, by, step.time_step, step.triangle_pairs, step.collisions,
                      by.follows_flights ? &approaches : nullptr);
      add_asked(step.brought, step.collisions);
      add_asked(step.asked, step.collisions);
      follow_flights(bodies, attachments, by, approaches, step);
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

void end_flights(const Bodies& bodies, SubStep& step) {
  const auto is_flight = [](const Collision& c) { return c.meeting != nullptr; };
  if (std::none_of(step.collisions.begin(), step.collisions.end(), is_flight)) return;
  const std::vector<char> held =
      held_bodies(bodies, step.collisions, [&](const Collision& c) { return !is_flight(c); });
  std::vector<BodyPair> others;  // sorted: that touch in other places
  for (const Collision& c : step.collisions)
    if (!is_flight(c)) others.push_back({c.body_a, c.body_b});
  std::vector<BodyPair> ended;
  std::erase_if(step.collisions, [&](const Collision& c) {
    if (!is_flight(c) || (held[c.body_a] == 0 && held[c.body_b] == 0 && !is_of_any(c, others))) return false;
    if (!is_of_any(c, ended)) ended.push_back({c.body_a, c.body_b});
    return true;
  });
  if (ended.empty()) return;
  std::copy_if(step.before_flights.begin(), step.before_flights.end(), std::back_inserter(step.collisions),
               [&](const Collision& c) { return is_of_any(c, ended); });
  sort_by_pair(step.collisions);
}

}  // namespace impinge
