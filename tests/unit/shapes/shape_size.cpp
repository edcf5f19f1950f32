// How large a solid is: closed forms of 6 V / A, and what must not change it.
#include <catch2/catch.hpp>

#include "engine/geometry/rotation.hpp"
#include "engine/shapes/shape_size.hpp"
#include "tests/support/geometry/sample_shapes.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

double size_of_mesh(TriangleMesh mesh) { return size_of(*SharedShape(surface(std::move(mesh)))); }

}  // namespace

TEST_CASE("the size of a solid is six times its volume by its surface") {
  CHECK(size_of(Sphere{0.3}) == Approx(0.6));
  CHECK(size_of(Box{Vec3(0.1, 0.1, 0.1)}) == Approx(0.2));
  CHECK(size_of(Box{Vec3(0.1, 0.2, 0.4)}) == Approx(3.0 / (1 / 0.2 + 1 / 0.4 + 1 / 0.8)));
  // a sheet: three times its thickness, a rod of square section: one and a half times its side
  CHECK(size_of(Box{Vec3(1, 0.0005, 1)}) == Approx(0.003).epsilon(0.01));
  CHECK(size_of(Box{Vec3(0.01, 3, 0.01)}) == Approx(0.03).epsilon(0.01));
  CHECK(std::isinf(size_of(Plane{})));
  // cylinder r, l: 6 π r² l / (2 π r (r + l)), as drawn within a hundredth
  CHECK(size_of(*made("cylinder", {{"radius", 0.1}, {"length", 0.3}})) == Approx(3 * 0.1 * 0.3 / 0.4).epsilon(0.02));
  // capsule: 6 (4/3 π r³ + π r² l) / (4 π r² + 2 π r l)
  const double r = 0.1, l = 0.4;
  CHECK(size_of(Capsule{r, 0.5 * l}) == Approx(6 * (4 * r * r / 3 + r * l) / (4 * r + 2 * l)).epsilon(0.02));
}

TEST_CASE("a solid has the size of its triangles, however fine, and wherever it is turned to") {
  const Vec3 half(0.1, 0.02, 0.3);
  const double expected = size_of(Box{half});
  for (const int cells : {1, 4, 9}) CHECK(size_of_mesh(box(half, {cells, cells + 1, 2 * cells})) == Approx(expected));
  CHECK(size_of_mesh(icosphere(5, 0.1)) == Approx(0.2).epsilon(0.01));
  TriangleMesh turned = box(half);
  for (Vec3& x : turned.vertices) x = rotation_from_degrees(Vec3(33, 71, -20)) * x + Vec3(3, -1, 2);
  CHECK(size_of_mesh(turned) == Approx(expected));
  CHECK(size_of(*made_hull(box_corners(half))) == Approx(expected));
}

TEST_CASE("a solid of s times the lengths has s times the size") {
  for (const double s : {1e-3, 100.0}) {
    TriangleMesh mesh = bumpy_torus(24, 12), scaled = mesh;
    for (Vec3& x : scaled.vertices) x *= s;
    CHECK(size_of_mesh(scaled) == Approx(s * size_of_mesh(mesh)).epsilon(1e-12));
    CHECK(size_of(*made("cone", {{"radius", 0.1 * s}, {"length", 0.3 * s}})) ==
          Approx(s * size_of(*made("cone", {{"radius", 0.1}, {"length", 0.3}}))).epsilon(1e-12));
  }
}

TEST_CASE("a surface that encloses nothing has the size of the cube of its area") {
  CHECK(size_of_mesh(sheet(0.5, 3)) == Approx(std::sqrt(1.0 / 6.0)));
}
