// Delta debugging against what it promises, and the meshes that stand in the place of others.
#include "viewer/shrink/fewest.hpp"

#include <catch2/catch.hpp>

#include <set>

#include "engine/geometry/aabb.hpp"
#include "engine/geometry/surface/mesh_checks.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/random.hpp"
#include "viewer/shrink/smaller_mesh.hpp"

using namespace impinge;
using namespace impinge::test;

TEST_CASE("the fewest of many: what is needed is found, in few questions") {
  Random random(16);
  for (int trial = 0; trial < 300; ++trial) {
    const int n = random.below(60);
    std::set<int> needed;
    for (int k = n == 0 ? 0 : random.below(4); k > 0; --k) needed.insert(random.below(n));
    std::vector<int> all(static_cast<std::size_t>(n));
    for (int i = 0; i < n; ++i) all[static_cast<std::size_t>(i)] = i;
    int asked = 0;
    const std::vector<int> left = fewest<int>(all, [&](const std::vector<int>& some) {
      ++asked;
      CHECK(std::is_sorted(some.begin(), some.end()));
      return std::includes(some.begin(), some.end(), needed.begin(), needed.end());
    });
    CHECK(left == std::vector<int>(needed.begin(), needed.end()));
    CHECK(asked <= n * n + 4 * n + 2);
  }
}

TEST_CASE("of the fewest no single one can be left out, whatever is asked of them") {
  Random random(17);
  for (int trial = 0; trial < 200; ++trial) {
    const int n = 1 + random.below(24), seed = random.below(1000000);
    // an answer to each part that follows no rule, but yes to the whole
    const auto holds = [&](const std::vector<int>& some) {
      std::size_t hash = static_cast<std::size_t>(seed);
      for (const int i : some) hash = (hash ^ static_cast<std::size_t>(i + 1)) * 0x9e3779b97f4a7c15u;
      return static_cast<int>(some.size()) == n || (hash >> 40) % 3 == 0;
    };
    std::vector<int> all(static_cast<std::size_t>(n));
    for (int i = 0; i < n; ++i) all[static_cast<std::size_t>(i)] = i;
    const std::vector<int> left = fewest<int>(all, holds);
    CHECK(holds(left));
    for (std::size_t i = 0; i < left.size() && left.size() > 1; ++i) {
      std::vector<int> less = left;
      less.erase(less.begin() + static_cast<std::ptrdiff_t>(i));
      CHECK_FALSE(holds(less));
    }
  }
}

TEST_CASE("what stands in a mesh's place has fewer triangles and lies within its box") {
  const TriangleMesh mesh = icosphere(3);
  const std::vector<TriangleMesh> all = smaller_meshes(mesh);
  REQUIRE(all.size() > 4);
  Aabb box;
  for (const Vec3& x : mesh.vertices) box.include(x);
  CHECK(all.front().triangles.size() == 12);
  CHECK_FALSE(check_mesh(all.front(), make_topology(all.front())));
  std::size_t before = 0;
  for (const TriangleMesh& small : all) {
    CHECK(small.triangles.size() >= before);
    CHECK(small.triangles.size() < mesh.triangles.size());
    before = small.triangles.size();
    for (const Vec3& x : small.vertices) CHECK(((x - box.min).minCoeff() > -1e-9 && (box.max - x).minCoeff() > -1e-9));
  }
}

TEST_CASE("a mesh falls into the parts that share no vertex") {
  TriangleMesh two = icosphere(1);
  const TriangleMesh one = two;
  for (const Vec3& x : one.vertices) two.vertices.push_back(x + Vec3(5, 0, 0));
  for (const Triangle& t : one.triangles) {
    const int n = static_cast<int>(one.vertices.size());
    two.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  }
  const std::vector<std::vector<int>> parts = connected_parts(two);
  REQUIRE(parts.size() == 2);
  for (const std::vector<int>& part : parts) {
    const TriangleMesh mesh = with_triangles(two, part);
    CHECK(mesh.triangles.size() == one.triangles.size());
    CHECK(mesh.vertices.size() == one.vertices.size());
    CHECK_FALSE(check_mesh(mesh, make_topology(mesh)));
  }
}
