#include "viewer/notes/energy_rise.hpp"

#include <algorithm>

namespace impinge {
namespace {

constexpr double kTooMuch = 0.1;  // of what there was

}  // namespace

std::optional<EnergyRise> find_energy_rise(std::span<const FrameEnergy> frames, double least) {
  std::optional<EnergyRise> found;
  double motion = 0.0, released = 0.0;
  for (const FrameEnergy& now : frames) {
    released = std::max(released, frames.front().potential - now.potential);
    const double rise = now.total() - frames.front().total(), had = least + std::max(motion, released);
    if (&now != &frames.front() && rise > kTooMuch * had) {
      if (!found) found = {now.frame, now.frame, rise, had};
      if (rise > found->rise) found->worst = now.frame, found->rise = rise, found->had = had;
    }
    if (!found) motion = std::max(motion, now.kinetic + now.elastic);
  }
  return found;
}

}  // namespace impinge
