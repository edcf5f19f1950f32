// Bodies that slide, for tests: what slides where, and what is measured of it.
#pragma once

#include "tests/support/mechanics/worlds.hpp"

namespace impinge::test {

inline const Vec3 kDown(0, -kGravity, 0);

inline AttachmentDescription slide(AttachmentKind kind, const std::string& a, const std::string& b, const Vec3& point,
                                   const Vec3& axis = Vec3::Zero()) {
  return {"slide", a, b, point, kind, axis, false};
}

/// Without contacts, sleep or gravity of its own.
inline void prepare_slides(World& world, const Vec3& gravity, int substeps = 4) {
  world.parameters.simulation.gravity = gravity;
  world.parameters.simulation.substeps = substeps;
  world.parameters.simulation.sleeping = false;
}

inline const AttachmentRecord& link_of(const World& world, std::size_t i = 0) {
  return world.record().attachments.at(i);
}
/// Of the last sub-step, N.
inline Vec3 link_force(const World& world, std::size_t i = 0) {
  return link_of(world, i).impulse / world.parameters.simulation.time_step();
}

inline double energy_of(const World& world) {
  const FrameStats& s = world.record().stats;
  return s.kinetic + s.potential + s.elastic;
}

/// The largest error of any attachment while the world runs.
inline double run_slides(World& world, double seconds) {
  double worst = 0.0;
  const int frames = static_cast<int>(std::lround(seconds / world.parameters.simulation.frame_time));
  for (int i = 0; i < frames; ++i) {
    world.step();
    worst = std::max(worst, world.record().stats.attachment_error);
  }
  return worst;
}

}  // namespace impinge::test
