// A small scene with a body of every kind, and what its run wrote as truth.
#pragma once

#include <fmt/format.h>

#include "tests/support/geometry/mesh_text.hpp"
#include "tests/support/program/program.hpp"
#include "tests/support/program/temp_folder.hpp"

namespace impinge::test {

/// Two bodies of one mesh whose origin is no centre of mass, one name that USD would not take, a plane, a body that
/// never moves, a scripted one, deformable ones, an attachment, a script. `shift` moves it all along x, metres.
inline std::string export_scene(double shift = 0.0, bool soft = true) {
  const auto at = [&](double x, double y, double z) { return fmt::format("[{}, {}, {}]", x + shift, y, z); };
  std::string text = fmt::format(R"([simulation]
frame_time = 0.0166666666667
substeps = 2
[contact]
friction = 0.4
[[body]]
name = "floor"
kind = "static"
shape = {{ plane = {{ normal = [0, 1, 0], offset = 0 }} }}
[[body]]
name = "wall"
kind = "static"
shape = {{ box = {{ size = [0.2, 1, 2] }} }}
position = {}
rotation = [0, 20, 0]
[[body]]
name = "tetra-1"
kind = "dynamic"
surface = "meshes/tetra.off"
scale = 0.5
position = {}
[[body]]
name = "tetra_1"
kind = "dynamic"
surface = "meshes/tetra.off"
scale = 0.5
position = {}
rotation = [30, 10, -70]
angular_velocity = [3, 20, 1]
[[body]]
name = "ball"
kind = "dynamic"
shape = {{ sphere = {{ radius = 0.2 }} }}
position = {}
velocity = [0, -3, 0]
[[body]]
name = "paddle"
kind = "scripted"
shape = {{ capsule = {{ radius = 0.1, length = 0.5 }} }}
motion = [ {{ time = 0, position = {}, rotation = [90, 0, 0] }}, {{ time = 0.2, position = {}, rotation = [90, 200, 0] }} ]
)",
                                 at(-1.2, 0.5, 0), at(0.4, 0.05, 0.3), at(-0.4, 0.4, -0.9), at(0.65, 0.9, 0.55),
                                 at(-0.8, 0.3, 1), at(-0.2, 0.3, 1));
  if (!soft) return text;
  return text + fmt::format(R"([[body]]
name = "jelly"
kind = "deformable"
shape = {{ box = {{ size = [0.4, 0.3, 0.4] }} }}
volume = {{ lattice = {{ cells = 3 }} }}
material = {{ young = 2e4, poisson = 0.4, density = 800, damping = [0, 0.01] }}
position = {}
rotation = [0, 20, 15]
velocity = [0, -2, 0]
[[body]]
name = "drop"
kind = "deformable"
surface = "meshes/tetra.off"
scale = 0.3
volume = {{ cage = {{ cells = 3 }} }}
material = {{ young = 5e4, poisson = 0.3, density = 500 }}
position = {}
[[attachment]]
name = "joint"
body_a = "ball"
body_b = "jelly"
point = {}
)",
                            at(0.7, 0.25, -0.5), at(-0.6, 0.3, 0.2), at(0.7, 0.4, -0.5));
}

/// Makes the run in out/: what `impinge run --contacts --export ply` writes, which other tests hold to the contract.
inline Outcome export_run(const TempFolder& folder, const std::string& scene, const std::vector<std::string>& more = {},
                          int frames = 12, const std::string& formats = "ply") {
  folder.write("s.toml", scene);
  folder.write("meshes/tetra.off", off_text(tetrahedron()));
  std::vector<std::string> words = {"run",        "s.toml",   "--out", "out",        "--frames", std::to_string(frames),
                                    "--contacts", "--export", formats, "--no-images"};
  words.insert(words.end(), more.begin(), more.end());
  return impinge_run(folder.path(), words);
}

}  // namespace impinge::test
