// Scenes that are alike in all but size: lengths × s, times and speeds × √s, Young's modulus × s, density and gravity as
// they are (Froude's similarity). Without a length or a speed among their parameters they move alike.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <cmath>

#include "engine/bodies/deformable_body.hpp"
#include "engine/io/scene/scene.hpp"
#include "tests/support/program/temp_folder.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

constexpr double kSize = 0.1;  // of a body at s = 1, metres
constexpr int kFrames = 120;

std::string vec(double s, double x, double y, double z) { return fmt::format("[{}, {}, {}]", s * x, s * y, s * z); }

/// Parameters and the ground of every scene.
std::string head(double s, const std::string& rows) {
  return fmt::format(
      "[simulation]\nframe_time = {}\n{}\n[[body]]\nname = \"ground\"\nkind = \"static\"\n"
      "shape = {{ plane = {{ normal = [0, 1, 0], offset = 0 }} }}\n",
      std::sqrt(s) / 60.0, rows);
}

std::string body(const char* name, const char* kind, const std::string& rest) {
  return fmt::format("[[body]]\nname = \"{}\"\nkind = \"{}\"\n{}\n", name, kind, rest);
}

/// Five boxes, or cubes of triangles, one on another with gaps between, each turned and shifted a little.
std::string stack(double s, bool meshes) {
  std::string text;
  for (int k = 0; k < 5; ++k)
    text += body(
        fmt::format("b{}", k).c_str(), "dynamic",
        (meshes ? fmt::format("surface = \"cube.off\"\nscale = {}\n", s * kSize)
                : fmt::format("shape = {{ box = {{ size = {} }} }}\n", vec(s, kSize, kSize, kSize))) +
            fmt::format("position = {}\nrotation = [0, {}, 0]", vec(s, 0.005 * k, 0.0507 + 0.1015 * k, 0.0), 5 * k));
  return text;
}

std::string ball(double s) {
  return body("ball", "dynamic",
              fmt::format("shape = {{ sphere = {{ radius = {} }} }}\nrestitution = 0.5\nposition = {}\nvelocity = {}",
                          0.5 * kSize * s, vec(s, 0.0, 0.07, 0.5), vec(std::sqrt(s), 0.8, 0.0, 0.1)));
}

std::string soft_cube(double s) {
  return body("soft", "deformable",
              fmt::format("shape = {{ box = {{ size = {} }} }}\nvolume = {{ lattice = {{ cells = 3 }} }}\n"
                          "material = {{ young = {}, poisson = 0.4, density = 1000 }}\nposition = {}",
                          vec(s, kSize, kSize, kSize), 5e4 * s, vec(s, 0.0, 0.0505, 0.0)));
}

struct Course {
  std::vector<std::int64_t> contacts;    // by frame
  std::vector<std::vector<Vec3>> where;  // by frame: a point of each body, or the nodes of a deformable one, / s
};

Course course_of(const std::string& scene, double s) {
  const TempFolder folder;
  folder.write("cube.off",
               "OFF\n8 12 0\n-.5 -.5 -.5\n.5 -.5 -.5\n.5 .5 -.5\n-.5 .5 -.5\n-.5 -.5 .5\n.5 -.5 .5\n.5 .5 .5\n"
               "-.5 .5 .5\n3 0 2 1\n3 0 3 2\n3 4 5 6\n3 4 6 7\n3 0 1 5\n3 0 5 4\n3 2 3 7\n3 2 7 6\n3 1 2 6\n3 1 6 5\n"
               "3 0 4 7\n3 0 7 3\n");
  folder.write("s.toml", scene);
  World world;
  ParameterSet rows;
  world.parameters.bind(rows);
  load_scene(folder / "s.toml", {}, world, rows);
  world.start();
  Course course;
  for (int frame = 0; frame < kFrames; ++frame) {
    world.step();
    course.contacts.push_back(world.record().stats.contacts);
    std::vector<Vec3>& now = course.where.emplace_back();
    for (const Body& b : world.bodies())
      if (const auto* soft = b.as<DeformableBody>())
        for (int i = 0; i < soft->nodes(); ++i) now.push_back(soft->position.segment<3>(3 * i) / s);
      else if (b.has_freedom())
        for (const Vec3& x : {Vec3(0, 0, 0), Vec3(kSize, 0, 0), Vec3(0, kSize, 0)})
          now.push_back(b.pose.apply(s * x) / s);
  }
  return course;
}

