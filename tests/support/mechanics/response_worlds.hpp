// What tests that ask every response the same question share.
#pragma once

#include "engine/response/response.hpp"
#include "tests/support/mechanics/worlds.hpp"

namespace impinge::test {

inline constexpr double kGravity = 9.81;  ///< m/s², the default scene's

/// Whether loads are carried by overlap, friction is not Coulomb's own, or what is left depends on work that is fixed
/// beforehand.
inline bool regularised(std::string_view name) { return find_entry(responses(), name)->make()->is_approximate(); }

/// What positions are moved in, s: the sub-step, or the solver step of a response that has shorter ones of its own.
inline double moving_step(World& world, std::string_view response) {
  const double h = world.parameters.simulation.time_step();
  if (response != "quick") return h;
  ParameterSet rows;
  world.parameters.bind(rows);
  return h / std::stod(format_value(rows.find("response.quick.steps")->get()));
}

inline void use(World& world, std::string_view response) {
  world.parameters.response.method = response;
  world.parameters.simulation.sleeping = false;
}

}  // namespace impinge::test
