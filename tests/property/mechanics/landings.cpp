// Bodies that fall on a floor, tumbling, and bounce: where every piece of a sub-step ends their lowest point is known exactly,
// which shares nothing with contacts.
#include <catch2/catch.hpp>

#include "engine/geometry/convex/convex_set.hpp"
#include "engine/shapes/shape.hpp"
#include "engine/step/step_watcher.hpp"
#include "tests/support/geometry/sample_shapes.hpp"
#include "tests/support/mechanics/worlds.hpp"
#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// How deep bodies are under y = 0, metres.
struct Depths : StepWatcher {
  void moved(const Bodies& bodies, const SubStep&, MotionGuard&, const std::optional<UnsafeMotion>&,
             bool is_end) override {
    if (!is_end) return;
    for (const Body& body : bodies) {
      if (body.kind() != BodyKind::dynamic) continue;
      const ShapeForm form = body.shape->form();
      const ConvexSet& solid = *std::get<const ConvexSet*>(form);
      const Vec3 down = body.pose.rotation.transpose() * -Vec3::UnitY();
      deepest = std::max(deepest, -body.pose.apply(solid.support(down) + solid.rounding() * down).y());
    }
  }
  double deepest = 0.0;
};

void add_falling(World& world, const SharedShape& shape, double speed, std::uint64_t seed) {
  Random r(seed);
  for (int i = 0; i < 7; ++i)
    for (int k = 0; k < 7; ++k) {
      BodyDescription body = dynamic_body("b" + std::to_string(7 * i + k), shape, {0.7 * i, 0.4, 0.7 * k});
      body.rotation = 90.0 * r.vector();
      body.angular_velocity = 8.0 * r.vector();
      body.velocity = {0.0, -speed * r.u(), 0.0};
      world.add_body(body);
    }
}

}  // namespace

TEST_CASE("what falls tumbling on a floor ends no piece of a sub-step deep in it, and the figure says how deep") {
  const std::uint64_t seed = GENERATE(1, 2);
  const bool on_plane = GENERATE(false, true);
  const double restitution = GENERATE(0.0, 0.5), faster = GENERATE(1.0, 10.0);
  const std::vector<std::pair<const char*, SharedShape>> shapes = {
      {"box", Box(Vec3(0.1, 0.075, 0.05))},
      {"capsule", Capsule{0.05, 0.2}},
      {"cylinder", made("cylinder", {{"radius", 0.1}, {"length", 0.2}})},
      {"cone", made("cone", {{"radius", 0.1}, {"length", 0.2}})}};
  for (const auto& [name, shape] : shapes) {
    World world;
    world.parameters.simulation.sleeping = false;
    world.parameters.simulation.substeps = 2;
    world.parameters.contact.restitution = restitution;
    BodyDescription floor = fixed_plane("floor", Vec3::UnitY(), 0.0);
    if (!on_plane) {
      floor.shape = Box(Vec3(20.0, 0.5, 20.0));
      floor.position = {0.0, -0.5, 0.0};
    }
    world.add_body(floor);
    add_falling(world, shape, 5.0 * faster, seed);
    world.start();
    Depths depths;
    world.watch(&depths);
    double shown = 0.0;
    std::int64_t unsafe = 0;
    for (int frame = 0; frame < 24; ++frame) {
      world.step();
      shown = std::max(shown, world.record().stats.substep_penetration);
      unsafe += world.record().stats.unsafe_motions;
    }
    world.watch(nullptr);
    INFO(name << (on_plane ? " on a plane" : " on a box") << ", e = " << restitution << ", " << 5.0 * faster
              << " m/s, seed " << seed << ": deepest " << depths.deepest << " m, shown " << shown);
    CHECK(unsafe == 0);
    CHECK(depths.deepest < 3e-4);
    if (on_plane) continue;
    // the material that touched has risen by little where a capsule has rolled on
    if (depths.deepest > 1e-4) CHECK(shown > 0.5 * depths.deepest);
    if (shown > 1e-6) CHECK(shown < 2.0 * depths.deepest);
  }
}
