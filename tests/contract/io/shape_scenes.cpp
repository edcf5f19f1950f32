// Cylinder, cone, convex hull and compound through the program: every kind of body, every file of a run, and each way
// to get a key wrong.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <sstream>

#include "engine/io/meshes/mesh_file.hpp"
#include "tests/support/geometry/mesh_text.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/program/refusal.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

namespace fs = std::filesystem;

const char* const kShapes[] = {
    "{ cylinder = { radius = 0.1, length = 0.3 } }", "{ cone = { radius = 0.12, length = 0.3 } }",
    "{ convex_hull = { points = [[0.1, 0, 0], [-0.1, 0, 0.02], [0, 0.12, 0], [0, 0, 0.15], [0, -0.05, -0.1]] } }",
    "{ convex_hull = { surface = \"ball.off\" } }",
    "{ compound = { parts = [ { shape = { cylinder = { radius = 0.05, length = 0.4 } }, rotation = [0, 0, 90] }, { "
    "shape = { sphere = { radius = 0.1 } }, position = [0.2, 0, 0] }, { shape = { convex_hull = { surface = "
    "\"ball.off\" } }, position = [-0.2, 0, 0] } ] } }"};

std::string body(const std::string& name, const std::string& kind, const std::string& shape, const Vec3& position,
                 const std::string& more = "") {
  return fmt::format(
      "[[body]]\nname = \"{}\"\nkind = \"{}\"\nshape = {}\n{}{}\n", name, kind, shape,
      kind == "scripted" ? "" : fmt::format("position = [{}, {}, {}]\n", position.x(), position.y(), position.z()),
      more);
}

/// Each shape static, scripted and falling, over a floor.
std::string scene() {
  std::string text =
      "[simulation]\nsubsteps = 4\n" + body("floor", "static", "{ plane = { normal = [0, 1, 0] } }", Vec3::Zero());
  int i = 0;
  for (const char* shape : kShapes) {
    text += body(fmt::format("rock_{}", i), "static", shape, Vec3(i, 0.15, 0), "rotation = [0, 0, 40]");
    text += body(
        fmt::format("arm_{}", i), "scripted", shape, Vec3::Zero(),
        fmt::format("motion = [ {{ time = 0, position = [{0}, 0.4, -0.6] }}, {{ time = 0.5, position = [{0}, 0.15, "
                    "-0.2], rotation = [0, 60, 0] }} ]",
                    i));
    text += body(fmt::format("stone_{}", i), "dynamic", shape, Vec3(i + 0.04, 0.6, 0.02), "rotation = [20, 0, 10]");
    ++i;
  }
  return text;
}

void write_ball(const TempFolder& folder) {
  TriangleMesh ball = icosphere(1, 0.1);
  ball.triangles.resize(ball.triangles.size() - 6);  // open: of a hull only the vertices count
  folder.write("ball.off", off_text(ball));
}

std::string where(const std::string& text, const std::string& mark) {
  const std::size_t at = text.find(mark);
  REQUIRE(at != std::string::npos);
  const auto line = std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n') + 1;
  const std::size_t begin = text.rfind('\n', at);
  return fmt::format("s.toml:{}:{}: ", line, at - (begin == std::string::npos ? 0 : begin + 1) + 1);
}

/// The scene with one body of that shape is refused at `mark`.
void check_shape_refused(const std::string& shape, const std::string& mark, const std::string& contains,
                         const std::string& kind = "dynamic", const std::string& more = "") {
  const TempFolder folder;
  write_ball(folder);
  const std::string text = body("thing", kind, shape, Vec3(0, 1, 0), more);
  folder.write("s.toml", text);
  INFO(text);
  check_refused(folder, {"run", "s.toml", "--out", "out", "--frames", "1", "--no-images"}, where(text, mark), contains);
}

}  // namespace

