// How thick what a solid is made of is.
#include "engine/shapes/wall.hpp"

#include <catch2/catch.hpp>

#include "engine/shapes/primitives.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/geometry/shapes.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

double wall_of_mesh(TriangleMesh mesh) { return wall_of(*SharedShape(surface(std::move(mesh)))); }

}  // namespace

TEST_CASE("a hollow body is as thick as its wall, a compact one as its smallest side", "[shapes]") {
  // 2 V / A of a shell: 2/3 (R³ - r³) / (R² + r²), which its flat triangles come near
  for (const double wall : {1e-4, 1e-3, 1e-2}) {
    const double r = 0.2 - wall, exact = 2.0 / 3.0 * (0.008 - r * r * r) / (0.04 + r * r);
    TriangleMesh shell = icosphere(4, 0.2);
    append(shell, inside_out(icosphere(4, r)));
    CHECK(wall_of_mesh(std::move(shell)) == Approx(exact).epsilon(0.01));
    CHECK(exact == Approx(wall).epsilon(0.06));
  }
  CHECK(wall_of_mesh(box(Vec3(0.5, 0.001, 0.4), {4, 1, 4})) == Approx(0.002).epsilon(1e-12));
  CHECK(wall_of_mesh(icosphere(3, 0.1)) == Approx(0.2).epsilon(0.01));
  CHECK(wall_of_mesh(box(Vec3(0.1, 0.1, 0.1), {1, 1, 1})) == Approx(0.2));
  CHECK(wall_of(*SharedShape(Box{Vec3(0.1, 0.2, 0.3)})) == Approx(0.2));
}