/// `ties`: frames whose contacts may differ.
void check_alike(const std::function<std::string(double)>& scene, int ties = 0) {
  const Course one = course_of(scene(1.0), 1.0);
  REQUIRE(*std::max_element(one.contacts.begin(), one.contacts.end()) > 0);
  for (const double s : {1e-3, 100.0}) {
    const Course scaled = course_of(scene(s), s);
    double farthest = 0.0;
    int differing = 0, first = -1;
    for (std::size_t f = 0; f < one.where.size(); ++f) {
      if (one.contacts[f] != scaled.contacts[f]) ++differing, first = first < 0 ? static_cast<int>(f) + 1 : first;
      for (std::size_t i = 0; i < one.where[f].size(); ++i)
        farthest = std::max(farthest, (one.where[f][i] - scaled.where[f][i]).norm());
    }
    CAPTURE(s, differing, first);
    CHECK(differing <= ties);
    CHECK(farthest <= 1e-6 * kSize);
  }
}

}  // namespace

TEST_CASE("five stacked boxes move alike at every size") {
  check_alike([](double s) { return head(s, "") + stack(s, false); });
}

TEST_CASE("five stacked cubes of triangles move alike at every size") {
  // the moment faces land on faces, they are flat on one another to rounding, which says whether triangles cross
  check_alike([](double s) { return head(s, "") + stack(s, true); }, 1);
}

TEST_CASE("a ball that bounces and rolls moves alike at every size") {
  check_alike([](double s) { return head(s, "") + ball(s); });
}

TEST_CASE("a soft cube comes to rest alike at every size") {
  check_alike([](double s) { return head(s, "") + soft_cube(s); });
}

TEST_CASE("stacked boxes and a ball move alike at every size with every response") {
  const std::string method = GENERATE(as<std::string>(), "iterative_constraint_anticipation", "sequential_impulse",
                                      "simultaneous_impulse", "penalty");
  CAPTURE(method);
  // what bounces ever lower is a contact at the end of a frame or already not any more
  // in the last of its ever lower bounces a ball is a contact at the end of a frame or is not: by rounding
  check_alike([&](double s) { return head(s, "[response]\nmethod = \"" + method + "\"") + stack(s, false) + ball(s); },
              1);
}

TEST_CASE("without gravity the automatic thresholds are those of standard gravity") {
  // a ball that meets the ground slowly: below 0.0049 √(g d) = 0.00485 m/s nothing bounces
  for (const double speed : {0.004, 0.006}) {
    const Course course =
        course_of(head(1.0, "gravity = [0, 0, 0]") + body("ball", "dynamic",
                                                          fmt::format("shape = {{ sphere = {{ radius = 0.05 }} }}\n"
                                                                      "restitution = 1\nposition = [0, 0.051, 0]\n"
                                                                      "velocity = [0, {}, 0]",
                                                                      -speed)),
                  1.0);
    CAPTURE(speed);
    const double height = course.where.back().front().y();
    CHECK((height > 0.06) == (speed > 0.00485));
  }
}

TEST_CASE("a body of a millimetre rests on a ground of a hundred metres") {
  const std::string ground =
      body("field", "static", "shape = { box = { size = [100, 10, 100] } }\nposition = [0, -5, 0]");
  std::string cubes;
  for (int k = 0; k < 5; ++k)
    cubes += body(fmt::format("b{}", k).c_str(), "dynamic",
                  fmt::format("surface = \"cube.off\"\nscale = 0.001\nposition = [{}, {}, 0]\nrotation = [0, {}, 0]",
                              5e-5 * k, 5.1e-4 + 1.015e-3 * k, 5 * k));
  const Course course = course_of(head(1.0, "sleeping = false") + ground + cubes, 1.0);
  // the lowest point of each is its place in the stack, and none is thrown off it
  for (int k = 0; k < 5; ++k) {
    const Vec3 end = course.where.back()[static_cast<std::size_t>(3 * k)];
    CAPTURE(k, end.x(), end.y(), end.z());
    CHECK(end.y() == Approx(5e-4 + 1e-3 * k).margin(1e-5));
    CHECK(std::hypot(end.x() - 5e-5 * k, end.z()) < 1e-4);
  }
}
