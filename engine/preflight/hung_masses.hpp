// What hangs on a body by attachments.
#pragma once

#include <vector>

#include "engine/world/world.hpp"

namespace impinge {

struct HungMass {
  double mass = 0.0;   ///< kg: of all that would come off if the body were not there
  double lever = 0.0;  ///< metres: how far its attached points are from one another at most
};

/// By body. A body's neighbours fall into parts without it: those that are attached to the world, or to what has no
/// freedom, hold it, or the heaviest where none is; the others hang on it.
std::vector<HungMass> hung_masses(const World& world);

}  // namespace impinge
