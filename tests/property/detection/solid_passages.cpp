// Solids with a formula that come through triangles: at hundreds of moments, points all over the triangles are in the shape by
// its own formula or they are not; and what the search says of the moment, the place and the depth agrees with them.
#include <catch2/catch.hpp>

#include <cmath>

#include "engine/detection/collision.hpp"
#include "engine/detection/continuous/convex_solids.hpp"
#include "engine/detection/continuous/solid_passages.hpp"
#include "engine/geometry/convex/convex_gap.hpp"
#include "engine/geometry/convex/convex_triangle.hpp"
#include "engine/geometry/distance.hpp"
#include "engine/geometry/rotation.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/geometry/rigid_paths.hpp"
#include "tests/support/geometry/sample_shapes.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

constexpr int kLooksAtWay = 96, kCutsOfSide = 12;

/// Of points all over the triangles, how deep the deepest is in the shape at a moment, metres.
double deepest_at(double t, const Shape& shape, const SurfacePath& own, const SurfacePath& other) {
  const TriangleMesh& mesh = other.of->surface->mesh;
  const Pose of_own = own.pose_at(t), of_other = other.pose_at(t);
  double deepest = -INFINITY;
  for (const Triangle& c : mesh.triangles) {
    Vec3 x[3];
    for (int k = 0; k < 3; ++k)
      x[k] = of_own.apply_inverse(of_other.apply(mesh.vertices[static_cast<std::size_t>(c[k])]));
    const double size = std::max((x[1] - x[0]).norm(), (x[2] - x[0]).norm());
    if (x[0].norm() > shape.bounding_radius() + size) continue;
    for (int i = 0; i <= kCutsOfSide; ++i)
      for (int j = 0; i + j <= kCutsOfSide; ++j) {
        const double u = static_cast<double>(i) / kCutsOfSide, v = static_cast<double>(j) / kCutsOfSide;
        deepest = std::max(deepest, -shape.signed_distance((1.0 - u - v) * x[0] + u * x[1] + v * x[2]));
      }
  }
  return deepest;
}

/// Whether they are apart when the way begins.
bool begin_apart(const Shape& shape, const SurfacePath& own, const SurfacePath& other) {
  const TriangleMesh& mesh = other.of->surface->mesh;
  for (const PlacedConvex& part : convex_solids(shape))
    for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
      const ConvexTriangle triangle(mesh, t);
      if (convex_gap(placed(part, own.pose_at(0.0)), {&triangle, other.pose_at(0.0)}).gap <= 0.0) return false;
    }
  return true;
}

SharedShape dumbbell() {
  const SharedShape ball = Sphere{0.25};
  return made_compound({{ball, Pose{Mat3::Identity(), Vec3(-0.4, 0.0, 0.0)}},
                        {cylinder(0.1, 0.8), Pose{rotation_exp(Vec3(0.0, 0.0, 0.5 * M_PI)), Vec3::Zero()}},
                        {ball, Pose{Mat3::Identity(), Vec3(0.4, 0.0, 0.0)}}});
}

}  // namespace

