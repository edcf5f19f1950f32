// Energy that nobody gave, found in the energies of frames in which nothing from outside acts.
#pragma once

#include <optional>
#include <span>

namespace impinge {

struct FrameEnergy {
  int frame = 0;
  double kinetic = 0.0, elastic = 0.0, potential = 0.0;  ///< J
  double total() const { return kinetic + elastic + potential; }
};

struct EnergyRise {
  int first = 0, worst = 0;  ///< frames: in which it was first too much, and most
  double rise = 0.0;         ///< J, in the worst
  double had = 0.0;          ///< J: what it is measured by, there
};

/// A rise of the total above the first frame's, by more than a tenth of what there was: the largest kinetic and elastic
/// energy of the frames before it was first so, or the potential energy released so far if that is more, and `least`, J.
std::optional<EnergyRise> find_energy_rise(std::span<const FrameEnergy> frames, double least);

}  // namespace impinge
