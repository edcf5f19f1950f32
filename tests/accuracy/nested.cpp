// A mesh that starts wholly inside another: no triangles cross, and yet it has to come out; what lies in a cavity has not.
#include <catch2/catch.hpp>

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
