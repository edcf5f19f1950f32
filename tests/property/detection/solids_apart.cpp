// Convex solids on their way: what is said to stay apart overlaps at no moment by more than it may, as contacts see it then,
// or points all over triangles do; and most of what stays clear is said to.
#include <catch2/catch.hpp>

#include <cmath>

#include "engine/detection/continuous/solids_apart.hpp"
#include "engine/geometry/convex/convex_gap.hpp"
#include "engine/geometry/rotation.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/geometry/rigid_paths.hpp"
#include "tests/support/geometry/sample_shapes.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

constexpr int kMoments = 64;

bool is_one_solid(const Shape& shape) { return std::holds_alternative<const ConvexSet*>(shape.form()); }

double overlap(const Shape& a, const Pose& of_a, const Shape& b, const Pose& of_b) {
  return -convex_gap({std::get<const ConvexSet*>(a.form()), of_a}, {std::get<const ConvexSet*>(b.form()), of_b}).gap;
}

/// Of points all over the triangles, how deep the deepest is in the shape, metres.
double deepest_point(const Shape& shape, const TriangleMesh& mesh) {
  constexpr int kCuts = 12;
  double deepest = -INFINITY;
  for (const Triangle& t : mesh.triangles)
    for (int i = 0; i <= kCuts; ++i)
      for (int j = 0; i + j <= kCuts; ++j) {
        const double u = static_cast<double>(i) / kCuts, v = static_cast<double>(j) / kCuts;
        const Vec3 x = (1.0 - u - v) * mesh.vertices[t[0]] + u * mesh.vertices[t[1]] + v * mesh.vertices[t[2]];
        deepest = std::max(deepest, -shape.signed_distance(x));
      }
  return deepest;
}

}  // namespace

TEST_CASE("solids that are said to stay apart overlap at no moment by more than they may, whatever their shapes") {
  Random random(20261128);
  int said = 0, clear = 0, touching = 0;
  for (const ShapeEntry& of_a : shape_entries())
    for (const ShapeEntry& of_b : shape_entries())
      for (int trial = 0; trial < 12; ++trial) {
        const SharedShape a = sample_shape(random, of_a), b = sample_shape(random, of_b);
        if (!is_one_solid(*a) || !is_one_solid(*b)) continue;
        const double way = std::pow(10.0, random.in(-3.0, -0.3)), depth = std::pow(10.0, random.in(-4.0, -2.0));
        SurfacePath path_a, path_b;
        const Vec3 beside = random.in(0.5, 1.1) * (a->bounding_radius() + b->bounding_radius()) * random.direction();
        path_a.poses = path(random, {random.rotation(), beside}, way, way, 1 << (trial % 3));
        path_b.poses =
            path(random, {random.rotation(), Vec3::Zero()}, 0.3 * way, trial % 2 == 0 ? 0.0 : way, 1 << (trial % 2));
        const bool is_said = stay_apart(*a, path_a, *b, path_b, depth);
        double deepest = -INFINITY;
        for (int k = 0; k <= kMoments; ++k) {
          const double t = static_cast<double>(k) / kMoments;
          deepest = std::max(deepest, overlap(*a, path_a.pose_at(t), *b, path_b.pose_at(t)));
          if (!is_said && deepest > 0.0) break;  // nothing more to learn
        }
        CAPTURE(of_a.name, of_b.name, trial, way, depth, deepest);
        if (is_said) REQUIRE(deepest <= depth + 1e-9);
        said += is_said ? 1 : 0;
        touching += is_said && deepest > -0.01 ? 1 : 0;
        clear += deepest < -0.01 ? 1 : 0;
      }
  CAPTURE(said, clear, touching);
  CHECK(clear > 100);
  CHECK(said > 0.8 * clear);
  CHECK(touching > 0);
}

TEST_CASE("two solids that turn together as one are known to stay apart") {
  Random random(7);
  for (int trial = 0; trial < 60; ++trial) {
    const Box lower(Vec3(0.5, 0.2, 0.5));
    const SharedShape upper = trial % 2 == 0 ? cylinder(0.3, 0.4) : SharedShape(Box{Vec3(0.3, 0.2, 0.4)});
    SurfacePath of_lower, of_upper;
    const Vec3 turn = random.in(0.005, 0.05) * random.direction(), shift = random.in(0.0, 0.1) * random.vector();
    for (const double t : {0.0, 1.0}) {
      const Pose pose{rotation_exp(t * turn), t * shift};
      of_lower.poses.push_back(pose);
      of_upper.poses.push_back({pose.rotation, pose.apply(Vec3(0.1, 0.4 - 1e-7, 0.0))});
    }
    CAPTURE(trial, turn.norm());
    CHECK(stay_apart(lower, of_lower, *upper, of_upper, 2e-4));
  }
}

TEST_CASE("a solid that is said to stay off triangles has none of their points deeper in it than it may") {
  Random random(20261129);
  int said = 0, clear = 0, touching = 0, denied = 0;
  for (const ShapeEntry& entry : shape_entries())
    for (const TriangleMesh& mesh : {bumpy_sphere(1), sheet(1.0, 2), box(Vec3(0.5, 0.01, 0.5)), torus(0.6, 0.2, 8, 6)})
      for (int trial = 0; trial < 40; ++trial) {
        const SharedShape shape = sample_shape(random, entry);
        if (shape->mesh() != nullptr || shape->as<Plane>() != nullptr) continue;
        const SurfaceMesh surface{mesh, make_topology(mesh)};
        const PathSurface of_mesh(surface);
        const double way = std::pow(10.0, random.in(-3.0, -0.3)), depth = std::pow(10.0, random.in(-4.0, -2.0));
        SurfacePath own, other;
        other.of = &of_mesh;
        const Vec3 at = mesh.vertices[static_cast<std::size_t>(random.below(static_cast<int>(mesh.vertices.size())))];
        const Vec3 place = at + random.in(0.2, 1.2) * shape->bounding_radius() * random.direction();
        own.poses = path(random, {random.rotation(), place}, way, way, 1 << (trial % 3));
        other.poses =
            path(random, {}, trial % 2 == 0 ? 0.0 : 0.3 * way, trial % 4 == 1 ? 0.1 * way : 0.0, 1 << (trial % 2));
        const bool is_said = stay_off(*shape, own, other, depth);
        double deepest = -INFINITY;
        for (int k = 0; k <= kMoments / 4 && !(deepest > 0.0 && !is_said); ++k) {
          const double t = 4.0 * k / kMoments;
          TriangleMesh seen = mesh;
          const Pose of_own = own.pose_at(t), of_other = other.pose_at(t);
          for (Vec3& x : seen.vertices) x = of_own.apply_inverse(of_other.apply(x));
          deepest = std::max(deepest, deepest_point(*shape, seen));
        }
        CAPTURE(entry.name, trial, way, depth, deepest);
        if (is_said) REQUIRE(deepest <= depth + 1e-9);
        said += is_said ? 1 : 0, denied += is_said ? 0 : 1;
        touching += is_said && deepest > -0.01 ? 1 : 0;
        clear += deepest < -0.02 ? 1 : 0;
      }
  CAPTURE(said, clear, touching, denied);
  CHECK(clear > 100);
  CHECK(said > 0.9 * clear);
  CHECK(touching > 5);
  CHECK(denied > 100);
}
