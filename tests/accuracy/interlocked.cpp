// Bodies that hang in one another: their contacts lie inside, where points come nearer by turning than velocities say, and
// the response drives bodies together that fell side by side.
#include <catch2/catch.hpp>

#include "engine/world/judge.hpp"
#include "tests/support/mechanics/interlocked.hpp"
#include "tests/support/mechanics/undone_motions.hpp"
#include "tests/support/mechanics/worlds.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

struct ChainResult {
  double deepest = 0.0, widest = 0.0;  // metres: overlap by the judge; of the distances of neighbours
  double gain = 0.0;                   // J: the most that was ever won
  std::int64_t unconverged = 0;
};

/// 80 frames of four sub-steps.
ChainResult swing(int turning_solves) {
  constexpr int kLinks = 6;
  World world;
  assemble({"chain", kLinks, 4}, world);
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
    result.deepest = std::max(result.deepest, judge_overlap(world.bodies()).deepest);
    for (int i = 1; i < kLinks; ++i)
      result.widest =
          std::max(result.widest, (world.bodies()[i].pose.position - world.bodies()[i - 1].pose.position).norm());
  }
  return result;
}

}  // namespace

TEST_CASE("the links of a chain that swings stay in one another, unless their turns are followed they sink deeper",
          "[interlocked]") {
  const ChainResult chain = swing(4), straight = swing(0);
  CAPTURE(chain.deepest, chain.widest, chain.gain, straight.deepest);
  CHECK(chain.deepest <= 0.01 * 2.0 * kLinkMinor);
  CHECK(chain.widest <= 2.0 * (kLinkMajor - kLinkMinor) + 0.01 * 2.0 * kLinkMinor);
  CHECK(chain.gain <= 0.01);
  CHECK(chain.unconverged == 0);
  CHECK(straight.deepest > 1.5 * chain.deepest);
}

TEST_CASE("what a chain that swings shows of its overlaps is the judge's where its links meet edge on edge",
          "[interlocked]") {
  World world;
  assemble({"chain", 12, 1}, world);
  world.start();
  int edge_on_edge = 0;
  for (int frame = 1; frame <= 60; ++frame) {
    world.step();
    const OverlapVerdict truth = judge_overlap(world.bodies());
    const double shown = world.record().stats.max_penetration;
    CAPTURE(frame, truth.penetration, truth.deepest, shown);
    if (truth.deepest <= 1e-6) continue;
    CHECK(shown >= truth.penetration);
    CHECK(shown <= 2.0 * truth.deepest);
    if (truth.deepest > 2.0 * truth.penetration) ++edge_on_edge;
    // where vertices are deeper than a millionth of a link's extent (0.24 m and more) no more is shown than twice that
    if (truth.penetration < 2.4e-7) CHECK(shown >= truth.deepest / 1.06);
  }
  CHECK(edge_on_edge > 10);
}

TEST_CASE("hardly a motion of a chain that swings at one sub-step of 10 ms has to be undone", "[interlocked]") {
  World world;
  assemble({"chain", 12, 1}, world);
  world.start();
  UndoneMotions undone;
  world.watch(&undone);
  double deepest = 0.0;
  for (int frame = 0; frame < 60; ++frame) {
    world.step();
    CHECK(world.record().stats.unconverged == 0);
    deepest = std::max(deepest, judge_overlap(world.bodies()).deepest);
  }
  CAPTURE(undone.count, deepest);
  CHECK(undone.count <= 20);  // 221 while meshes were looked at where they begin, and nowhere else
  CHECK(deepest <= 0.01 * 2.0 * kLinkMinor);
}

TEST_CASE("rows of pins that say the opposite of each other cost no solver its iterations", "[interlocked]") {
  World world;
  assemble({"arms", 2, 1}, world);  // pins push to all sides of their holes, and turn far in 10 ms
  world.start();
  std::int64_t iterations = 0;
  for (int frame = 0; frame < 14; ++frame) {
    world.step();
    CHECK(world.record().stats.unconverged == 0);
    iterations += world.record().stats.lcp_iterations;
  }
  CHECK(iterations <= 40000);  // 110,000 while methods went on to their caps where nothing answers
}

TEST_CASE("arms on pins, a bolt in its nut and an arch whose gaps close hold at one sub-step of 10 ms",
          "[interlocked]") {
  for (const int substeps : {1, 4})
    for (const Assembly& what : {Assembly{"arms", 2, substeps, 0.08}, Assembly{"bolt", 1, substeps, 0.08},
                                 Assembly{"arch", 25, substeps, 0.2}}) {
      const AssemblyResult r = run(what, true);
      CAPTURE(what.name, substeps, r.overlap, r.thickness, r.contacts, r.gain, r.fall);
      CHECK(r.overlap <= 2e-3 * r.thickness);
      CHECK(r.unsafe == 0);
      CHECK(r.unconverged == 0);
      CHECK(r.gain <= 0.01 * r.fall);
      CHECK(r.contacts <= 30);
    }
}

TEST_CASE("a screw that turns down in its nut has no more than 30 contacts on one sub-step of 10 ms", "[interlocked]") {
  const AssemblyResult r = run({"bolt", 1, 1, 0.3}, true);
  CAPTURE(r.overlap, r.thickness, r.contacts);
  CHECK(r.contacts <= 30);
  CHECK(r.overlap <= 0.01 * r.thickness);
  CHECK(r.unconverged == 0);
}

TEST_CASE("a roller chain swings with no more than 30 contacts a pair, its pins in their holes", "[interlocked]") {
  for (const int substeps : {4, 1}) {
    const AssemblyResult r = run({"rollers", 4, substeps, substeps == 4 ? 0.08 : 0.04}, true);
    CAPTURE(substeps, r.overlap, r.thickness, r.contacts, r.gain, r.fall, r.reach);
    CHECK(r.overlap <= 2e-3 * r.thickness);
    CHECK(r.contacts <= 30);
    CHECK(r.unconverged == 0);
    CHECK(r.unsafe == 0);
    CHECK(r.gain <= 0.01 * r.fall);
  }
}

TEST_CASE("what only the response drives together overlaps unless it is looked for again", "[interlocked]") {
  const Assembly arch{"arch", 25, 1, 0.1};
  const AssemblyResult with = run(arch, true), without = run(arch, true, 0);
  CAPTURE(with.overlap, without.overlap, without.by_vertices, with.thickness);
  constexpr double kLeft = 1e-6;  // metres
  CHECK(with.overlap <= kLeft);
  CHECK(without.overlap >= 1000.0 * kLeft);  // the look at motions leaves what is shallow by vertices to it:
  CHECK(without.by_vertices <= 5e-3 * without.thickness);  // of the thickness of a stone
  // edges know better: all corners of two stones that meet lie in one another's sides, where vertices tell little
  CHECK(without.overlap >= 10.0 * without.by_vertices);
  // and until the gaps have closed, when stones wedge, vertices tell next to nothing
  const AssemblyResult open = run({"arch", 25, 1, 0.05}, true, 0);
  CAPTURE(open.overlap, open.by_vertices);
  CHECK(open.overlap >= 1000.0 * kLeft);
  CHECK(open.by_vertices <= 5e-6 * open.thickness);
}
