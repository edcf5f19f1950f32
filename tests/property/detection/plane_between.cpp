// Boxes on their way: what a plane is said to keep apart overlaps at no moment by more than it may, by brute force over all
// axes; and most of what stays clear is said to.
#include <catch2/catch.hpp>

#include <cmath>

#include "engine/detection/continuous/plane_between.hpp"
#include "engine/geometry/rotation.hpp"
#include "tests/support/geometry/brute_convex.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/geometry/rigid_paths.hpp"
#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

constexpr int kMoments = 60;

TriangleMesh placed(TriangleMesh mesh, const Pose& pose) {
  for (Vec3& x : mesh.vertices) x = pose.apply(x);
  return mesh;
}

}  // namespace

TEST_CASE("boxes that a plane is said to stand between overlap at no moment by more than they may") {
  Random random(20261126);
  int said = 0, clear = 0, touching = 0;
  for (int trial = 0; trial < 600; ++trial) {
    const Vec3 half = Vec3::Constant(0.3) + 0.25 * random.vector();
    const TriangleMesh mesh = box(half), other_mesh = box(Vec3(0.5, 0.02, 0.4));
    const SurfaceMesh surface{mesh, make_topology(mesh)}, other_surface{other_mesh, make_topology(other_mesh)};
    const PathSurface of_mesh(surface), of_other(other_surface);
    const double way = std::pow(10.0, random.in(-3.0, -0.3)), depth = std::pow(10.0, random.in(-4.0, -2.0));
    SurfacePath a, b;
    a.of = &of_mesh, b.of = &of_other;
    const double height = 0.02 + half.y() * random.in(0.9, 1.6);
    a.poses = path(random, {rotation_exp(random.in(0.0, 0.5) * random.vector()), Vec3(0, height, 0)}, way, way,
                   1 << (trial % 3));
    b.poses = path(random, {}, 0.3 * way, trial % 2 == 0 ? 0.0 : way, 1 << (trial % 2));
    const bool is_said = stays_beside(a, b, depth);
    double deepest = -INFINITY;
    for (int k = 0; k <= kMoments; ++k) {
      const double t = static_cast<double>(k) / kMoments;
      deepest = std::max(deepest, -brute_convex_gap(placed(mesh, a.pose_at(t)), placed(other_mesh, b.pose_at(t))).gap);
      if (!is_said && deepest > 0.0) break;  // nothing more to learn
    }
    CAPTURE(trial, way, depth, deepest);
    if (is_said) REQUIRE(deepest <= depth);
    said += is_said ? 1 : 0;
    touching += is_said && deepest > 0.0 ? 1 : 0;
    clear += deepest < 0.0 ? 1 : 0;
  }
  CAPTURE(said, clear, touching);
  CHECK(clear > 100);
  CHECK(said > clear / 2);
  CHECK(touching > 0);
}
