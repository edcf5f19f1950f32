// How near two bodies are, however far: held against formulas and against all triangle pairs.
#include "engine/detection/pairs/nearest_features.hpp"

#include <catch2/catch.hpp>

#include "engine/geometry/triangle_intersection.hpp"
#include "tests/support/geometry/brute_convex.hpp"
#include "tests/support/geometry/shapes.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

const BodyIndex kA(0), kB(1);

std::optional<NearestFeatures> nearest(const TestColliders& bodies, double limit = INFINITY) {
  return NearestSearch().find(bodies.colliders(), kA, kB, limit);
}

double brute_distance(const Collider& a, const Collider& b) {
  const auto corners = [](const Collider& c, std::size_t t) {
    const Triangle& i = c.mesh().mesh.triangles[t];
    return TriangleCorners{c.vertices[i[0]], c.vertices[i[1]], c.vertices[i[2]]};
  };
  double least = INFINITY;
  for (std::size_t s = 0; s < a.mesh().mesh.triangles.size(); ++s)
    for (std::size_t t = 0; t < b.mesh().mesh.triangles.size(); ++t)
      least = std::min(least, triangle_distance(corners(a, s), corners(b, t)));
  return least;
}

TriangleMesh placed(const Collider& c, TriangleMesh mesh) {
  for (Vec3& x : mesh.vertices) x = c.pose.apply(x);
  return mesh;
}

}  // namespace

TEST_CASE("the nearest features of exact shapes are where formulas have them, at any distance") {
  Random r(21);
  for (int i = 0; i < 300; ++i) {
    const double far = std::pow(10.0, r.in(-2.0, 3.0));
    TestColliders balls;
    balls.add(Sphere{0.3}, {Mat3::Identity(), far * r.vector()});
    balls.add(Sphere{0.1}, {Mat3::Identity(), far * r.vector()});
    const Vec3 between = balls[0].pose.position - balls[1].pose.position;
    const auto found = nearest(balls);
    REQUIRE(found);
    CHECK(found->distance == Approx(between.norm() - 0.4).margin(1e-12 * far));
    CHECK((found->normal - between.normalized()).norm() < 1e-9);

    TestColliders floor;
    const Vec3 n = r.direction();
    floor.add(Plane{n, r.sym()});
    floor.add(Box{{0.3, 0.2, 0.1}}, {r.rotation(), far * r.vector()});
    double lowest = INFINITY;
    for (int k = 0; k < 8; ++k) {
      const Vec3 corner((k & 1) ? 0.3 : -0.3, (k & 2) ? 0.2 : -0.2, (k & 4) ? 0.1 : -0.1);
      lowest = std::min(lowest, n.dot(floor[1].pose.apply(corner)) - floor[0].shape->as<Plane>()->offset);
    }
    const auto above = nearest(floor);
    REQUIRE(above);
    CHECK(above->distance == Approx(lowest).margin(1e-12 * (1.0 + far)));
  }
}

TEST_CASE("the nearest features of boxes are those of all their faces, edges and corners") {
  Random r(22);
  for (int i = 0; i < 200; ++i) {
    const Vec3 half_a(0.3, 0.2, 0.1), half_b(0.1, 0.4, 0.2);
    TestColliders bodies;
    bodies.add(Box{half_a}, random_pose(r, i % 2 == 0 ? 1.0 : 8.0));
    bodies.add(Box{half_b}, random_pose(r, 1.0));
    const BruteGap truth = brute_convex_gap(placed(bodies[0], box(half_a)), placed(bodies[1], box(half_b)));
    const auto found = nearest(bodies);
    REQUIRE(found);
    INFO(i << ": " << found->distance << " against " << truth.gap);
    if (truth.overlaps)
      CHECK(found->distance < 1e-9);
    else
      CHECK(found->distance == Approx(truth.gap).margin(1e-9));
  }
}

