// Bodies that slide over a floor of triangles: without friction nothing holds them, whatever edges they pass.
#include <catch2/catch.hpp>

#include "engine/geometry/rotation.hpp"
#include "tests/support/geometry/sample_shapes.hpp"
#include "tests/support/mechanics/worlds.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// A slab whose upper side is cut into cells at irregular places, all in the plane y = 0 but for `noise` below it.
MeshPointer irregular_floor(int cells, double noise, std::uint64_t seed) {
  Random r(seed);
  TriangleMesh mesh = box({2.0, 0.1, 2.0}, {cells, 1, cells});
  const double cell = 4.0 / cells;
  for (Vec3& v : mesh.vertices) {
    v.y() -= 0.1;
    const bool is_inner = v.y() > -0.05 && std::abs(v.x()) < 2.0 - 0.5 * cell && std::abs(v.z()) < 2.0 - 0.5 * cell;
    if (is_inner) v += Vec3(0.35 * cell * r.sym(), -noise * r.u(), 0.35 * cell * r.sym());
  }
  return surface(std::move(mesh));
}

struct Slider {
  const char* name;
  SharedShape shape;
  Vec3 degrees;
  double height;  // of the centre where it rests
};

std::vector<Slider> sliders() {
  const Vec3 half = Vec3::Constant(0.05), turned(0.0, 27.0, 0.0);
  const SharedShape part = Box(Vec3(0.025, 0.05, 0.05));
  return {{"sphere", Sphere{0.05}, Vec3::Zero(), 0.05},
          {"capsule", Capsule{0.03, 0.1}, {0.0, 20.0, 90.0}, 0.03},
          {"box", Box(half), Vec3::Zero(), 0.05},
          {"turned box", Box(half), turned, 0.05},
          {"hull", made_hull(box_corners(half)), turned, 0.05},
          {"mesh", surface(box(half, {4, 4, 4})), turned, 0.05},
          {"coarse mesh", surface(box(half)), turned, 0.05},
          {"compound",
           made_compound({{part, {Mat3::Identity(), {-0.025, 0, 0}}}, {part, {Mat3::Identity(), {0.025, 0, 0}}}}),
           turned, 0.05},
          {"cylinder", made("cylinder", {{"radius", 0.05}, {"length", 0.1}}), turned, 0.05},
          {"cone", made("cone", {{"radius", 0.05}, {"length", 0.1}}), turned, 0.05}};
}

struct Slide {
  double energy = 0.0,
         lift = 0.0;  // the most that the kinetic energy changes, relative; the fastest way up, of the speed
};

Slide slide(const MeshPointer& floor, const Slider& slider, double speed, int substeps) {
  World world;
  world.parameters.simulation.sleeping = false;
  world.parameters.simulation.substeps = substeps;
  world.parameters.contact.friction = 0.0;
  BodyDescription ground;
  ground.name = "floor";
  ground.kind = BodyKind::fixed;
  ground.shape = floor;
  world.add_body(ground);
  BodyDescription body = dynamic_body("slider", slider.shape, {-1.5, slider.height, -0.4});
  body.rotation = slider.degrees;
  body.velocity = speed * Vec3(1.0, 0.0, 0.1).normalized();
  world.add_body(body);
  world.start();
  const double before = world.record().stats.kinetic;
  Slide worst;
  const int frames = std::min(60, static_cast<int>(2.8 / (speed / 60.0)));
  for (int i = 0; i < frames; ++i) {
    world.step();
    worst.energy = std::max(worst.energy, std::abs(world.record().stats.kinetic / before - 1.0));
    worst.lift = std::max(worst.lift, std::abs(rigid(world, 1).velocity.y()) / speed);
  }
  return worst;
}

}  // namespace

TEST_CASE("whatever slides without friction over a floor of triangles goes on at its speed", "[joints]") {
  const std::uint64_t seed = 1;
  INFO("seed " << seed);
  for (const int cells : {7, 40, 150}) {
    const MeshPointer floor = irregular_floor(cells, 0.0, seed);
    for (const Slider& slider : sliders())
      for (const double speed : {0.3, 3.0, 30.0})
        for (const int substeps : {1, 4}) {
          INFO(slider.name << " at " << speed << " m/s over " << cells << " cells, " << substeps << " sub-steps");
          const Slide worst = slide(floor, slider, speed, substeps);
          CHECK(worst.energy <= 1e-6);
          CHECK(worst.lift <= 1e-6);
        }
  }
}
