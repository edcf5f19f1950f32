#include "engine/geometry/surface/mesh_shells.hpp"

#include <catch2/catch.hpp>

#include <algorithm>

#include "engine/geometry/inside.hpp"
#include "engine/geometry/mass_properties.hpp"
#include "engine/geometry/surface/mesh_checks.hpp"
#include "engine/geometry/surface/surface_side.hpp"
#include "tests/support/geometry/meshes.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

TriangleMesh moved(TriangleMesh mesh, const Vec3& by) {
  for (Vec3& v : mesh.vertices) v += by;
  return mesh;
}
TriangleMesh cube_of(double half) { return box(Vec3::Constant(half)); }
/// Corners on the axes, at distance r.
TriangleMesh octahedron(double r) {
  TriangleMesh mesh;
  for (int k = 0; k < 3; ++k)
    for (const double sign : {1.0, -1.0}) mesh.vertices.push_back(sign * r * Vec3::Unit(k));
  for (int x = 0; x < 2; ++x)
    for (int y = 2; y < 4; ++y)
      for (int z = 4; z < 6; ++z) {
        const bool even = (x + y + z) % 2 == 0;
        mesh.triangles.push_back(even ? Triangle{x, y, z} : Triangle{x, z, y});
      }
  return mesh;
}
TriangleMesh together(std::initializer_list<TriangleMesh> parts) {
  TriangleMesh all;
  for (const TriangleMesh& part : parts) {
    const int first = static_cast<int>(all.vertices.size());
    all.vertices.insert(all.vertices.end(), part.vertices.begin(), part.vertices.end());
    for (const Triangle& t : part.triangles) all.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  return all;
}

std::string problem(const TriangleMesh& mesh) { return check_mesh(mesh, make_topology(mesh)).value_or("none"); }

void check_wrong(const TriangleMesh& mesh, const std::string& start, const std::string& contains) {
  const std::string found = problem(mesh);
  INFO(found);
  CHECK(found.rfind(start, 0) == 0);
  CHECK(found.find(contains) != std::string::npos);
}

}  // namespace

TEST_CASE("the octahedron of these tests faces outwards") {
  CHECK(signed_volume(octahedron(1.0)) == Approx(4.0 / 3.0));
}

TEST_CASE("a component that faces the wrong way is named, whatever the whole volume is") {
  const TriangleMesh good = moved(icosphere(2), {5, 0, 0}), bad = inside_out(cube_of(0.5));
  CHECK(problem(together({good, cube_of(0.5)})) == "none");
  REQUIRE(signed_volume(together({good, bad})) > 0.0);  // all that was looked at once
  check_wrong(together({good, bad}), "has component 2 of 2 inside out (triangles from 320 on, volume -1 m³)",
              "flip the order of their corners");
  check_wrong(together({good, cube_of(0.5), inside_out(moved(cube_of(0.5), {0, 3, 0}))}),
              "has component 3 of 3 inside out", "");
  check_wrong(inside_out(icosphere(1)), "is inside out: its triangles face inwards (volume -", "flip the order");
  check_wrong(together({inside_out(icosphere(1)), bad}), "has component 1 of 2 inside out", "face inwards");
}

TEST_CASE("the walls of cavities face inwards, of what stands in them outwards") {
  const TriangleMesh outer = icosphere(3, 2.0), wall = inside_out(icosphere(3, 1.5)), core = cube_of(0.5);
  const TriangleMesh hole = inside_out(icosphere(1, 0.3));
  CHECK(problem(together({outer, wall})) == "none");
  CHECK(problem(together({wall, outer})) == "none");
  CHECK(problem(together({outer, wall, core})) == "none");
  CHECK(problem(together({hole, outer, core, wall})) == "none");
  check_wrong(together({outer, icosphere(3, 1.5)}), "has component 2 of 2 inside out",
              "inside component 1, where it is the wall of a cavity");
  check_wrong(together({outer, wall, inside_out(core)}), "has component 3 of 3 inside out",
              "in the cavity of component 2");
  check_wrong(together({inside_out(hole), outer, core, wall}), "has component 1 of 4 inside out",
              "inside component 3,");
  check_wrong(together({core, outer, inside_out(wall)}), "has component 3 of 3 inside out", "inside component 2,");
  // far from the world's origin, large and small
  const Vec3 far(1e5, -3e4, 2e5);
  CHECK(problem(together({moved(outer, far), moved(wall, far)})) == "none");
  check_wrong(together({moved(outer, far), moved(inside_out(wall), far)}), "has component 2 of 2 inside out", "cavity");
}

