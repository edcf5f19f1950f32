// Iterative constraint anticipation in whole simulations: stacked deformable cubes rest as they do with the exact
// response.
#include <catch2/catch.hpp>

#include "engine/world/judge.hpp"
#include "tests/support/mechanics/deformable_bodies.hpp"
#include "tests/support/mechanics/methods.hpp"

using namespace impinge;
using namespace impinge::test;

TEST_CASE("two stacked deformable cubes rest with iterative constraint anticipation as with the exact one") {
  for (const char* method : {"constraint_anticipation", "iterative_constraint_anticipation"}) {
    CAPTURE(method);
    World world;
    world.add_body(fixed_plane("floor", Vec3::UnitY(), 0));
    const SoftOptions options{1e6, 0.4, 1000.0, 0.01, "corotational"};
    world.add_body(soft_cube("lower", 0.2, 3, {0, 0.001, 0}, options));
    world.add_body(soft_cube("upper", 0.2, 2, {0.004, 0.202, 0.004}, options));
    world.parameters.response.method = method;
    set(world, "response.iterative_constraint_anticipation.factorizes", "false");
    world.parameters.simulation.substeps = 2;
    world.parameters.simulation.sleeping = false;
    world.start();
    for (int i = 0; i < 150; ++i) world.step();
    double weight = 0.0, force = 0.0;
    for (const Body& body : world.bodies()) weight += body.kind() == BodyKind::deformable ? 9.81 * body.mass : 0.0;
    const int frames = 20;
    for (int i = 0; i < frames; ++i) {
      world.step();
      force -= contact_force_on(world, 0).y() / frames;
    }
    CHECK(fastest_node(world) < 2e-3);
    CHECK(judge_overlap(world.bodies()).penetration < 1e-4 * 0.2);
    CHECK(force == Approx(weight).epsilon(1e-3));
  }
}
