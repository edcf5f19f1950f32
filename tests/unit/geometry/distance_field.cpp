// Fields of distances against a look at every triangle: a bound that is above the distance by a hair would lose contacts.
#ifdef IMPINGE_OPENVDB
#include "engine/geometry/distance_field.hpp"

#include <catch2/catch.hpp>

#include "engine/core/parallel.hpp"
#include "engine/geometry/distance.hpp"
#include "engine/geometry/inside.hpp"
#include "tests/support/geometry/meshes.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

// a needle beside a large triangle, and one without area
TriangleMesh awkward_triangles() {
  return {{{-1, 0, 0}, {1, 0, 0}, {1, 1e-4, 0}, {-1, -1, 0.5}, {1, -1, 0.5}, {0, 1, 0.5}, {0, 0, -1}, {0, 0, 1}},
          {{0, 1, 2}, {3, 4, 5}, {6, 7, 7}}};
}

// How many points in the mesh's box have a bound above 0.
int check_bounds(const TriangleMesh& mesh, std::size_t most_voxels, std::uint64_t seed) {
  const MeshPointer of = surface(mesh);
  const DistanceField field(*of, most_voxels);
  CAPTURE(seed, most_voxels, field.voxels(), field.voxel_size());
  CHECK(field.voxels() <= most_voxels);
  CHECK(field.voxels() > 0);
  Aabb box;
  for (const Vec3& v : mesh.vertices) box.include(v);
  const double size = box.extent().maxCoeff(), rounding = 1e-6 * size;
  Random random(seed);
  DistanceField::Reader reader(field);
  int near = 0, told = 0;
  for (int i = 0; i < 3000; ++i) {
    // in the band, for the greater part: away from a point of a triangle by as much as it may be wide
    const Triangle& t = mesh.triangles[random.below(static_cast<int>(mesh.triangles.size()))];
    const double u = random.in(0.0, 1.0), v = random.in(0.0, 1.0 - u);
    const Vec3 on = mesh.vertices[t[0]] + u * (mesh.vertices[t[1]] - mesh.vertices[t[0]]) +
                    v * (mesh.vertices[t[2]] - mesh.vertices[t[0]]);
    const double reach = i % 3 == 0 ? size : 2.0 * field.reach();
    Vec3 x = on + reach * random.vector();
    if (i % 3 == 1) x = x.cwiseMax(box.min).cwiseMin(box.max);
    const double exact = distance_to_surface(x, mesh.vertices, mesh.triangles), bound = reader.at_least(x);
    CAPTURE(i, x.transpose(), exact, bound);
    REQUIRE(bound <= exact * (1.0 + 1e-12));
    if (squared_distance(box, x) > 0.0) continue;  // there the box alone tells
    // what the way to the voxel and back takes
    REQUIRE(bound >= std::min(exact - 2.0 * 0.8661 * field.voxel_size(), field.reach() - 0.8661 * field.voxel_size()) -
                         rounding);
    ++near, told += bound > 0.0;
  }
  CHECK(near > 200);
  return told;
}

}  // namespace

TEST_CASE("a distance field never says more than the distance, and little less", "[distance_field]") {
  const Vec3 far(1000.0, -2000.0, 500.0);
  TriangleMesh away = bumpy_torus(40, 20);
  for (Vec3& v : away.vertices) v += far;
  std::uint64_t seed = 4001;
  int told = 0;
  for (const TriangleMesh& mesh : {icosphere(3), bumpy_torus(60, 30), bumpy_sphere(4), sheet(1.0, 12),
                                   box(Vec3(1.0, 0.5, 0.01)), awkward_triangles(), away})
    for (const std::size_t most : {1000u, 20000u, 300000u}) told += check_bounds(mesh, most, seed++);
  CHECK(told > 10000);
}

TEST_CASE("a distance field has the same values for every number of threads, and a surface keeps the last one",
          "[distance_field]") {
  const MeshPointer of = surface(bumpy_torus(60, 30));
  set_thread_count(1);
  const DistanceField alone(*of, 50000);
  set_thread_count(4);
  const DistanceField together(*of, 50000);
  set_thread_count(0);
  CHECK(alone.voxels() == together.voxels());
  Random random(4101);
  DistanceField::Reader one(alone), four(together);
  for (int i = 0; i < 10000; ++i) {
    const Vec3 x(random.in(-1.5, 1.5), random.in(-1.5, 1.5), random.in(-1.5, 1.5));
    REQUIRE(one.at_least(x) == four.at_least(x));
  }
  const std::shared_ptr<const DistanceField> first = of->field(20000), again = of->field(20000),
                                             other = of->field(5000);
  CHECK(first == again);
  CHECK(first != other);
  CHECK(other->voxels() <= 5000);
  CHECK(first->voxels() > 5000);
}

#endif