TEST_CASE("the nearest features of meshes are those of the nearest two triangles") {
  Random r(23);
  int crossing = 0;
  for (int i = 0; i < 60; ++i) {
    TestColliders bodies;
    bodies.add(surface(bumpy_torus(12, 6)), random_pose(r, i % 2 == 0 ? 0.8 : 2.5));
    bodies.add(surface(bumpy_sphere(2)), random_pose(r, i % 6 == 5 ? 20.0 : 1.0));
    const double truth = brute_distance(bodies[0], bodies[1]);
    const auto found = nearest(bodies);
    REQUIRE(found);
    if (truth == 0.0) {
      CHECK(found->distance <= 0.0);
      ++crossing;
      continue;
    }
    CHECK(found->distance == Approx(truth).epsilon(1e-12));
    CHECK((found->point_a - found->point_b).norm() == Approx(truth).epsilon(1e-12));
    CHECK((found->point_b + truth * found->normal - found->point_a).norm() < 1e-12 * (1.0 + truth));
  }
  CHECK((crossing > 3 && crossing < 57));
}

TEST_CASE("an exact shape beside a mesh is as near as to its nearest triangle") {
  Random r(24);
  for (int i = 0; i < 200; ++i) {
    TestColliders bodies;
    bodies.add(Sphere{0.2}, random_pose(r, 6.0));
    bodies.add(surface(bumpy_torus(12, 6)), random_pose(r, 2.0));
    double least = INFINITY;
    for (const Triangle& t : bodies[1].mesh().mesh.triangles) {
      const auto& x = bodies[1].vertices;
      least =
          std::min(least, closest_on_triangle(bodies[0].pose.position, {x[t[0]], x[t[1]], x[t[2]]}).squared_distance);
    }
    const double truth = std::sqrt(least) - 0.2;
    if (truth < 0.0) continue;  // which side the centre is on is another question
    const auto found = nearest(bodies);
    REQUIRE(found);
    INFO(i);
    CHECK(found->distance == Approx(truth).margin(1e-12));
    CHECK((found->kind_b == Feature::vertex || found->kind_b == Feature::edge || found->kind_b == Feature::face));
  }
}

TEST_CASE("a box beside a mesh is as near as its own triangles, and a rounded solid as its core less the rounding") {
  Random r(25);
  for (int i = 0; i < 100; ++i) {
    const Vec3 half(0.3, 0.1, 0.2);
    TestColliders bodies, made;
    const Pose at_a = random_pose(r, 4.0), at_b = random_pose(r, 2.0);
    bodies.add(Box{half}, at_a);
    bodies.add(surface(bumpy_torus(12, 6)), at_b);
    made.add(surface(box(half)), at_a);
    made.add(surface(bumpy_torus(12, 6)), at_b);
    const double truth = brute_distance(made[0], made[1]);
    const auto found = nearest(bodies);
    REQUIRE(found);
    INFO(i << ": " << found->distance << " against " << truth);
    if (truth == 0.0)
      CHECK(found->distance <= 1e-3);
    else
      CHECK(found->distance == Approx(truth).epsilon(1e-9));

    TestColliders rounded;
    rounded.add(Capsule{0.1, 0.3}, at_a);
    rounded.add(surface(bumpy_torus(12, 6)), at_b);
    double core = INFINITY;  // of the capsule's line
    const auto& x = rounded[1].vertices;
    for (const Triangle& t : rounded[1].mesh().mesh.triangles)
      core = std::min(core, triangle_distance({at_a.apply(Vec3(0, -0.3, 0)), at_a.apply(Vec3(0, 0.3, 0)),
                                               at_a.apply(Vec3(0, 0.3, 0))},
                                              {x[t[0]], x[t[1]], x[t[2]]}));
    if (core < 0.1) continue;
    const auto near = nearest(rounded);
    REQUIRE(near);
    INFO(near->distance << " against " << core - 0.1);
    CHECK(near->distance == Approx(core - 0.1).margin(1e-9));
  }
}

TEST_CASE("beyond the limit there is nothing, and between planes neither") {
  TestColliders balls;
  balls.add(Sphere{0.5});
  balls.add(Sphere{0.5}, {Mat3::Identity(), Vec3(0, 3, 0)});  // 2 m apart
  CHECK_FALSE(nearest(balls, 1.999));
  REQUIRE(nearest(balls, 2.001));
  CHECK(nearest(balls, 2.001)->distance == Approx(2.0));
  TestColliders planes;
  planes.add(Plane{Vec3::UnitY(), 0.0});
  planes.add(Plane{Vec3::UnitX(), 0.0});
  CHECK_FALSE(nearest(planes));
}
