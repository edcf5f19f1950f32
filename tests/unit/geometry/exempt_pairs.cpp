#include "engine/geometry/surface/exempt_pairs.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "engine/geometry/distance.hpp"
#include "engine/geometry/triangle_intersection.hpp"
#include "tests/support/geometry/meshes.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// Two shells in one mesh, the second through the first.
TriangleMesh two_shells(Random& random) {
  TriangleMesh m = bumpy_sphere(2);
  const TriangleMesh other = bumpy_torus(16, 8);
  const int first = static_cast<int>(m.vertices.size());
  const Vec3 shift = 0.5 * random.vector();
  for (const Vec3& v : other.vertices) m.vertices.push_back(v + shift);
  for (const Triangle& t : other.triangles) m.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  return m;
}

TriangleCorners corners(const TriangleMesh& m, int t) {
  return {m.vertices[m.triangles[t][0]], m.vertices[m.triangles[t][1]], m.vertices[m.triangles[t][2]]};
}

}  // namespace

TEST_CASE("exempt pairs are those that cross or are near at rest, and of features those round them") {
  Random random(9);
  for (const double distance : {0.0, 0.02, 0.15}) {
    const MeshPointer mesh = surface(two_shells(random));
    const TriangleMesh& m = mesh->mesh;
    const ExemptPairs exempt(*mesh, distance);
    const int count = static_cast<int>(m.triangles.size());
    std::size_t expected = 0;
    int wrong = 0;
    for (int s = 0; s < count; ++s)
      for (int t = s + 1; t < count; ++t) {
        const Triangle &a = m.triangles[s], &b = m.triangles[t];
        const bool shares =
            std::any_of(a.begin(), a.end(), [&](int v) { return std::count(b.begin(), b.end(), v) > 0; });
        const bool is_near =
            !shares && (triangles_intersect(corners(m, s), corners(m, t)) ||
                        closest_features(corners(m, s), corners(m, t)).squared_distance <= distance * distance);
        expected += is_near ? 1 : 0;
        if (exempt.has(s, t) != is_near || exempt.has(t, s) != is_near) ++wrong;
        if (!is_near) continue;
        for (int k = 0; k < 3; ++k) {
          wrong += exempt.has_vertex(mesh->topology, a[k], t) ? 0 : 1;
          wrong +=
              exempt.has_edges(mesh->topology, mesh->topology.triangle_edges[s][k], mesh->topology.triangle_edges[t][k])
                  ? 0
                  : 1;
        }
      }
    CAPTURE(distance, expected);
    CHECK(expected > 20);
    CHECK(exempt.size() == expected);
    CHECK(wrong == 0);
  }
}
