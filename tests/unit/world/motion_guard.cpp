// What counts as a passage of rigid bodies whose edges slide through one another by little.
#include "engine/step/motion_guard.hpp"

#include <catch2/catch.hpp>

#include <cmath>

#include "engine/step/end_pose.hpp"
#include "engine/world/world.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/mechanics/worlds.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

const double kEdge = 0.5 * std::sqrt(2.0);  // of a cube of 1 m, from its centre, metres

/// A cube on its edge, and one whose own lowest edge is turned by 17 degrees about the vertical and `depth` below that of the
/// first: where it passes above, the two overlap by as much.
struct Edges {
  World world;
  explicit Edges(double depth) {
    for (const bool is_upper : {false, true}) {
      BodyDescription body = cube(is_upper ? "upper" : "lower", 1.0, {0.0, is_upper ? 2.0 * kEdge - depth : 0.0, 0.0});
      body.shape = surface(box({0.5, 0.5, 0.5}));
      body.rotation = {45.0, is_upper ? 17.0 : 0.0, 0.0};
      world.add_body(body);
    }
    world.start();
  }

  /// Of the upper one's way along z between two places.
  bool passes(double from, double to, const OverlapsOf& overlaps) {
    Bodies& bodies = world.bodies();
    const auto place = [&](double z) {
      Body& upper = bodies[BodyIndex(1)];
      upper.pose.position.z() = z;
      upper.update_world_vertices();
    };
    MotionGuard guard;
    place(from);
    guard.open(bodies);
    place(to);
    const PassagesOf settings = [](BodyIndex, BodyIndex) { return PassageSettings{1e-7, 2e-3}; };
    return guard.look(bodies, Continuous::when_needed, settings, false, false, overlaps).has_value();
  }

  OverlapsOf overlaps() {
    return [this](std::vector<BodyPair> pairs) {
      return overlaps_now(world.bodies(), detecting(world.parameters), std::move(pairs));
    };
  }
};

}  // namespace

TEST_CASE("edges that graze each other on the way pass nobody unless they end in one another") {
  Edges shallow(5e-3), deep(2e-2), high(-5e-3);
  CHECK_FALSE(high.passes(-0.2, 0.2, {}));
  CHECK(shallow.passes(-0.2, 0.2, {}));
  CHECK_FALSE(shallow.passes(-0.2, 0.2, shallow.overlaps()));
  CHECK(shallow.passes(-0.2, 0.0, shallow.overlaps()));
  CHECK(deep.passes(-0.2, 0.2, deep.overlaps()));
}

TEST_CASE("the overlap of two edges is what the one is below the other") {
  Edges edges(5e-3);
  CHECK(edges.overlaps()({{BodyIndex(0), BodyIndex(1)}}).front() == Approx(5e-3).epsilon(1e-6));
  CHECK(Edges(-5e-3).overlaps()({{BodyIndex(0), BodyIndex(1)}}).front() == 0.0);
}