TEST_CASE("a solid with a formula passes triangles when points of theirs are in it, and not before") {
  Random random(20261201);
  const SharedShape shapes[] = {Sphere{0.5},         Capsule{0.2, 0.4}, cylinder(0.4, 0.5),
                                cylinder(0.6, 0.05), cone(0.4, 0.8),    dumbbell()};
  int clear = 0, clear_and_said = 0, passed = 0, deep = 0;
  for (const TriangleMesh& mesh : {bumpy_sphere(1), sheet(1.0, 2), box(Vec3(0.5, 0.01, 0.5)), torus(0.6, 0.2, 8, 6)}) {
    const SurfaceMesh surface{mesh, make_topology(mesh)};
    const PathSurface of_mesh(surface);
    for (int trial = 0; trial < 800; ++trial) {
      const Shape& shape = *shapes[trial % 6];
      const double way = std::pow(10.0, random.in(-2.0, 0.5)), turn = std::pow(10.0, random.in(-2.0, 0.0));
      SurfacePath own, other;
      other.of = &of_mesh;
      const Vec3 at = mesh.vertices[static_cast<std::size_t>(random.below(static_cast<int>(mesh.vertices.size())))];
      own.poses =
          path(random, {random.rotation(), at + random.in(0.2, 1.1) * shape.bounding_radius() * random.direction()},
               way, trial % 3 == 0 ? 0.0 : turn, 1 << (trial % 3));
      other.poses =
          path(random, {}, trial % 2 == 0 ? 0.0 : 0.3 * way, trial % 4 == 1 ? 0.1 * turn : 0.0, 1 << (trial % 2));
      if (!begin_apart(shape, own, other)) continue;
      PassageSettings settings;
      settings.depth = std::pow(10.0, random.in(-5.0, -3.0)), settings.reach = std::pow(10.0, random.in(-5.0, -3.0));
      const auto found = first_solid_passages(shape, own, other, settings);
      CAPTURE(trial, shape.name(), way, turn, settings.depth, settings.reach);
      REQUIRE(found.has_value());
      const double first = found->empty() ? 1.0 : found->front().time;
      double deepest = -INFINITY, after = -INFINITY;
      for (int k = 0; k <= kLooksAtWay; ++k) {
        const double t = static_cast<double>(k) / kLooksAtWay, now = deepest_at(t, shape, own, other);
        (t <= first ? deepest : after) = std::max(t <= first ? deepest : after, now);
      }
      CAPTURE(first, deepest, after);
      // paths are as straight as `reach` says, and so is what is between two looks
      CHECK(deepest <= settings.depth + 2.0 * settings.reach);
      CHECK(deepest_at(1.0, shape, own, other) <= (found->empty() ? settings.depth + 1e-9 : INFINITY));
      if (std::max(deepest, after) > settings.depth + 2.0 * settings.reach) ++deep;
      if (std::max(deepest, after) < -0.1) ++clear, clear_and_said += found->empty() ? 1 : 0;
      for (const Passage& p : *found) {
        ++passed;
        CHECK(p.approach > 0.0);
        CHECK(p.time <= first + 2e-3);
        CHECK(std::abs(p.normal.norm() - 1.0) < 1e-9);
        // the places are on the two surfaces when it begins; of what rolls on a face, in its plane
        CHECK(std::abs(shape.signed_distance(own.pose_at(0.0).apply_inverse(p.point_a))) < 0.01);
        const Triangle& c = mesh.triangles[p.triangle_b];
        const TriangleCorners corners = {mesh.vertices[c[0]], mesh.vertices[c[1]], mesh.vertices[c[2]]};
        const Vec3 place = other.pose_at(0.0).apply_inverse(p.point_b);
        const Vec3 across = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
        if (features_of_key(p.feature).kind_a == Feature::shape)
          CHECK(std::abs(across.dot(place - corners[0])) < 1e-6);
        else
          CHECK(closest_on_triangle(place, corners).squared_distance < 1e-12);
      }
    }
  }
  CAPTURE(clear, clear_and_said, passed, deep);
  CHECK(clear > 100);
  CHECK(clear_and_said == clear);
  CHECK(deep > 100);
  CHECK(passed >= deep);
}

TEST_CASE("a ball that flies straight at a triangle passes it when its formula says, however fast it is") {
  const TriangleMesh mesh = sheet(1.0, 4);
  const SurfaceMesh surface{mesh, make_topology(mesh)};
  const PathSurface of_mesh(surface);
  const Sphere ball(0.05);
  for (const double way : {0.2, 1.0, 10.0, 1000.0, 1e5}) {
    SurfacePath own, other;
    other.of = &of_mesh;
    other.poses = {Pose(), Pose()};
    const double height = 0.1;
    own.poses = {Pose{Mat3::Identity(), Vec3(0.03, height, 0.07)},
                 Pose{Mat3::Identity(), Vec3(0.03, height - way, 0.07)}};
    PassageSettings settings;
    settings.depth = 1e-6, settings.reach = 1e-5;
    const auto found = first_solid_passages(ball, own, other, settings);
    REQUIRE(found.has_value());
    REQUIRE(!found->empty());
    CAPTURE(way);
    const double expected = (height - 0.05) / way;
    CHECK(found->front().time <= expected + 1e-12);
    CHECK(found->front().time * way > height - 0.05 - 1e-6);
    CHECK(found->front().normal.y() > 0.999999);
    CHECK((found->front().point_a - Vec3(0.03, height - 0.05, 0.07)).norm() < 1e-4);
  }
}
