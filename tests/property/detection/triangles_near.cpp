// What the tree of a mesh finds is what a look at every triangle finds, at the origin and far from it, rigid or deforming.
#include "engine/detection/pairs/triangles_near.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "engine/geometry/box_tree.hpp"
#include "tests/support/geometry/meshes.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

std::vector<int> all_that(int count, const std::function<bool(int)>& holds) {
  std::vector<int> found;
  for (int t = 0; t < count; ++t)
    if (holds(t)) found.push_back(t);
  return found;
}

}  // namespace

TEST_CASE("triangles near a box and round a point are those that a look at each finds") {
  Random random(7);
  std::size_t near_boxes = 0, asked = 0;
  std::vector<Aabb> node_boxes;
  for (const MeshPointer& mesh :
       {surface(icosphere(4)), surface(bumpy_torus(60, 30)), surface(box(Vec3(3, 1e-3, 2), {40, 1, 40}))}) {
    ColliderSet set;
    set.add(mesh);
    const int count = static_cast<int>(mesh->mesh.triangles.size());
    REQUIRE(count > 1000);
    for (int i = 0; i < 200; ++i) {
      Pose pose = random_pose(random, 0.5);
      if (i % 4 == 3) pose.position += Vec3(1e5, -2e4, 3e5);
      set.place(0, pose);
      if (i % 2 == 1) {  // as a deforming one, bent
        std::vector<Vec3> bent(set[0].vertices.begin(), set[0].vertices.end());
        for (Vec3& x : bent) x += 0.1 * std::sin(3.0 * x.x()) * Vec3::UnitY() + 0.01 * random.vector();
        set.place(0, std::move(bent));
        mesh->tree().fit(triangle_boxes(mesh->mesh.triangles, set[0].vertices), node_boxes);
        set[0].node_boxes = node_boxes;
      } else {
        set[0].node_boxes = {};
      }
      const Collider& body = set[0];
      const SurfaceView view(body, 0);
      const Vec3 center = pose.position + 1.2 * random.vector();
      const double size = std::pow(10.0, random.in(-4.0, 0.0));
      const Aabb around = Aabb{center, center}.inflated(size);
      const std::vector<int> expected =
          all_that(count, [&](int t) { return overlap(triangle_bounds(view, t), around); });
      REQUIRE(triangles_near(body, around) == expected);
      near_boxes += expected.size();

      double least = INFINITY;
      std::vector<double> distance(static_cast<std::size_t>(count));
      for (int t = 0; t < count; ++t) {
        distance[t] = closest_on_triangle(center, view.corners(t)).squared_distance;
        least = std::min(least, distance[t]);
      }
      for (const bool and_nearest : {false, true}) {
        const std::vector<int> found = triangles_round(body, center, size, and_nearest);
        CHECK(std::is_sorted(found.begin(), found.end()));
        asked += found.size();
        for (int t = 0; t < count; ++t)
          if (distance[t] <= size * size || (and_nearest && distance[t] == least))
            REQUIRE(std::binary_search(found.begin(), found.end(), t));
      }
    }
  }
  CHECK(near_boxes > 10'000);
  CHECK(asked < 600 * 2 * 1500);  // and not simply all
}
