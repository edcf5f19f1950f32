#include "engine/geometry/surface/thickened_surface.hpp"

#include <catch2/catch.hpp>

#include "engine/geometry/inside.hpp"
#include "engine/geometry/mass_properties.hpp"
#include "engine/geometry/surface/mesh_checks.hpp"
#include "tests/support/geometry/meshes.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

bool is_solid(const TriangleMesh& mesh) { return !check_mesh(mesh, make_topology(mesh)); }

/// A strip of `cells` quads round the y axis that turns by `half_turns` half turns on its way.
TriangleMesh strip(int cells, int half_turns) {
  TriangleMesh mesh;
  for (int i = 0; i < cells; ++i)
    for (const double s : {-0.1, 0.1}) {
      const double a = 2.0 * M_PI * i / cells, b = 0.5 * half_turns * a;
      const double r = 1.0 + s * std::cos(b);
      mesh.vertices.emplace_back(r * std::cos(a), s * std::sin(b), r * std::sin(a));
    }
  for (int i = 0; i < cells; ++i) {
    const bool last = i + 1 == cells, swaps = last && half_turns % 2 != 0;
    const int p = 2 * i, q = 2 * i + 1, r = last ? (swaps ? 1 : 0) : 2 * i + 2, s = last ? (swaps ? 0 : 1) : 2 * i + 3;
    mesh.triangles.push_back({p, r, q});
    mesh.triangles.push_back({q, r, s});
  }
  return mesh;
}

}  // namespace

TEST_CASE("a flat sheet becomes a plate of its thickness, to both sides or behind its front", "[geometry]") {
  const TriangleMesh flat = sheet(0.5, 10);
  for (const SurfaceSides sides : {SurfaceSides::both, SurfaceSides::front}) {
    const TriangleMesh plate = thickened(flat, {sides, 0.02});
    CHECK(is_solid(plate));
    CHECK(signed_volume(plate) == Approx(1.0 * 0.02).epsilon(1e-12));
    double high = -1.0, low = 1.0;
    for (const Vec3& x : plate.vertices) high = std::max(high, x.y()), low = std::min(low, x.y());
    CHECK(high == Approx(sides == SurfaceSides::both ? 0.01 : 0.0).margin(1e-15));
    CHECK(low == Approx(sides == SurfaceSides::both ? -0.01 : -0.02).margin(1e-15));
    for (std::size_t t = 0; t < flat.triangles.size(); ++t) {  // the sheet's own triangles come first
      Vec3 of_sheet = Vec3::Zero(), of_plate = Vec3::Zero();
      for (int k = 0; k < 3; ++k)
        of_sheet += flat.vertices[flat.triangles[t][k]], of_plate += plate.vertices[plate.triangles[t][k]];
      CHECK(Vec3(of_sheet - of_plate).cwiseProduct(Vec3(1, 0, 1)).norm() < 1e-12);
    }
  }
}

TEST_CASE("a roof keeps its thickness at right angles to both its faces", "[geometry]") {
  TriangleMesh roof;
  for (const double z : {0.0, 1.0})
    for (const Vec3& x : {Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(1, 0, 0)}) roof.vertices.push_back(x + Vec3(0, 0, z));
  roof.triangles = {{0, 3, 1}, {1, 3, 4}, {1, 4, 2}, {2, 4, 5}};
  const double thickness = 0.1;
  const TriangleMesh solid = thickened(roof, {SurfaceSides::front, thickness});
  REQUIRE(is_solid(solid));
  // the ridge stands out by thickness / cos 45 degrees
  double lowest_ridge = 2.0;
  for (const Vec3& x : solid.vertices)
    if (std::abs(x.x()) < 1e-9) lowest_ridge = std::min(lowest_ridge, x.y());
  CHECK(lowest_ridge == Approx(1.0 - thickness * std::sqrt(2.0)).epsilon(1e-12));
}

TEST_CASE("sheets that meet in one edge, neighbours that face opposite ways and a Moebius strip become solids",
          "[geometry]") {
  TriangleMesh book;  // three pages
  book.vertices = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0.5}, {-0.5, 0.8, 0.5}, {-0.5, -0.8, 0.5}};
  book.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}};
  CHECK(is_solid(thickened(book, {SurfaceSides::both, 0.01})));

  TriangleMesh mixed = sheet(0.5, 4);
  for (std::size_t t = 0; t < mixed.triangles.size(); t += 3) std::swap(mixed.triangles[t][0], mixed.triangles[t][1]);
  const TriangleMesh plate = thickened(mixed, {SurfaceSides::both, 0.02});
  CHECK(is_solid(plate));
  CHECK(signed_volume(plate) == Approx(0.02).epsilon(1e-12));

  for (const int half_turns : {0, 1, 2, 3}) {
    CAPTURE(half_turns);
    const TriangleMesh band = strip(60, half_turns);
    const TriangleMesh solid = thickened(band, {SurfaceSides::both, 0.01});
    CHECK(is_solid(solid));
    double area = 0.0;
    for (const Triangle& t : band.triangles)
      area += 0.5 * (band.vertices[t[1]] - band.vertices[t[0]]).cross(band.vertices[t[2]] - band.vertices[t[0]]).norm();
    CHECK(signed_volume(solid) == Approx(0.01 * area).epsilon(0.02));
  }
}

TEST_CASE("points beside rough ground are in or out as its height says", "[geometry]") {
  Random random(5);
  TriangleMesh ground = sheet(0.5, 20);
  const auto height = [](double x, double z) { return 0.05 * std::sin(9.0 * x) * std::cos(7.0 * z); };
  for (Vec3& x : ground.vertices) x.y() = height(x.x(), x.z());
  for (const SurfaceSides sides : {SurfaceSides::both, SurfaceSides::front}) {
    const TriangleMesh solid = thickened(ground, {sides, 0.02});
    REQUIRE(is_solid(solid));
    const double above = sides == SurfaceSides::both ? 0.01 : 0.0;
    for (int i = 0; i < 300; ++i) {
      const double x = 0.45 * random.sym(), z = 0.45 * random.sym(), off = 0.03 * random.sym();
      const double middle = above - 0.01;
      const double to_face = 0.01 - std::abs(off - middle);  // inside: positive; vertical, so off by the slope
      if (std::abs(to_face) < 0.004) continue;
      const double winding = winding_number(Vec3(x, height(x, z) + off, z), solid.vertices, solid.triangles);
      CAPTURE(x, z, off);
      CHECK((winding > 0.5) == (to_face > 0.0));
    }
  }
}