TEST_CASE("new shapes run as static, scripted and dynamic bodies, are judged, exported, recorded and replayed") {
  const TempFolder folder;
  write_ball(folder);
  folder.write("s.toml", scene());
  const Outcome run = impinge_run(folder.path(), {"run", "s.toml", "--out", "out", "--frames", "40", "--no-images",
                                                  "--judge", "--contacts", "--export", "ply"});
  INFO(run.err);
  REQUIRE(run.code == 0);

  std::istringstream stats(slurp(folder / "out/stats.csv"));
  std::string line, header;
  std::getline(stats, header);
  std::vector<std::string> names;
  for (std::istringstream in(header); std::getline(in, line, ',');) names.push_back(line);
  const auto judged =
      static_cast<std::size_t>(std::find(names.begin(), names.end(), "judged_penetration_m") - names.begin());
  REQUIRE(judged < names.size());
  int rows = 0;
  while (std::getline(stats, line)) {
    std::vector<std::string> cells;
    std::string cell;
    for (std::istringstream in(line); std::getline(in, cell, ',');) cells.push_back(cell);
    // the rocks reach into the floor, but what does not move is not judged
    CHECK(std::stod(cells[judged]) < 2e-3);
    ++rows;
  }
  CHECK(rows == 41);

  std::istringstream contacts(slurp(folder / "out/contacts.csv"));
  std::getline(contacts, header);
  CHECK(header.rfind("frame,body_a,body_b,triangle_a,triangle_b,", 0) == 0);
  int count = 0;
  while (std::getline(contacts, line)) {
    std::vector<std::string> cells;
    std::string cell;
    for (std::istringstream in(line); std::getline(in, cell, ',');) cells.push_back(cell);
    CHECK(cells[3] == "-1");
    CHECK(cells[4] == "-1");
    ++count;
  }
  CHECK(count > 100);
  for (int i = 0; i < 5; ++i)
    for (const char* name : {"rock", "arm", "stone"}) {
      const TriangleMesh mesh = read_mesh(folder / fmt::format("out/surfaces/000040/{}_{}.ply", name, i));
      CHECK(make_topology(mesh).is_closed());
    }
  CHECK(!fs::exists(folder / "out/surfaces/000040/floor.ply"));
  CHECK(slurp(folder / "out/run.toml").find("ball.off") != std::string::npos);

  const Outcome replay = impinge_run(folder.path(), {"replay", "out"});
  INFO(replay.err);
  CHECK(replay.code == 0);
  const Outcome info = impinge_run(folder.path(), {"info", "s.toml"});
  CHECK(info.code == 0);
  CHECK(info.out.find("3 compound, 3 cone, 6 convex_hull, 3 cylinder, 1 plane") != std::string::npos);
}

TEST_CASE("a hull of many points is written to run.toml so that it can be read again") {
  const TempFolder folder;
  Random r(5);
  std::string points;
  for (int i = 0; i < 3000; ++i) {
    const Vec3 x = 0.2 * r.direction();
    points += fmt::format("{}[{}, {}, {}]", i == 0 ? "" : ",\n", x.x(), x.y(), x.z());
  }
  folder.write("s.toml", body("rock", "dynamic", "{ convex_hull = { points = [" + points + "] } }", Vec3(0, 1, 0)));
  const Outcome run = impinge_run(folder.path(), {"run", "s.toml", "--out", "out", "--frames", "3", "--no-images"});
  INFO(run.err);
  REQUIRE(run.code == 0);
  const Outcome replay = impinge_run(folder.path(), {"replay", "out"});
  INFO(replay.err);
  CHECK(replay.code == 0);
}

TEST_CASE("cylinder, cone and hull can be deformable, a compound says why it cannot") {
  const TempFolder folder;
  write_ball(folder);
  std::string text = body("floor", "static", "{ plane = { normal = [0, 1, 0] } }", Vec3::Zero());
  for (int i = 0; i < 4; ++i)
    text += body(fmt::format("soft_{}", i), "deformable", kShapes[i], Vec3(i, 0.25, 0),
                 "volume = { cage = { cells = 4 } }\nmaterial = { young = 1e5, poisson = 0.3, density = 1000 }");
  folder.write("s.toml", text);
  const Outcome run =
      impinge_run(folder.path(), {"run", "s.toml", "--out", "out", "--frames", "12", "--no-images", "--judge"});
  INFO(run.err);
  CHECK(run.code == 0);
  check_shape_refused(kShapes[4], "{ compound", "is several solids, not one closed surface", "deformable",
                      "volume = { cage = { cells = 4 } }");
  check_shape_refused("{ plane = { normal = [0, 1, 0] } }", "{ plane", "has no bounds", "deformable",
                      "volume = { cage = { cells = 4 } }");
}

TEST_CASE("deformable bodies lie on new shapes, and new shapes on them") {
  const TempFolder folder;
  write_ball(folder);
  std::string text =
      "[simulation]\nsubsteps = 4\n" + body("floor", "static", "{ plane = { normal = [0, 1, 0] } }", Vec3::Zero());
  const char* const jelly =
      "volume = { lattice = { cells = 3 } }\nmaterial = { young = 5e4, poisson = 0.3, density = "
      "500, damping = [0, 0.01] }";
  for (int i = 0; i < 5; ++i) {
    text += body(fmt::format("jelly_{}", i), "deformable", "{ box = { size = [0.3, 0.15, 0.3] } }", Vec3(i, 0.076, 0),
                 jelly);
    text += body(fmt::format("stone_{}", i), "dynamic", kShapes[i], Vec3(i, 0.4, 0));
  }
  folder.write("s.toml", text);
  const Outcome run =
      impinge_run(folder.path(), {"run", "s.toml", "--out", "out", "--frames", "60", "--no-images", "--judge"});
  INFO(run.err);
  REQUIRE(run.code == 0);
  std::istringstream stats(slurp(folder / "out/stats.csv"));
  std::string line, header;
  std::getline(stats, header);
  std::vector<std::string> names;
  for (std::istringstream in(header); std::getline(in, line, ',');) names.push_back(line);
  const auto judged =
      static_cast<std::size_t>(std::find(names.begin(), names.end(), "judged_penetration_m") - names.begin());
  std::string last;
  while (std::getline(stats, line)) last = line;
  std::vector<std::string> cells;
  std::string cell;
  for (std::istringstream in(last); std::getline(in, cell, ',');) cells.push_back(cell);
  CHECK(std::stod(cells[judged]) < 5e-3);
}

