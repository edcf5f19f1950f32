// Ways out. A mesh that starts wholly inside another: no triangles cross, and yet it has to come out; what lies in a cavity
// has not. What is wedged comes out no faster than contact.max_push_out.
#include <catch2/catch.hpp>
#include <cmath>

#include "engine/world/judge.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/mechanics/worlds.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

TriangleMesh scaled(TriangleMesh mesh, double factor, const Vec3& moved = Vec3::Zero()) {
  for (Vec3& v : mesh.vertices) v = factor * v + moved;
  return mesh;
}

/// Seconds that a body of that size takes for a way by what max_push_out allows.
double time_out(double way, double size) { return way / (0.65 * std::sqrt(9.80665 * size)); }

struct Case {
  TriangleMesh outer, inner;  // about 2 across
  double ratio;
  Vec3 place;
};

void check_comes_out(const Case& c, double size, bool is_fixed) {
  World world;
  BodyDescription outer = dynamic_body("outer", surface(scaled(c.outer, size)), Vec3::Zero());
  outer.kind = is_fixed ? BodyKind::fixed : BodyKind::dynamic;
  BodyDescription inner = dynamic_body("inner", surface(scaled(c.inner, c.ratio * size)), size * c.place);
  inner.rotation = Vec3(20.0, -35.0, 70.0);
  world.add_body(outer);
  world.add_body(inner);
  world.parameters.simulation.gravity = Vec3::Zero();
  const double limit = 4.0 * time_out(2.0 * size, c.ratio * size);
  world.parameters.simulation.frame_time = limit / 200.0;
  world.parameters.simulation.substeps = 4;
  world.start();
  const double at_start = judge_overlap(world.bodies()).penetration;
  CHECK(at_start > 0.1 * c.ratio * size);
  CHECK(judge_overlap(world.bodies()).intersections == 0);
  CHECK(world.record().stats.contacts == 1);
  double shown = 0.0;
  for (int frame = 0; frame < 200; ++frame) {
    world.step();
    shown = std::max(shown, world.record().stats.max_penetration);
  }
  const double at_end = judge_overlap(world.bodies()).penetration;
  CAPTURE(size, c.ratio, is_fixed, at_start, at_end, shown);
  CHECK(at_end <= 1e-3 * c.ratio * size);
  CHECK(shown >= 0.5 * at_start);
  // pushed out is not shot out
  CHECK(world.record().stats.kinetic <= 1e-9);
}

}  // namespace

TEST_CASE("a mesh inside a mesh comes out by itself, from a millimetre to ten metres", "[nested]") {
  const Case cases[] = {
      {box(Vec3::Ones(), {6, 6, 6}), icosphere(2), 0.3, {0.2, 0.1, 0.0}},
      {icosphere(3), box(Vec3::Ones()), 0.1, {-0.3, 0.2, 0.1}},
      {bumpy_sphere(3), bumpy_torus(24, 12), 0.2, {0.1, -0.2, 0.3}},
      {torus(0.8, 0.35, 40, 20), icosphere(2), 0.1, {0.8, 0.05, 0.1}},
      {box(Vec3(1.0, 1.0, 0.5), {3, 3, 3}), torus(0.8, 0.2, 24, 12), 0.4, {0.0, 0.1, 0.05}},
  };
  double size = 1e-3;
  bool is_fixed = true;
  for (const Case& c : cases) {
    check_comes_out(c, size, is_fixed);
    size *= 10.0, is_fixed = !is_fixed;
  }
}

TEST_CASE("what lies in a closed cavity is left there", "[nested]") {
  TriangleMesh shell = icosphere(3);
  const int outside = static_cast<int>(shell.vertices.size());
  const TriangleMesh cavity = icosphere(3, 0.8);
  for (const Vec3& v : cavity.vertices) shell.vertices.push_back(v);
  for (const Triangle& t : cavity.triangles)
    shell.triangles.push_back({t[0] + outside, t[2] + outside, t[1] + outside});
  World world;
  world.add_body(dynamic_body("shell", surface(shell), Vec3::Zero()));
  world.add_body(dynamic_body("guest", surface(icosphere(2, 0.2)), Vec3(0.1, 0.2, 0.0)));
  world.parameters.simulation.gravity = Vec3::Zero();
  world.start();
  run(world, 10);
  CHECK(world.record().stats.contacts == 0);
  CHECK((world.bodies()[1].pose.position - Vec3(0.1, 0.2, 0.0)).norm() < 1e-12);
}

TEST_CASE("a ball that is wedged in a narrow groove comes out no faster than max_push_out") {
  // recovery moves no point faster, however a body is wedged. Between planes a degree from upright the way out is 1 / sin 1° = 57 times the overlap.
  constexpr double kRadius = 0.1, kOverlap = 0.01, kHalf = M_PI / 180.0;
  for (const double most : {0.1, 1.0, 5.0}) {
    World world;
    world.parameters.simulation.gravity.setZero();
    world.parameters.simulation.sleeping = false;
    world.parameters.simulation.substeps = 1;
    world.parameters.contact.max_push_out = most;
    world.add_body(fixed_plane("left", Vec3(std::cos(kHalf), std::sin(kHalf), 0.0), 0.0));
    world.add_body(fixed_plane("right", Vec3(-std::cos(kHalf), std::sin(kHalf), 0.0), 0.0));
    const double start = (kRadius - kOverlap) / std::sin(kHalf), out = kRadius / std::sin(kHalf);
    world.add_body(dynamic_body("ball", Sphere{kRadius}, Vec3(0.0, start, 0.0)));
    world.start();
    const double dt = world.parameters.simulation.frame_time;
    double before = start, fastest = 0.0;
    const int frames = static_cast<int>((out - start) / (most * dt)) + 3;
    for (int frame = 0; frame < frames; ++frame) {
      world.step();
      const double now = rigid(world, 2).pose.position.y();
      fastest = std::max(fastest, (now - before) / dt);
      before = now;
    }
    CAPTURE(most, frames);
    CHECK(fastest <= most * (1.0 + 1e-9));
    CHECK(fastest >= 0.9 * most);
    CHECK(before == Approx(out).margin(1e-3));
    CHECK(rigid(world, 2).velocity.norm() < 1e-12);
  }
}
