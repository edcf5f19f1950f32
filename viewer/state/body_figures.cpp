#include "viewer/state/body_figures.hpp"

#include <algorithm>
#include <limits>

#include "engine/core/error.hpp"

namespace impinge {

namespace {

using F = BodyFunction;
using enum BodyFigure::Where;

constexpr BodyFigure kBodyFigures[] = {
    {"contacts", "", F::contacts, 2, everywhere, "Contacts of the two that were handed to the response."},
    {"depth", "m", F::depth, 2, everywhere, "How far the two overlap, 0 if they don't."},
    {"gap", "m", F::gap, 2, everywhere,
     "Smallest gap of their contacts, whose points go on with the material: where something rolls they rise, and "
     "position_* tells more. Without contacts, in conditions, how far their surfaces are apart."},
    {"force", "N", F::force, 2, everywhere, "Sum of the normal forces of their contacts, last sub-step."},
    {"speed", "m/s", F::speed, 1, everywhere, "Of the centre of mass."},
    {"energy", "J", F::energy, 1, conditions, "Kinetic, elastic and potential."},
    {"position_x", "m", F::position_x, 1, everywhere, "Where the centre of mass is, in the world."},
    {"position_y", "m", F::position_y, 1, everywhere, "Where the centre of mass is, in the world."},
    {"position_z", "m", F::position_z, 1, everywhere, "Where the centre of mass is, in the world."},
    {"velocity_x", "m/s", F::velocity_x, 1, everywhere, "Of the centre of mass."},
    {"velocity_y", "m/s", F::velocity_y, 1, everywhere, "Of the centre of mass."},
    {"velocity_z", "m/s", F::velocity_z, 1, everywhere, "Of the centre of mass."},
    {"energy_from", "J", F::energy_from, 1, everywhere,
     "What a source of the ledger did since the start of the frame, to all bodies or to one."},
};

}  // namespace

std::span<const BodyFigure> body_figures() { return kBodyFigures; }

const BodyFigure& info_of(BodyFunction function) {
  const auto* it = std::find_if(std::begin(kBodyFigures), std::end(kBodyFigures),
                                [&](const BodyFigure& figure) { return figure.function == function; });
  if (it == std::end(kBodyFigures)) throw InternalError("a figure of bodies stands in no table");
  return *it;
}

double part_of_motion(BodyFunction function, const Vec3& position, const Vec3& velocity) {
  switch (function) {
    case F::position_x:
      return position.x();
    case F::position_y:
      return position.y();
    case F::position_z:
      return position.z();
    case F::velocity_x:
      return velocity.x();
    case F::velocity_y:
      return velocity.y();
    case F::velocity_z:
      return velocity.z();
    case F::speed:
      return velocity.norm();
    default:
      return std::numeric_limits<double>::quiet_NaN();
  }
}

}  // namespace impinge
