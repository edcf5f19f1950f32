// Scenes whose frames take long, each in a place of its own: the solver, the detection, factorizations of a library.
#pragma once

#include <fmt/format.h>

#include <string>

#include "tests/support/random.hpp"

namespace impinge::test {

/// Boxes of 0.3 m dropped into each other: each of some `boxes`² / 4 pairs overlaps. 200 of them take minutes a frame,
/// in the sweeps over a hundred thousand contacts.
inline std::string overlapping_boxes(int boxes) {
  Random random(1);
  std::string text = R"([simulation]
substeps = 4
[contact]
friction = 0.5
[[body]]
name = "floor"
kind = "static"
shape = { plane = { normal = [0, 1, 0], offset = 0 } }
)";
  for (int i = 0; i < boxes; ++i) {
    const Vec3 p(random.in(-0.1, 0.1), random.in(0.3, 0.4), random.in(-0.1, 0.1)),
        r(random.in(0, 360), random.in(0, 360), random.in(0, 360));
    text += fmt::format(
        "[[body]]\nname = \"b{}\"\nkind = \"dynamic\"\nshape = {{ box = {{ size = [0.3, 0.3, 0.3] }} }}\n"
        "position = [{}, {}, {}]\nrotation = [{}, {}, {}]\n",
        i, p.x(), p.y(), p.z(), r.x(), r.y(), r.z());
  }
  return text;
}

/// A soft ball whose fine surface is held against itself with a long reach: hundreds of thousands of triangle pairs.
inline std::string self_contact(int cells) {
  return fmt::format(R"([simulation]
substeps = 2
[contact]
activation_distance = 0.1
[[body]]
name = "floor"
kind = "static"
shape = {{ plane = {{ normal = [0, 1, 0], offset = 0 }} }}
[[body]]
name = "ball"
kind = "deformable"
self_collision = true
shape = {{ sphere = {{ radius = 0.5 }} }}
volume = {{ cage = {{ cells = {} }} }}
material = {{ young = 1e5, poisson = 0.4, density = 1000, damping = [0, 0.01] }}
position = [0, 0.5, 0]
)",
                     cells);
}

/// A soft block that lies on a floor, by factorization; 30 cells: 90,000 unknowns and half a minute a frame.
inline std::string soft_block(int cells) {
  return fmt::format(R"([simulation]
substeps = 2
[response]
method = "constraint_anticipation"
[[body]]
name = "floor"
kind = "static"
shape = {{ plane = {{ normal = [0, 1, 0], offset = 0 }} }}
[[body]]
name = "block"
kind = "deformable"
shape = {{ box = {{ size = [1, 1, 1] }} }}
volume = {{ lattice = {{ cells = {} }} }}
material = {{ young = 1e6, poisson = 0.4, density = 1000, damping = [0, 0.01] }}
position = [0, 0.5, 0]
)",
                     cells);
}

}  // namespace impinge::test
