// A ball, a rod and a box come to rest on a thin plate of bad triangles, from a tenth of a millimetre to kilometres, near the
// origin and far from it: their heights are known.
#include <catch2/catch.hpp>

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/support/program/program.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// A square of 8 sizes: in strips of 1 : 1,000, each triangle with corners of its own and one without area, or with corners on
/// edges of others.
std::string bad_plate(int kind, double size) {
  const double half = 4.0 * size;
  std::string corners, faces;
  int count = 0;
  const auto corner = [&](double x, double z) {
    corners += fmt::format("v {:.17g} 0 {:.17g}\n", half * x, half * z);
    return ++count;
  };
  const auto face = [&](int a, int b, int c) { faces += fmt::format("f {} {} {}\n", a, b, c); };
  if (kind == 0) {
    constexpr int kStrips = 1000;
    for (int i = 0; i <= kStrips; ++i) {
      const double x = 2.0 * i / kStrips - 1.0;
      const int a = corner(x, -1.0), b = corner(x, 1.0);
      if (i > 0) face(a - 2, b - 2, a), face(b - 2, b, a);
    }
  } else if (kind == 1) {
    for (const double x : {-1.0, -0.5, 0.0, 0.5})
      for (const double z : {-1.0, -0.5, 0.0, 0.5}) {
        face(corner(x, z), corner(x, z + 0.5), corner(x + 0.5, z));
        face(corner(x, z + 0.5), corner(x + 0.5, z + 0.5), corner(x + 0.5, z));
      }
    face(corner(0.0, 0.0), corner(0.0, 0.0), corner(0.5, 0.0));
  } else {
    for (const auto& [x, z] : {std::pair(-1, -1), {1, -1}, {1, 1}, {-1, 1}, {0, 0}, {0, -1}}) corner(x, z);
    face(1, 4, 5), face(4, 3, 5), face(1, 5, 6), face(6, 5, 2), face(5, 3, 2);
    // the side from corner 2 to 3 has another plate's corner in its middle
    face(2, 3, corner(1.5, 0.0));
  }
  return corners + faces;
}

/// Of the last line, by the name in the first.
double last_of(const std::filesystem::path& csv, const std::string& name) {
  std::ifstream in(csv);
  std::string line, head, last;
  std::getline(in, head);
  while (std::getline(in, line)) last = line;
  std::istringstream names(head), values(last);
  std::string value;
  while (std::getline(names, line, ',') && std::getline(values, value, ','))
    if (line == name) return std::stod(value);
  return NAN;
}

}  // namespace

TEST_CASE("bodies of any size come to rest on thin plates of bad triangles, near the origin and far from it") {
  const TempFolder folder;
  int number = 0;
  for (const double size : {1e-4, 1e-2, 1.0, 1e2, 5e3})
    for (const double far : {0.0, 1e5}) {
      const int kind = number++ % 3;
      const double gravity = std::min(1e4, 10.0 * size), thickness = std::min(1e-3, 0.3 * size), z = 0.01 * size;
      folder.write("plate.obj", bad_plate(kind, size));
      std::string scene = fmt::format(R"([simulation]
gravity = [0, {}, 0]
[[body]]
name = "plate"
kind = "static"
surface = "plate.obj"
sides = "both"
thickness = {}
position = [{}, 0, {}]
)",
                                      -gravity, thickness, far, far);
      const auto add = [&](const char* name, const std::string& shape, double x) {
        scene += fmt::format(R"([[body]]
name = "{}"
kind = "dynamic"
shape = {}
material = {{ density = 1000 }}
position = [{}, {}, {}]
)",
                             name, shape, far + x * size, 0.55 * size + thickness, far + z);
      };
      add("ball", fmt::format("{{ sphere = {{ radius = {} }} }}", 0.5 * size), -2.0);
      add("rod", fmt::format("{{ capsule = {{ radius = {}, length = {} }} }}", 0.25 * size, 0.5 * size), 0.013);
      add("box", fmt::format("{{ box = {{ size = [{0}, {0}, {0}] }} }}", size), 2.0);
      folder.write("s.toml", scene);
      const std::string out = fmt::format("out{}", number);
      const Outcome ran =
          impinge_run(folder.path(), {"run", "s.toml", "--frames", "40", "--no-images", "--judge", "--out", out});
      CAPTURE(size, far, kind, ran.out, ran.err);
      REQUIRE(ran.code == 0);
      CHECK(ran.out.find("nothing passed, nothing overlaps") != std::string::npos);
      const double volume = M_PI * (4.0 / 3.0 * 0.125 + 0.0625 * 0.5 + 4.0 / 3.0 * 0.015625) + 1.0;
      const double weight = 1000.0 * volume * size * size * size * gravity,
                   height = last_of(folder.path() / out / "stats.csv", "potential_J") / weight;
      CHECK(std::abs(height - 0.5 * size - 0.5 * thickness) < 1e-4 * size);
    }
}
