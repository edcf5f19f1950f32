// Bodies that are pressed into themselves: their surfaces' crossings, counted pair by pair of triangles.
#include <catch2/catch.hpp>

#include "tests/support/mechanics/brute_self_crossings.hpp"
#include "tests/support/mechanics/deformable_bodies.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

struct StripCase {
  Vec3 size = {0.4, 0.01, 0.08};
  Eigen::Vector3i cells = {32, 1, 6};
  double turns = 4.0, seconds = 2.0;
  double activation = 0.0;  // metres; 0: left to the program
  int substeps = 4;
  Continuous continuous = Continuous::when_needed;
  ElementKind element = ElementKind::linear;
};

struct StripResult {
  std::int64_t crossings = 0, contacts = 0, unsafe = 0;
  double fastest = 0.0;  // m/s
};

/// A strip held at one end and turned at the other, 100 frames a second.
StripResult twisted(const StripCase& how) {
  World world;
  const SoftOptions o{2e4, 0.4, 1000.0, 0.005, "neo_hookean", how.element};
  BodyDescription strip = soft_box("strip", how.size, how.cells, -0.5 * how.size, o);
  auto soft = std::make_shared<DeformableDescription>(*strip.deformable);
  NodeRegion held, turned;
  const double end = 0.475 * how.size.x();
  held.min = {-1, -1, -1}, held.max = {-end, 1, 1};
  turned.min = {end, -1, -1}, turned.max = {1, 1, 1};
  turned.motion = {{0.0, Vec3::Zero(), Vec3::Zero()}, {how.seconds, Vec3::Zero(), {360.0 * how.turns, 0, 0}}};
  soft->fixed = {held, turned};
  strip.deformable = soft;
  strip.self_collision = true;
  world.add_body(strip);
  world.parameters.simulation.gravity.setZero();
  world.parameters.simulation.frame_time = 0.01;
  world.parameters.simulation.substeps = how.substeps;
  world.parameters.contact.friction = 0.0;
  if (how.activation > 0.0) world.parameters.contact.activation_distance = how.activation;
  world.parameters.narrow_phase.continuous = how.continuous;
  world.start();
  StripResult result;
  for (int frame = 0; frame < std::lround(100.0 * how.seconds); ++frame) {
    world.step();
    result.crossings += brute_self_crossings(world.bodies()[0]);
    result.contacts = std::max(result.contacts, world.record().stats.contacts);
    result.unsafe += world.record().stats.unsafe_motions;
    result.fastest = std::max(result.fastest, fastest_node(world));
  }
  return result;
}

}  // namespace

TEST_CASE("a strip that is twisted four turns never crosses itself, nor does one of quadratic elements in two",
          "[self]") {
  StripCase linear, quadratic;
  quadratic.element = ElementKind::quadratic;
  quadratic.cells = {16, 1, 3};
  quadratic.turns = 2.0;
  for (StripCase how : {linear, quadratic})
    for (const int substeps : {4, 1}) {
      how.substeps = substeps;
      how.activation = 1e-3;
      const StripResult strip = twisted(how);
      CAPTURE(how.turns, substeps, strip.contacts);
      CHECK(strip.crossings == 0);
      CHECK(strip.unsafe == 0);
      CHECK(strip.contacts > 20);
      CHECK(strip.fastest < 100.0);
    }
}

TEST_CASE("nobody looks at the same strip: it crosses itself", "[self]") {
  StripCase how;
  how.substeps = 1;
  how.continuous = Continuous::off;
  CHECK(twisted(how).crossings > 0);
}

TEST_CASE("strips of other sizes and meshes don't cross themselves either", "[self]") {
  const std::vector<StripCase> strips = {{{0.04, 0.001, 0.008}, {20, 1, 4}, 2.0, 0.8},
                                         {{0.5, 0.01, 0.2}, {20, 1, 8}, 2.0, 1.0}};
  for (const StripCase& how : strips) {
    const StripResult strip = twisted(how);
    CAPTURE(how.size.transpose(), strip.contacts);
    CHECK(strip.crossings == 0);
    CHECK(strip.contacts > 0);
  }
}
