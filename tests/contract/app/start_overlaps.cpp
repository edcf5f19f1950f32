// What crosses itself, or starts in another, in the file: pushed apart or left as it is, and named by info.
#include <catch2/catch.hpp>

#include <fmt/format.h>

#include "tests/support/geometry/mesh_text.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/program/program.hpp"
#include "tests/support/program/sweep_results.hpp"
#include "tests/support/program/temp_folder.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// Two bars, the one through the other.
TriangleMesh crossed_bars() {
  TriangleMesh m = box(Vec3(0.5, 0.05, 0.05));
  const TriangleMesh other = box(Vec3(0.05, 0.3, 0.04));
  const int first = static_cast<int>(m.vertices.size());
  for (const Vec3& v : other.vertices) m.vertices.push_back(v + Vec3(0.02, 0.03, 0.01));
  for (const Triangle& t : other.triangles) m.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  return m;
}

}  // namespace

TEST_CASE("what crosses itself at rest is left out of self-collision on request") {
  const TempFolder folder;
  folder.write("bars.off", off_text(crossed_bars()));
  const auto run = [&](const std::string& name, const std::string& key) {
    folder.write(name + ".toml",
                 "[simulation]\ngravity = [0, 0, 0]\n[[body]]\nname = \"bars\"\nkind = \"deformable\"\n"
                 "surface = \"bars.off\"\nvolume = {cage = {cells = 12}}\n"
                 "material = {young = 1e5, poisson = 0.3, density = 1000}\nself_collision = true\n" +
                     key);
    const Outcome outcome =
        impinge_run(folder.path(), {"run", name + ".toml", "--frames", "5", "--no-images", "--out", name});
    CAPTURE(outcome.err);
    REQUIRE(outcome.code == 0);
    return csv_rows(folder.path() / name / "stats.csv");
  };
  const std::vector<Row> met = run("met", ""), left = run("left", "self_exempt_distance = 0.01\n");
  CHECK(std::stod(met.back().at("self_crossings")) > 0.0);
  CHECK(std::stod(met.back().at("elastic_J")) > 1e-3);  // pushed apart
  CHECK(left.back().at("self_crossings") == "0");
  CHECK(left.back().at("contacts") == "0");
  CHECK(std::stod(left.back().at("elastic_J")) < 1e-12);
}

TEST_CASE("info names what starts in one another, and surfaces that cross themselves") {
  const TempFolder folder;
  folder.write("bars.off", off_text(crossed_bars()));
  const auto info = [&](const std::string& scene) {
    folder.write("s.toml", scene);
    const Outcome outcome = impinge_run(folder.path(), {"info", "s.toml"});
    REQUIRE(outcome.code == 0);
    return outcome.out;
  };
  const std::string bars =
      "[[body]]\nname = \"bars\"\nkind = \"deformable\"\nsurface = \"bars.off\"\nvolume = {cage = {cells = 12}}\n"
      "self_collision = true\n";
  CHECK_THAT(info(bars),
             Catch::Contains("28 pairs of triangles of bodies with self_collision cross: self_exempt_distance"));
  CHECK_THAT(info(bars + "self_exempt_distance = 0\n"), !Catch::Contains("cross: self_exempt_distance"));
  const auto balls = [](double apart) {
    std::string text;
    for (const double x : {0.0, apart})
      text += fmt::format(
          "[[body]]\nname = \"at{}\"\nkind = \"dynamic\"\nshape = {{sphere = {{radius = 0.5}}}}\n"
          "material = {{density = 1}}\nposition = [{}, 0, 0]\n",
          x == 0.0 ? 0 : 1, x);
    return text;
  };
  CHECK_THAT(info(balls(0.75)), Catch::Contains("'at0' and 'at1' start 0.25 m in one another"));
  CHECK_THAT(info(balls(1.0)), !Catch::Contains("in one another"));
}
