// A strip of rubber whose end is turned until it is wound up, as a scene file.
#pragma once

#include <fmt/format.h>

#include <string>

namespace impinge::test {

/// Held at one end, the other turned by `turns` within a second, in frames of 20 ms.
inline std::string twisted_strip(double turns) {
  return fmt::format(R"([simulation]
gravity = [0, 0, 0]
frame_time = 0.02
[contact]
friction = 0
[[body]]
name = "strip"
kind = "deformable"
shape = {{ box = {{ size = [0.4, 0.01, 0.08] }} }}
volume = {{ lattice = {{ cells = 16 }} }}
material = {{ model = "neo_hookean", young = 2e4, poisson = 0.4, density = 1000, damping = [0, 0.005] }}
self_collision = true
fixed = [
  {{ box = {{ min = [-0.21, -1, -1], max = [-0.19, 1, 1] }} }},
  {{ box = {{ min = [0.19, -1, -1], max = [0.21, 1, 1] }}, motion = [ {{ time = 0 }}, {{ time = 1, rotation = [{}, 0, 0] }} ] }},
]
)",
                     360.0 * turns);
}

}  // namespace impinge::test
