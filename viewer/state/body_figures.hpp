// The one table of what may be asked of bodies: words of `expect`, `break` and `find`, plots of the timeline, and
// `impinge list body_figures` are all made of it.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "engine/core/types.hpp"

namespace impinge {

enum class BodyFunction : std::uint8_t {
  contacts,
  depth,
  gap,
  force,
  speed,
  energy,
  position_x,
  position_y,
  position_z,
  velocity_x,
  velocity_y,
  velocity_z,
  energy_from
};

struct BodyFigure {
  enum Where : std::uint8_t { conditions = 1, plots = 2, everywhere = 3 };
  std::string_view name, unit;
  BodyFunction function;
  int bodies;  ///< that a condition names; a plot of two may be of one, of all that it has with others
  Where where;
  std::string_view doc;

  bool in_conditions() const { return (where & conditions) != 0; }
  bool in_plots() const { return (where & plots) != 0; }
  /// What stands between its parentheses in a condition.
  std::string_view arguments() const {
    return function == BodyFunction::energy_from ? "SOURCE or SOURCE,A" : bodies == 2 ? "A,B" : "A";
  }
};

std::span<const BodyFigure> body_figures();
const BodyFigure& info_of(BodyFunction function);

/// That part of a body's place or motion which the function asks for; not a number for another function.
double part_of_motion(BodyFunction function, const Vec3& position, const Vec3& velocity);

}  // namespace impinge
