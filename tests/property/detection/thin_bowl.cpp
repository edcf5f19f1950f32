// Bodies pressed into a thin open bowl by much more than their weight, where the first moment of a motion leads through; and
// solids that tumble onto an open surface which is met from both sides, a solid of a thousandth of its edges.
#include <catch2/catch.hpp>

#include <fmt/format.h>

#include "engine/geometry/surface/thickened_surface.hpp"
#include "engine/shapes/wall.hpp"
#include "engine/world/judge.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/geometry/sample_shapes.hpp"
#include "tests/support/mechanics/undone_motions.hpp"
#include "tests/support/mechanics/worlds.hpp"
#include "tests/support/program/program.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// y = 2 r² up to r = 0.3 m in rings of 24, open.
std::string bowl() {
  constexpr int kAround = 24, kRings = 6;
  std::string text = "v 0 0 0\n";
  for (int ring = 1; ring <= kRings; ++ring)
    for (int k = 0; k < kAround; ++k) {
      const double r = 0.05 * ring, angle = 2.0 * M_PI * k / kAround;
      text += fmt::format("v {:.9f} {:.9f} {:.9f}\n", r * std::cos(angle), 2.0 * r * r, r * std::sin(angle));
    }
  const auto at = [](int ring, int k) { return ring == 0 ? 1 : 2 + kAround * (ring - 1) + k % kAround; };
  for (int ring = 0; ring < kRings; ++ring)
    for (int k = 0; k < kAround; ++k) {
      text += fmt::format("f {} {} {}\n", at(ring, k), at(ring + 1, k + 1), at(ring + 1, k));
      if (ring > 0) text += fmt::format("f {} {} {}\n", at(ring, k), at(ring, k + 1), at(ring + 1, k + 1));
    }
  return text;
}

constexpr const char* kScene = R"([simulation]
gravity = [0, -1000, 0]
[[body]]
name = "bowl"
kind = "static"
surface = "bowl.obj"
sides = "both"
[[body]]
name = "soft"
kind = "deformable"
shape = { sphere = { radius = 0.05 } }
volume = { cage = { cells = 4 } }
material = { model = "neo_hookean", young = 3058103.975535168, poisson = 0.4, density = 1000, damping = [0, 0.004] }
position = [0.09, 0.09, 0.01]
[[body]]
name = "rigid"
kind = "dynamic"
shape = { box = { size = [0.06, 0.06, 0.06] } }
material = { density = 1000 }
position = [-0.07, 0.09, 0.02]
)";

/// A sheet of waves 2 cm high, two metres wide.
double wave(const Vec3& x) { return 0.02 * std::sin(5.1 * x.x() + 3.7 * x.z()); }

BodyDescription waves() {
  TriangleMesh ground = sheet(1.0, 50);
  for (Vec3& x : ground.vertices) x.y() = wave(x);
  BodyDescription d;
  d.name = "ground";
  d.kind = BodyKind::fixed;
  d.shape = surface(thickened(ground, {}));
  return d;
}

}  // namespace

TEST_CASE("what is pressed into a thin bowl goes on with finite figures: no piece of a motion takes no time") {
  const TempFolder folder;
  folder.write("bowl.obj", bowl());
  folder.write("s.toml", kScene);
  for (const char* method : {"quick", "constraint_anticipation"})
    for (const int gravity : {-500, -1000}) {
      const Outcome ran = impinge_run(
          folder.path(), {"run", "s.toml", "--frames", "6", "--no-images", "--judge", "--out",
                          fmt::format("{}{}", method, gravity), "--set", fmt::format("response.method={}", method),
                          "--set", fmt::format("simulation.gravity=[0,{},0]", gravity)});
      CAPTURE(method, gravity, ran.out, ran.err);
      CHECK(ran.code == 0);
      CHECK(ran.out.find("nothing passed, nothing overlaps") != std::string::npos);
    }
}

TEST_CASE("boxes that tumble onto a sheet lie on its upper side, and few of their motions are undone") {
  constexpr int kBoxes = 4;
  World world;
  world.parameters.simulation.substeps = 2;
  world.add_body(waves());
  for (int k = 0; k < kBoxes; ++k) {
    BodyDescription box = dynamic_body("box", Box{Vec3(0.1, 0.075, 0.1)}, Vec3(0.45 * k - 0.7, 0.2, 0.1 * k));
    box.name += static_cast<char>('0' + k);
    box.rotation = Vec3(5.0 + 3.0 * k, 7.0 * k, 5.0);
    world.add_body(box);
  }
  world.start();
  UndoneMotions undone;
  world.watch(&undone);
  run(world, 60);
  CHECK(undone.count < 10);  // of 120 sub-steps; with cuts alone 18
  for (int k = 1; k <= kBoxes; ++k) {
    const Vec3& x = world.bodies()[k].pose.position;
    const double below = wave(x);
    CHECK(x.y() - below > 0.07);  // half its height, at least, over a wave that is flat there
    CHECK(x.y() - below < 0.1);
  }
}

TEST_CASE("what is round tumbles and rolls on a sheet and is nowhere in it, with few motions undone") {
  World world;
  world.parameters.simulation.substeps = 2;
  const BodyDescription ground = waves();
  world.add_body(ground);
  const SharedShape shapes[] = {Capsule{0.08, 0.1}, cylinder(0.1, 0.2), cone(0.1, 0.2), Sphere{0.1},
                                cylinder(0.15, 0.03)};
  double place = -0.8;
  for (const SharedShape& shape : shapes)
    for (const double turn : {5.0, 50.0}) {
      BodyDescription d = dynamic_body("round", shape, Vec3(place, 0.3, 0.9 * std::sin(9.0 * place)));
      d.name += std::to_string(static_cast<int>(100.0 * place));
      d.rotation = Vec3(turn, 3.0 * turn, 20.0);
      d.angular_velocity = Vec3(3.0, 0.0, 4.0);
      world.add_body(d);
      place += 0.17;
    }
  world.start();
  UndoneMotions undone;
  world.watch(&undone);
  // of the sheet's thickness, which is some 50 micrometres
  const double least = 1e-3 * wall_of(*ground.shape);
  CHECK(least < 1e-7);
  for (int frame = 1; frame <= 30; ++frame) {
    world.step();
    CAPTURE(frame);
    CHECK(judge_overlap(world.bodies()).deepest <= least);
    CHECK(world.record().stats.substep_penetration <= least);
    CHECK(world.record().stats.unsafe_motions == 0);
  }
  CHECK(undone.count < 150);  // of 60 sub-steps of ten bodies; followed by their triangles it was twice that
  for (const Body& body : world.bodies())
    if (body.has_freedom() && std::max(std::abs(body.pose.position.x()), std::abs(body.pose.position.z())) < 1.0)
      CHECK(body.pose.position.y() > wave(body.pose.position));
}
