// What a walk down the discs of a surface leaves out holds nothing that a solid could touch: held against a look at every
// triangle.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "engine/detection/contacts/edge_cone.hpp"
#include "engine/detection/pairs/touched_triangles.hpp"
#include "engine/geometry/convex/convex_gap.hpp"
#include "engine/geometry/convex/convex_point.hpp"
#include "engine/geometry/convex/convex_triangle.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/geometry/sample_shapes.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// Smooth, folded, sharp, cut into needles, open.
std::vector<MeshPointer> surfaces() {
  TriangleMesh crumpled = icosphere(4);
  Random random(3);
  for (Vec3& x : crumpled.vertices) x += 0.02 * random.vector();
  return {surface(icosphere(4)),
          surface(bumpy_sphere(5)),
          surface(bumpy_torus(60, 30)),
          surface(crumpled),
          surface(sheet(1.0, 30)),
          surface(box(Vec3(1, 0.3, 0.6), {20, 3, 20})),
          surface(box(Vec3(1, 1e-3, 0.6), {40, 1, 40}))};
}

bool has(const std::vector<int>& sorted, int t) { return std::binary_search(sorted.begin(), sorted.end(), t); }

/// Whether nothing of the surface beside the feature is nearer to what lies along r from it.
bool is_nearest_of_all_round(const SurfaceView& view, const SurfaceFeature& feature, const Vec3& r) {
  std::vector<Vec3> star;
  view.star(feature, star);
  return std::all_of(star.begin(), star.end(), [&](const Vec3& e) { return r.dot(e) <= 1e-9 * r.norm(); });
}

}  // namespace

