// Books that hang over a table as far as statics lets them: the right ends of n books, from the top, are L/2, L/4, L/6, ...
// beyond the next, and stand if each is drawn back a little. Their edges cross the table's edge and each other's at gaps of
// rounding, either sign of it, in every sub-step.
#include <catch2/catch.hpp>

#include "tests/support/geometry/meshes.hpp"
#include "tests/support/mechanics/worlds.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

constexpr double kBookLength = 1.0, kBookThickness = 0.1, kBookDepth = 0.6;  // m

/// `share` of the largest overhang, of a table that is a box or its triangles.
void books(int count, double share, bool table_is_mesh, int substeps, World& world) {
  world.parameters.simulation.sleeping = false;
  world.parameters.simulation.substeps = substeps;
  world.parameters.contact.friction = 0.6;
  const Vec3 half(2.0, 0.5, 1.0);
  BodyDescription table =
      dynamic_body("table", table_is_mesh ? SharedShape(make_box_mesh(half)) : SharedShape(Box{half}), {-2.0, -0.5, 0});
  table.kind = BodyKind::fixed;
  world.add_body(table);
  const MeshPointer book = make_box_mesh(0.5 * Vec3(kBookLength, kBookThickness, kBookDepth));
  double end = 0.0;  // of the book at hand, beyond the table
  for (int i = count; i >= 1; --i) {
    end += share * kBookLength / (2 * i);
    world.add_body(dynamic_body("book" + std::to_string(i), book,
                                Vec3(end - 0.5 * kBookLength, kBookThickness * (count - i + 0.5), 0.0)));
  }
  world.start();
}

}  // namespace

TEST_CASE("books of triangles hang over a table as far as statics lets them, and lie still") {
  for (const bool table_is_mesh : {false, true})
    for (const int count : {2, 3, 6, 10})
      for (const int substeps : {1, 4}) {
        CAPTURE(table_is_mesh, count, substeps);
        World world;
        books(count, 0.97, table_is_mesh, substeps, world);
        const double top = world.bodies()[count].pose.position.y();
        double kinetic = 0.0;  // J
        for (int frame = 0; frame < 120; ++frame) {
          world.step();
          kinetic = std::max(kinetic, world.record().stats.kinetic);
        }
        CHECK(kinetic < 1e-14);
        CHECK(world.bodies()[count].pose.position.y() == Approx(top).margin(1e-8));
      }
  for (const int count : {2, 3, 6, 10}) {
    CAPTURE(count);
    World world;
    books(count, 1.02, false, 4, world);
    run(world, 300);
    CHECK(world.bodies()[count].pose.position.y() < 0.0);
  }
}
