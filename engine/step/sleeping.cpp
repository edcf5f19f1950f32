#include "engine/step/sleeping.hpp"

#include <algorithm>

#include "engine/bodies/scale.hpp"
#include "engine/core/archive.hpp"

namespace impinge {

void Sleeping::update(Bodies& bodies, std::span<const CollisionGroup> groups, std::span<const BodyEnds> supports,
                      std::span<const double> pushed, const RestThresholds& rest, double time_step) {
  for (const BodyIndex b : bodies.active()) {
    Body& body = bodies[b];
    if (!body.has_freedom() || body.asleep) continue;
    const double slow = rest.speed.at(speed_scale(rest.gravity, body.size));
    const double fastest = std::max(body.fastest_point(), pushed[static_cast<std::size_t>(b.value())]);
    body.rest_time = fastest <= slow && !body.pull ? body.rest_time + time_step : 0.0;
  }
  for (const CollisionGroup& group : groups) {
    if (group.contacts.empty()) continue;
    if (!std::all_of(group.bodies.begin(), group.bodies.end(), [&](BodyIndex b) {
          return bodies[b].rest_time >= rest.time.at(time_scale(rest.gravity, bodies[b].size));
        }))
      continue;
    const BodyIndex island = group.bodies.front();
    for (BodyIndex b : group.bodies) {
      bodies[b].asleep = true;
      bodies[b].island = island;
      bodies[b].come_to_rest();
      for (const auto& [dynamic, scripted] : supports)
        if (dynamic == b) supports_.emplace_back(island, scripted);
    }
  }
}

std::vector<BodyIndex> Sleeping::wake_islands(Bodies& bodies, const std::set<BodyIndex>& islands) {
  std::vector<BodyIndex> woken;
  if (islands.empty()) return woken;
  for (BodyIndex b = *islands.begin(); b < bodies.size(); ++b) {  // its lowest body gives an island its name
    Body& body = bodies[b];
    if (!body.asleep || !islands.contains(body.island)) continue;
    body.asleep = false;
    body.island = {};
    body.rest_time = 0.0;
    woken.push_back(b);
  }
  bodies.activate(woken);
  return woken;
}

void Sleeping::wake(Bodies& bodies, BodyIndex body) {
  bodies[body].rest_time = 0.0;
  wake_touched(bodies, std::array{BodyEnds(body, body)});
}

std::vector<BodyIndex> Sleeping::wake_touched(Bodies& bodies, std::span<const BodyEnds> touching) {
  std::set<BodyIndex> islands;
  for (const auto& [first, second] : touching)
    for (const BodyIndex b : {first, second})
      if (!b.is_none() && bodies[b].asleep) islands.insert(bodies[b].island);
  std::erase_if(supports_, [&](const auto& s) { return islands.contains(s.first); });
  return wake_islands(bodies, islands);
}

std::vector<BodyIndex> Sleeping::wake_moved_supports(Bodies& bodies) {
  std::set<BodyIndex> islands;
  for (const auto& [island, scripted] : supports_)
    if (bodies[scripted].is_moving()) islands.insert(island);
  std::vector<BodyIndex> woken = wake_islands(bodies, islands);
  if (!woken.empty()) std::erase_if(supports_, [&](const auto& s) { return !bodies[s.first].asleep; });
  return woken;
}

void Sleeping::wake_all(Bodies& bodies) {
  bodies.activate_all();
  for (Body& body : bodies) {
    body.asleep = false;
    body.island = {};
    body.rest_time = 0.0;
  }
  supports_.clear();
}

void Sleeping::save(ByteWriter& out) const {
  out.put<std::uint64_t>(supports_.size());
  for (const auto& [island, body] : supports_) out.put(island.value()), out.put(body.value());
}

void Sleeping::restore(ByteReader& in) {
  supports_.clear();
  for (std::uint64_t n = in.get<std::uint64_t>(); n > 0; --n) {
    const BodyIndex island(in.get<int>());
    supports_.emplace_back(island, BodyIndex(in.get<int>()));
  }
}

}  // namespace impinge
