#include "engine/world/sleeping.hpp"

#include <algorithm>

#include "engine/core/archive.hpp"

namespace impinge {

void Sleeping::update(std::span<RigidBody> bodies, std::span<const CollisionGroup> groups,
                      std::span<const std::pair<int, int>> supports, double speed, double time, double time_step) {
  for (RigidBody& body : bodies) {
    if (!body.has_freedom() || body.asleep) continue;
    const double fastest =
        body.soft ? body.soft->fastest_node() : body.velocity.norm() + body.angular_velocity().norm() * body.radius;
    body.rest_time = fastest <= speed ? body.rest_time + time_step : 0.0;
  }
  for (const CollisionGroup& group : groups) {
    if (group.contacts.empty()) continue;
    if (!std::all_of(group.bodies.begin(), group.bodies.end(), [&](int b) { return bodies[b].rest_time >= time; }))
      continue;
    const int island = group.bodies.front();
    for (int b : group.bodies) {
      bodies[b].asleep = true;
      bodies[b].island = island;
      bodies[b].velocity.setZero();
      bodies[b].angular_momentum.setZero();
      if (bodies[b].soft) bodies[b].soft->fem.velocity.setZero();
      for (const auto& [dynamic, scripted] : supports)
        if (dynamic == b) supports_.emplace_back(island, scripted);
    }
  }
}

bool Sleeping::wake_island(std::span<RigidBody> bodies, int island) {
  bool woke = false;
  for (RigidBody& body : bodies) {
    if (!body.asleep || body.island != island) continue;
    body.asleep = false;
    body.island = -1;
    body.rest_time = 0.0;
    woke = true;
  }
  return woke;
}

bool Sleeping::wake_touched(std::span<RigidBody> bodies, std::span<const std::pair<int, int>> touching) {
  bool woke = false;
  for (const auto& [first, second] : touching)
    for (int b : {first, second})
      if (b >= 0 && bodies[b].asleep) {
        const int island = bodies[b].island;
        woke = wake_island(bodies, island) || woke;
        std::erase_if(supports_, [&](const auto& s) { return s.first == island; });
      }
  return woke;
}

bool Sleeping::wake_moved_supports(std::span<RigidBody> bodies) {
  bool woke = false;
  for (const auto& [island, scripted] : supports_)
    if (!bodies[scripted].velocity.isZero(0.0) || !bodies[scripted].scripted_angular_velocity.isZero(0.0))
      woke = wake_island(bodies, island) || woke;
  if (woke) std::erase_if(supports_, [&](const auto& s) { return !bodies[s.first].asleep; });
  return woke;
}

void Sleeping::wake_all(std::span<RigidBody> bodies) {
  for (RigidBody& body : bodies) {
    body.asleep = false;
    body.island = -1;
    body.rest_time = 0.0;
  }
  supports_.clear();
}

void Sleeping::save(ByteWriter& out) const {
  out.put<std::uint64_t>(supports_.size());
  for (const auto& [island, body] : supports_) out.put(island), out.put(body);
}

void Sleeping::restore(ByteReader& in) {
  supports_.clear();
  for (std::uint64_t n = in.get<std::uint64_t>(); n > 0; --n) {
    const int island = in.get<int>();
    supports_.emplace_back(island, in.get<int>());
  }
}

}  // namespace impinge