TEST_CASE("each key of the new shapes is refused where it stands") {
  check_shape_refused("{ cylinder = { radius = 0.1 } }", "{ radius",
                      "has no length; length = a length in metres is wanted");
  check_shape_refused("{ cylinder = { length = 0.1 } }", "{ length", "has no radius");
  check_shape_refused("{ cylinder = { radius = -1, length = 1 } }", "-1", "greater than 0");
  check_shape_refused("{ cylinder = { radius = 0.1, length = true } }", "true", "length");
  check_shape_refused("{ cone = { radius = 0.1, height = 1 } }", "height", "unknown key 'height'");
  check_shape_refused("{ cone = { radius = 0, length = 1 } }", "0, length", "greater than 0");
  check_shape_refused("{ cone = 3 }", "3 }", "a table { ... } is wanted");
  check_shape_refused("{ cylindre = { radius = 1, length = 1 } }", "cylindre", "did you mean 'cylinder'?");
  check_shape_refused("{ cone = { radius = 1, length = 1 }, cylinder = { radius = 1, length = 1 } }", "{ cone",
                      "names 2 shapes");
  check_shape_refused("{ mesh = { surface = \"ball.off\" } }", "mesh", "unknown key 'mesh'");

  check_shape_refused("{ convex_hull = {} }", "{} }",
                      "has neither points nor a surface; one of points, surface is wanted");
  check_shape_refused(
      "{ convex_hull = { points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], surface = \"ball.off\" } }", "{ points",
      "has points and a surface");
  check_shape_refused("{ convex_hull = { points = 3 } }", "3 }", "a list [ ... ] is wanted");
  check_shape_refused("{ convex_hull = { points = [[0, 0, 0], [1, 2]] } }", "[1, 2]", "has 2 numbers");
  check_shape_refused("{ convex_hull = { points = [[0, 0, 0], [1, 2, \"x\"]] } }", "\"x\"", "a real number is wanted");
  check_shape_refused("{ convex_hull = { points = [[0, 0, 0], [1, 2, inf]] } }", "inf", "is allowed");
  check_shape_refused("{ convex_hull = { points = [[0, 0, 0], [0, 0, 0]] } }", "[[0", "has 1 different point");
  check_shape_refused("{ convex_hull = { points = [[0, 0, 0], [1, 0, 0], [2, 0, 0], [5, 0, 0]] } }", "[[0",
                      "has all points on a line");
  check_shape_refused("{ convex_hull = { points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0.2, 0.3, 0]] } }",
                      "[[0", "has all points in a plane");
  check_shape_refused("{ convex_hull = { surface = \"none.off\" } }", "\"none.off\"", "there is no such file");
  check_shape_refused("{ convex_hull = { surface = \"../ball.off\" } }", "\"../ball.off\"",
                      "leads out of the scene's folder");
  check_shape_refused("{ convex_hull = { surface = 3 } }", "3 }", "a text is wanted");

  check_shape_refused("{ compound = {} }", "{} }", "has no parts");
  check_shape_refused("{ compound = { parts = [] } }", "[] }", "has no parts");
  check_shape_refused("{ compound = { parts = { shape = 1 } } }", "{ shape", "a list [ ... ] is wanted");
  check_shape_refused("{ compound = { parts = [ 3 ] } }", "3 ]", "a table { ... } is wanted");
  check_shape_refused("{ compound = { parts = [ { position = [0, 0, 0] } ] } }", "{ position", "parts[0] has no shape");
  check_shape_refused("{ compound = { parts = [ { shape = { sphere = { radius = 1 } }, place = [0, 0, 0] } ] } }",
                      "place", "unknown key 'place'");
  check_shape_refused("{ compound = { parts = [ { shape = { sphere = { radius = 1 } }, position = [0, 0] } ] } }",
                      "[0, 0]", "has 2 numbers");
  check_shape_refused("{ compound = { parts = [ { shape = { sphere = { radius = 1 } }, rotation = 90 } ] } }", "90",
                      "a vector");
  check_shape_refused("{ compound = { parts = [ { shape = { sphere = { radius = \"big\" } } } ] } }", "\"big\"",
                      "radius");
  check_shape_refused("{ compound = { parts = [ { shape = { plane = { normal = [0, 1, 0] } } } ] } }", "[ { shape",
                      "has a plane as part 0, which has no bounds");
}
