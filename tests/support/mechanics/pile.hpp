// A heap of boxes between four walls: 0.5 m, 1 kg, on a lattice of 10 x 10 in layers, each shifted and turned a little.
#pragma once

#include "tests/support/mechanics/worlds.hpp"
#include "tests/support/random.hpp"

namespace impinge::test {

inline void add_pile(World& world, Random& random, int boxes) {
  for (int k = 0; k < boxes; ++k) {
    const Vec3 at =
        Vec3(0.6 * (k % 10) - 2.7, 0.6 * (k / 100) + 0.35, 0.6 * (k / 10 % 10) - 2.7) + 0.02 * random.vector();
    BodyDescription box = cube("box" + std::to_string(k), 0.5, at);
    box.mass = 1.0;
    box.rotation = 16.5 * random.vector();  // degrees: about half a radian in all
    world.add_body(box);
  }
  world.add_body(fixed_plane("left", Vec3::UnitX(), -3.2));
  world.add_body(fixed_plane("right", -Vec3::UnitX(), -3.2));
  world.add_body(fixed_plane("back", Vec3::UnitZ(), -3.2));
  world.add_body(fixed_plane("front", -Vec3::UnitZ(), -3.2));
}

}  // namespace impinge::test
