// Bodies that hang in one another: their contacts lie inside, where points come nearer by turning than velocities say.
#include <catch2/catch.hpp>

#include "engine/world/judge.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/mechanics/worlds.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

constexpr double kMajor = 0.1, kMinor = 0.02, kPlay = 0.002;  // metres, of a link

/// Links in a row, each through the next at right angles; the first is held, the last is ten times as heavy. All start
/// level and swing down.
void add_chain(World& world, int links) {
  const MeshPointer mesh = surface(torus(kMajor, kMinor, 24, 12));
  for (int i = 0; i < links; ++i) {
    BodyDescription link = dynamic_body("link " + std::to_string(i), mesh, Vec3::Zero());
    link.position = Vec3(i * (2.0 * (kMajor - kMinor) - kPlay), 0.0, 0.0);
    link.rotation = Vec3(90.0 * (i % 2), 0.0, 0.0);
    link.kind = i == 0 ? BodyKind::fixed : BodyKind::dynamic;
    link.density = i == links - 1 ? 78000.0 : 7800.0;
    world.add_body(link);
  }
}

struct ChainResult {
  double deepest = 0.0, widest = 0.0;  // metres: overlap by the judge; of the distances of neighbours
  double gain = 0.0;                   // J: the most that was ever won
  std::int64_t unconverged = 0;
};

/// 80 frames of four sub-steps.
ChainResult swing(int turning_solves) {
  constexpr int kLinks = 6;
  World world;
  add_chain(world, kLinks);
  world.parameters.simulation.frame_time = 0.01;
  world.parameters.simulation.substeps = 4;
  world.parameters.contact.friction = 0.0;
  world.parameters.contact.turning_solves = turning_solves;
  world.start();
  ChainResult result;
  double first = 0.0;
  for (int frame = 0; frame < 80; ++frame) {
    world.step();
    const FrameStats& stats = world.record().stats;
    const double energy = stats.kinetic + stats.potential;
    if (frame == 0) first = energy;
    result.gain = std::max(result.gain, energy - first);
    result.unconverged += stats.unconverged;
    result.deepest = std::max(result.deepest, judge_overlap(world.bodies()).penetration);
    for (int i = 1; i < kLinks; ++i)
      result.widest =
          std::max(result.widest, (world.bodies()[i].pose.position - world.bodies()[i - 1].pose.position).norm());
  }
  return result;
}

}  // namespace

TEST_CASE("the links of a chain that swings stay in one another; unless their turns are followed they sink deeper",
          "[interlocked]") {
  const ChainResult chain = swing(4), straight = swing(0);
  CAPTURE(chain.deepest, chain.widest, chain.gain, straight.deepest);
  CHECK(chain.deepest <= 0.01 * 2.0 * kMinor);
  CHECK(chain.widest <= 2.0 * (kMajor - kMinor) + 0.01 * 2.0 * kMinor);
  CHECK(chain.gain <= 0.01);
  CHECK(chain.unconverged == 0);
  CHECK(straight.deepest > 1.5 * chain.deepest);
}
