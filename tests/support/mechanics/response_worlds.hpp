// What tests that ask every response the same question share.
#pragma once

#include "engine/response/response.hpp"
#include "tests/support/mechanics/worlds.hpp"

namespace impinge::test {

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

/// Newton's cradle: five equal balls of 0.1 m along x that lose nothing, `gap` apart, of which the first flies at the others
/// from another 0.05 m away.
inline void add_cradle(World& world, double gap, double speed) {
  world.parameters.simulation.gravity.setZero();
  world.parameters.contact.restitution = 1.0;
  world.parameters.contact.friction = 0.0;
  for (int i = 0; i < 5; ++i) {
    BodyDescription ball =
        dynamic_body("ball" + std::to_string(i), Sphere{0.1}, {(0.2 + gap) * i - (i == 0 ? 0.05 : 0.0), 0, 0});
    if (i == 0) ball.velocity = Vec3(speed, 0, 0);
    world.add_body(ball);
  }
}

inline void use(World& world, std::string_view response) {
  world.parameters.response.method = response;
  world.parameters.simulation.sleeping = false;
}

}  // namespace impinge::test