TEST_CASE("parts that pierce or touch from outside are walls of their own") {
  CHECK(problem(together({cube_of(1.0), moved(cube_of(0.4), {1.0, 0.1, 0.2})})) == "none");    // an eye in its socket
  CHECK(problem(together({cube_of(1.0), moved(cube_of(1.0), {2.0, 0.0, 0.0})})) == "none");    // side by side
  CHECK(problem(together({cube_of(1.0), moved(cube_of(0.25), {1.25, 0.0, 0.0})})) == "none");  // on a face
  CHECK(problem(together({cube_of(1.0), moved(cube_of(0.5), {1.5, 1.5, 1.5})})) == "none");    // at a corner
  CHECK(problem(together({cube_of(1.0), moved(cube_of(0.5), {1.5, 1.5, 0.0})})) == "none");    // at an edge
  CHECK(problem(together({cube_of(1.0), cube_of(1.0)})) == "none");                            // twice the same
  // a bar through a ring: its box holds that of the bar across, nothing of it is inside
  CHECK(problem(together({torus(1.0, 0.2, 24, 12), cube_of(0.1)})) == "none");
  // a plus: vertices of neither lie in the other
  CHECK(problem(together({box({1.0, 0.2, 0.2}), box({0.2, 1.0, 0.2})})) == "none");
  // a spike of the outer one reaches into the inner one: they pierce
  TriangleMesh dented = box(Vec3::Constant(1.0), {2, 2, 2});
  for (Vec3& v : dented.vertices)
    if (v == Vec3(0, 1, 0)) v.y() = -0.2;
  CHECK(problem(together({dented, cube_of(0.5)})) == "none");
}

TEST_CASE("a cavity may touch the wall round it") {
  const auto check_cavity = [](const TriangleMesh& outer, const TriangleMesh& inner) {
    CHECK(problem(together({outer, inside_out(inner)})) == "none");
    check_wrong(together({outer, inner}), "has component 2 of 2 inside out", "cavity");
    check_wrong(together({inner, outer}), "has component 1 of 2 inside out", "inside component 2");
  };
  check_cavity(cube_of(1.0), moved(cube_of(0.5), {0.5, 0.0, 0.0}));        // a face in a face
  check_cavity(cube_of(1.0), moved(cube_of(0.5), {0.5, 0.5, 0.5}));        // three faces, an own corner in a corner
  check_cavity(cube_of(1.0), moved(cube_of(0.5), {0.5, 0.5, 0.0}));        // along an edge
  check_cavity(cube_of(1.0), octahedron(1.0));                             // every vertex in a face
  check_cavity(octahedron(1.0), moved(octahedron(0.5), {0.5, 0.0, 0.0}));  // a vertex in common
  TriangleMesh turned = cube_of(1.0);
  const Mat3 r = Eigen::AngleAxisd(0.3, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  TriangleMesh inscribed = octahedron(1.0);
  for (Vec3& v : turned.vertices) v = r * v;
  for (Vec3& v : inscribed.vertices) v = r * v;
  check_cavity(turned, inscribed);  // the same, up to rounding
}

TEST_CASE("a component without volume has no side to be wrong") {
  TriangleMesh sheet;  // a triangle, front and back
  sheet.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 1}};
  CHECK(problem(together({moved(icosphere(1), {4, 0, 0}), sheet})) == "none");
  check_wrong(sheet, "encloses no volume", "");
}