TEST_CASE("every place that is nearest to a point of all round it is among the triangles seen from there") {
  Random random(11);
  std::size_t places = 0, found_all = 0, asked = 0;
  for (const MeshPointer& mesh : surfaces()) {
    ColliderSet set;
    set.add(mesh);
    for (int i = 0; i < 150; ++i) {
      Pose pose = random_pose(random, 0.5);
      if (i % 5 == 4) pose.position += Vec3(1e4, -2e3, 3e4);
      set.place(0, pose);
      const SurfaceView view(set[0], 0);
      const int count = static_cast<int>(mesh->mesh.triangles.size());
      // anywhere, and very near to the surface on either side
      const int near = random.below(count);
      const Vec3 x = i % 2 == 0 ? Vec3(pose.position + 1.2 * random.vector())
                                : Vec3(view.corners(near)[0] + std::pow(10.0, random.in(-9, -1)) * random.direction());
      const double reach = std::pow(10.0, random.in(-3.0, 0.2));
      for (const bool and_nearest : {false, true}) {
        const std::vector<int> seen = triangles_seen_from(set[0], x, reach, and_nearest);
        REQUIRE(std::is_sorted(seen.begin(), seen.end()));
        found_all += seen.size(), asked += static_cast<std::size_t>(count);
        double least = INFINITY;
        int nearest = -1;
        for (int t = 0; t < count; ++t) {
          const PointTriangle p = closest_on_triangle(x, view.corners(t));
          if (p.squared_distance < least) least = p.squared_distance, nearest = t;
          if (!(p.squared_distance <= reach * reach)) continue;
          const SurfaceFeature feature = view.feature(t, p.feature);
          const Vec3 r = x - p.point;
          if (!is_nearest_of_all_round(view, feature, r)) continue;
          if (!and_nearest && mesh->topology.is_closed() && r.dot(view.normal(feature)) < 0.0) continue;
          ++places;
          REQUIRE(has(seen, t));
        }
        if (and_nearest) REQUIRE(has(seen, nearest));
      }
    }
  }
  CHECK(places > 1'000);
  CHECK(found_all < asked / 20);
}

TEST_CASE("every edge and corner that stands out towards a segment is among the triangles seen from there") {
  Random random(12);
  std::size_t edges = 0, corners = 0;
  for (const MeshPointer& mesh : surfaces()) {
    ColliderSet set;
    set.add(mesh);
    for (int i = 0; i < 150; ++i) {
      set.place(0, random_pose(random, 0.5));
      const SurfaceView view(set[0], 0);
      // mostly along the surface, in front of it
      const int near = random.below(static_cast<int>(mesh->mesh.triangles.size()));
      const double reach = std::pow(10.0, random.in(-2.0, 0.0));
      const Vec3 n = view.face_normal(near), along = n.cross(random.direction()).normalized();
      const Vec3 p = view.corners(near)[0] + random.in(0.1, 1.0) * reach * n;
      const Vec3 q = p + std::pow(10.0, random.in(-1.5, 0.3)) * (along + 0.1 * random.vector());
      const std::vector<int> seen = triangles_seen_from(set[0], p, q, reach);
      for (int e = 0; e < static_cast<int>(mesh->topology.edges.size()); ++e) {
        const MeshTopology::Edge& edge = view.edge(e);
        const SegmentSegment s = closest_between_segments(p, q, view.vertex(edge.v0), view.vertex(edge.v1));
        if (!s.interior || !(s.squared_distance <= reach * reach)) continue;
        const std::optional<EdgeCone> cone = make_edge_cone(view, e);
        if (!cone || !cone->is_outward((s.point0 - s.point1).normalized())) continue;
        ++edges;
        REQUIRE((has(seen, edge.triangle0) || has(seen, edge.triangle1)));
      }
      for (int v = 0; v < static_cast<int>(mesh->mesh.vertices.size()); ++v) {
        const PointSegment s = closest_on_segment(view.vertex(v), p, q);
        const Vec3 r = s.point - view.vertex(v);
        if (!(s.squared_distance <= reach * reach) || !is_nearest_of_all_round(view, {Feature::vertex, v}, r)) continue;
        if (r.dot(view.normal({Feature::vertex, v})) <= 0.0) continue;
        ++corners;
        const std::span<const int> round = view.triangles_round(v);
        REQUIRE(std::any_of(round.begin(), round.end(), [&](int t) { return has(seen, t); }));
      }
    }
  }
  CHECK(edges > 200);
  CHECK(corners > 100);
}

TEST_CASE("every triangle in reach of a solid is among those that the discs lead to") {
  Random random(13);
  std::size_t in_reach = 0, found_all = 0, asked = 0;
  const std::vector<SharedShape> solids = {Sphere{0.2}, Box{Vec3(0.2, 0.1, 0.3)}, Capsule{0.1, 0.3},
                                           made("cylinder", {{"radius", 0.2}, {"length", 0.3}}),
                                           made("cone", {{"radius", 0.2}, {"length", 0.4}})};
  for (const MeshPointer& mesh : surfaces()) {
    ColliderSet set;
    set.add(mesh);
    for (int i = 0; i < 40; ++i) {
      set.place(0, random_pose(random, 0.5));
      const SurfaceView view(set[0], 0);
      const SharedShape& shape = solids[static_cast<std::size_t>(i) % solids.size()];
      const auto& set_of = *std::get<const ConvexSet*>(shape->form());
      const Pose pose = random_pose(random, 1.2);
      const double reach = std::pow(10.0, random.in(-4.0, -0.5));
      const Aabb around = shape->bounds(pose).inflated(reach);
      const SolidFrame solid{pose, &set_of, [&](const Vec3& x) { return shape->signed_distance(x); }};
      const std::vector<int> found = triangles_within(set[0], around, solid, reach);
      found_all += found.size();
      const int count = static_cast<int>(mesh->mesh.triangles.size());
      asked += static_cast<std::size_t>(count);
      for (int t = 0; t < count; ++t) {
        if (!overlap(triangle_bounds(view, t), around)) continue;
        const TriangleCorners c = view.corners(t);
        const ConvexTriangle triangle({Vec3::Zero(), c[1] - c[0], c[2] - c[0]});
        const ConvexGap gap = convex_gap({&set_of, pose}, {&triangle, {Mat3::Identity(), c[0]}}, 2.0 * reach);
        if (!gap.is_within_reach || gap.gap > reach) continue;
        ++in_reach;
        REQUIRE(has(found, t));
      }
    }
  }
  CHECK(in_reach > 1'000);
  CHECK(found_all < asked / 10);
}

TEST_CASE("every place where a solid rests on a mesh, and the nearest of all, is among the triangles it may touch") {
  Random random(14);
  std::size_t places = 0, found_all = 0, within_all = 0, left_out = 0, poses = 0;
  const std::vector<SharedShape> solids = {
      Box{Vec3(0.3, 0.1, 0.4)}, made("cylinder", {{"radius", 0.3}, {"length", 0.3}}),
      made("cone", {{"radius", 0.3}, {"length", 0.4}}), made_hull(icosphere(1, 0.4).vertices),
      made_hull(box_corners(Vec3(0.5, 0.4, 0.05)))};
  std::vector<std::pair<MeshPointer, int>> meshes;  // and how many poses
  for (const MeshPointer& mesh : surfaces()) meshes.emplace_back(mesh, 20);
  for (const double bump : {0.0, 0.002, 0.02}) {  // fine: thousands of triangles under a solid
    TriangleMesh hill = sheet(0.7, 150);
    for (Vec3& x : hill.vertices)
      x.y() += bump * std::sin(9.0 * x.x() + 4.0 * x.z()) * std::cos(7.0 * x.z()) - 0.15 * x.squaredNorm();
    meshes.emplace_back(surface(hill), 150);
  }
  meshes.emplace_back(surface(box(Vec3(2, 0.1, 2), {100, 1, 100})), 40);
  for (const auto& [mesh, count_of_poses] : meshes) {
    ColliderSet set;
    set.add(mesh);
    const int count = static_cast<int>(mesh->mesh.triangles.size());
    for (int i = 0; i < count_of_poses; ++i) {
      set.place(0, random_pose(random, 0.5));
      const SurfaceView view(set[0], 0);
      const SharedShape& shape = solids[static_cast<std::size_t>(i) % solids.size()];
      const auto& set_of = *std::get<const ConvexSet*>(shape->form());
      // flush with a face or anyhow, a little above the surface or a little in it
      const int below = random.below(count);
      const Vec3 n = view.face_normal(below);
      Pose pose = random_pose(random, 0.0);
      if (i % 2 == 0) pose.rotation = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitY(), n).toRotationMatrix();
      const double activation = std::pow(10.0, random.in(-5.0, -2.0)), reach = activation * random.in(1.0, 3.0);
      const auto gap_of_triangle = [&](int t, double within) {
        const TriangleCorners c = view.corners(t);
        const ConvexTriangle triangle({Vec3::Zero(), c[1] - c[0], c[2] - c[0]});
        return convex_gap({&set_of, pose}, {&triangle, {Mat3::Identity(), c[0]}}, within);
      };
      // from far out along the normal down to a given height
      pose.position = view.corners(below)[0] + 0.6 * n;
      for (int step = 0; step < 60; ++step) {
        double least = 1.0;
        for (int t = 0; t < count; ++t)
          if (overlap(triangle_bounds(view, t), shape->bounds(pose).inflated(least)))
            if (const ConvexGap gap = gap_of_triangle(t, least); gap.is_within_reach) least = std::min(least, gap.gap);
        const double wanted = (i % 3 == 0 ? -0.3 : 0.5) * activation;
        if (least <= activation && least >= -activation) break;
        pose.position -= (least - wanted) * n;
      }
      TouchingSolid solid;
      solid.frame = {pose, &set_of, [&](const Vec3& x) { return shape->signed_distance(x); }};
      solid.outward = [&](const Vec3& x) {
        const ConvexPoint point;
        const ConvexGap gap = convex_gap({&set_of, {}}, {&point, {Mat3::Identity(), x}});
        return Vec3(-gap.normal);
      };
      if (set_of.polyhedron() != nullptr) solid.corners = set_of.polyhedron()->vertices();
      const Aabb around = shape->bounds(pose).inflated(reach);
      const TouchedTriangles touched = touched_triangles(set[0], around, solid, {reach, activation, i % 4 == 1}, {});
      REQUIRE(std::is_sorted(touched.triangles.begin(), touched.triangles.end()));
      const std::vector<int> within = triangles_within(set[0], around, solid.frame, reach);
      if (touched.is_all) CHECK(touched.triangles == within);
      found_all += touched.triangles.size(), within_all += within.size(), ++poses;
      left_out += touched.is_all ? 0 : 1;
      double least = INFINITY, least_found = INFINITY;
      for (const int t : within) {
        const ConvexGap gap = gap_of_triangle(t, reach);
        if (!gap.is_within_reach) continue;
        const bool is_found = has(touched.triangles, t);
        least = std::min(least, gap.gap);
        if (is_found) least_found = std::min(least_found, gap.gap);
        if (gap.gap > activation || gap.gap < 1e-9) continue;
        const PointTriangle p = closest_on_triangle(gap.point_b, view.corners(t));
        const SurfaceFeature feature = view.feature(t, p.feature);
        if (feature.kind != Feature::vertex) continue;
        std::vector<Vec3> star;
        view.star(feature, star);
        if (std::any_of(star.begin(), star.end(), [&](const Vec3& e) { return gap.normal.dot(e) > -1e-6; })) continue;
        ++places;
        REQUIRE(is_found);
      }
      if (least <= activation) REQUIRE(least_found <= least + 1e-9);
    }
  }
  CAPTURE(places, left_out, poses, found_all, within_all);
  CHECK(places > 200);
  CHECK(left_out > poses / 5);
  CHECK(found_all < within_all / 10);
}