TEST_CASE("random nests of shells: the one that was turned is found, in any order of triangles") {
  Random random(3);
  for (int round = 0; round < 60; ++round) {
    struct Ball {
      Vec3 center;
      double radius;
      int depth;
    };
    std::vector<Ball> balls;
    for (int tries = 0; tries < 200 && balls.size() < 7; ++tries) {
      Ball ball{3.0 * random.vector(), random.in(0.1, 2.0), 0};
      bool apart = true;
      for (const Ball& other : balls) {
        const double d = (ball.center - other.center).norm();
        const bool in = d + ball.radius < 0.75 * other.radius, over = d + other.radius < 0.75 * ball.radius;
        apart &= in || over || d > 1.05 * (ball.radius + other.radius);
      }
      if (apart) balls.push_back(ball);
    }
    const int wrong = random.below(static_cast<int>(balls.size()) + 1) - 1;
    TriangleMesh all;
    std::vector<int> ball_of;
    for (std::size_t i = 0; i < balls.size(); ++i) {
      int depth = 0;
      for (const Ball& other : balls)
        depth += &other != &balls[i] && (other.center - balls[i].center).norm() + balls[i].radius < other.radius;
      balls[i].depth = depth;
      TriangleMesh part = icosphere(2, balls[i].radius);
      const Mat3 turn = random.rotation();
      for (Vec3& v : part.vertices) v = turn * v + balls[i].center;
      if ((depth % 2 == 1) != (static_cast<int>(i) == wrong)) part = inside_out(part);
      all = together({all, part});
      ball_of.insert(ball_of.end(), part.triangles.size(), static_cast<int>(i));
    }
    for (std::size_t i = all.triangles.size() - 1; i > 0; --i) {
      const auto j = static_cast<std::size_t>(random.below(static_cast<int>(i) + 1));
      std::swap(all.triangles[i], all.triangles[j]);
      std::swap(ball_of[i], ball_of[j]);
    }
    const std::vector<Shell> shells = find_shells(all, make_topology(all));
    REQUIRE(shells.size() == balls.size());
    int number = 0;
    for (std::size_t s = 0; s < shells.size(); ++s) {
      const int ball = ball_of[shells[s].triangles.front()];
      CHECK(shells[s].depth == balls[ball].depth);
      if (ball == wrong) number = static_cast<int>(s) + 1;
    }
    const std::string found = problem(all);
    INFO(round);
    if (wrong < 0)
      CHECK(found == "none");
    else if (balls.size() == 1)
      CHECK(found.rfind("is inside out", 0) == 0);
    else
      CHECK(found.rfind(fmt::format("has component {} of {} inside out", number, balls.size()), 0) == 0);
  }
}

TEST_CASE("the side of a surface is the winding number, and nothing on the surface itself") {
  Random random(8);
  TriangleMesh meshes[] = {bumpy_sphere(3), bumpy_torus(40, 20), cube_of(1.0),
                           together({icosphere(2), moved(icosphere(2), {0.5, 0, 0})}), inside_out(octahedron(1.0))};
  for (const TriangleMesh& mesh : meshes) {
    const SurfaceSide side(mesh.vertices, mesh.triangles);
    int inside = 0;
    for (int i = 0; i < 2000; ++i) {
      const Vec3 x = 1.3 * random.vector();
      const double number = winding_number(x, mesh.vertices, mesh.triangles);
      if (std::abs(number - std::round(number)) > 1e-6) continue;
      REQUIRE(side.winding(x) == static_cast<int>(std::round(number)));
      inside += std::round(number) != 0;
    }
    CHECK(inside > 50);
    for (const Vec3& v : mesh.vertices) CHECK(!side.winding(v));
    for (const Triangle& t : mesh.triangles) {
      const double u = random.in(0.1, 0.5), w = random.in(0.1, 0.4);
      const Vec3 on = (1.0 - u - w) * mesh.vertices[t[0]] + u * mesh.vertices[t[1]] + w * mesh.vertices[t[2]];
      CHECK(!side.winding(on));
    }
  }
}
