// Boxes that fall in a heap meet with corners and edges that were not the nearest ones when the sub-step began. What holds
// them is found where they end, so that their motion need not be cut short and tried again.
#include <catch2/catch.hpp>

#include "tests/support/geometry/brute_convex.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/mechanics/deformable_bodies.hpp"
#include "tests/support/mechanics/pile.hpp"
#include "tests/support/mechanics/undone_motions.hpp"
#include "tests/support/mechanics/worlds.hpp"
#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

constexpr double kSide = 0.5;          // metres
constexpr int kFirst = 8, kLast = 24;  // frames: after the overlaps of the start, until they lie

TriangleMesh placed(const Body& body, double side) {
  TriangleMesh mesh = box(Vec3::Constant(0.5 * side));
  for (Vec3& x : mesh.vertices) x = body.pose.apply(x);
  return mesh;
}

double deepest_of(const World& world, double side) {
  std::vector<const Body*> boxes;
  for (const Body& b : world.bodies())
    if (b.kind() == BodyKind::dynamic) boxes.push_back(&b);
  double deepest = 0.0;
  for (std::size_t i = 0; i < boxes.size(); ++i)
    for (std::size_t k = i + 1; k < boxes.size(); ++k)
      if ((boxes[i]->pose.position - boxes[k]->pose.position).norm() < std::sqrt(3.0) * side)
        deepest = std::max(deepest, -brute_convex_gap(placed(*boxes[i], side), placed(*boxes[k], side)).gap);
  return deepest;
}

struct Heap {
  double deepest = 0.0;  // metres
  int undone = 0;        // motions
  std::int64_t unconverged = 0;
};

/// Of cubes of one size; overlap is looked at from frame `first` on.
Heap run(World& world, int first, int last, double side) {
  world.start();
  UndoneMotions undone;
  world.watch(&undone);
  Heap heap;
  for (int frame = 1; frame <= last; ++frame) {
    world.step();
    heap.unconverged += world.record().stats.unconverged;
    if (frame >= first) heap.deepest = std::max(heap.deepest, deepest_of(world, side));
  }
  world.watch(nullptr);
  heap.undone = undone.count;
  return heap;
}

/// Of thirty boxes, while they fall in.
Heap tumble(Continuous continuous, int second_looks) {
  World world;
  world.parameters.simulation.substeps = 1;
  world.parameters.simulation.sleeping = false;
  world.parameters.narrow_phase.continuous = continuous;
  world.parameters.contact.second_looks = second_looks;
  world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
  for (const Vec3& side : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 0, 1), Vec3(0, 0, -1)})
    world.add_body(fixed_plane(("wall" + std::to_string(world.bodies().size().value())).c_str(), side, -1.1));
  Random random(4242);
  for (int k = 0; k < 30; ++k) {
    const Vec3 at(0.6 * (k % 3 - 1), 0.6 * (k / 9) + 0.35, 0.6 * (k / 3 % 3 - 1));
    BodyDescription body = cube("box" + std::to_string(k), kSide, at + 0.02 * random.vector());
    body.rotation = 16.5 * random.vector();  // degrees
    world.add_body(body);
  }
  return run(world, kFirst, kLast, kSide);
}

/// Of 32 boxes of 0.1 m that fall on a soft mat: one group, of both kinds of bodies.
Heap tumble_on_mat(int turning_solves) {
  constexpr double kSmall = 0.1;
  World world;
  world.parameters.simulation.substeps = 1;
  world.parameters.simulation.sleeping = false;
  world.parameters.contact.turning_solves = turning_solves;
  world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
  world.add_body(soft_box("mat", Vec3(0.8, 0.2, 0.8), Eigen::Vector3i(4, 2, 4), Vec3(0.0, 0.0005, 0.0),
                          {.young = 1e5, .poisson = 0.3, .density = 300.0}));
  Random random(3);
  for (int k = 0; k < 32; ++k) {
    const Vec3 at(0.4 + 0.2 * (k % 4 - 1.5), 0.3 + 0.2 * (k / 16), 0.4 + 0.2 * (k / 4 % 4 - 1.5));
    BodyDescription body = cube("box" + std::to_string(k), kSmall, at + 0.01 * random.vector());
    body.mass = 0.5;
    body.rotation = 30.0 * random.vector();  // degrees
    world.add_body(body);
  }
  return run(world, 1, 20, kSmall);
}

}  // namespace

TEST_CASE("boxes that tumble onto one another end where their surfaces are") {
  const Heap with = tumble(Continuous::off, 4), without = tumble(Continuous::off, 0);
  CAPTURE(with.deepest, without.deepest);
  CHECK(with.deepest <= 1e-3 * kSide);
  CHECK(without.deepest >= 1e-2 * kSide);
}

TEST_CASE("hardly a motion of boxes that tumble has to be undone") {
  const Heap with = tumble(Continuous::when_needed, 4), without = tumble(Continuous::when_needed, 0);
  CAPTURE(with.undone, without.undone);
  CHECK(with.undone <= 3);
  CHECK(without.undone >= 10 * std::max(with.undone, 1));
  CHECK(with.deepest <= 1e-3 * kSide);
}

TEST_CASE("hardly a motion of boxes that tumble on a soft mat has to be undone") {
  const Heap with = tumble_on_mat(4), without = tumble_on_mat(0);
  CAPTURE(with.undone, without.undone, with.deepest);
  CHECK(with.unconverged + without.unconverged == 0);
  CHECK(with.undone <= 3);
  CHECK(without.undone >= 3 * std::max(with.undone, 1));
  CHECK(with.deepest <= 1e-4);
}

TEST_CASE("two hundred boxes are solved to the tolerance in every step in which they tumble") {
  World world;
  world.parameters.simulation.substeps = 1;
  world.parameters.simulation.sleeping = false;
  world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
  Random random(4242);
  add_pile(world, random, 200);
  world.start();
  std::int64_t most = 0;
  for (int frame = 1; frame <= 40; ++frame) {
    world.step();
    const FrameStats& stats = world.record().stats;
    CAPTURE(frame);
    CHECK(stats.unconverged == 0);
    CHECK(stats.residual_coulomb <= 1.01e-8);  // the judge's, by its own formula
    most = std::max(most, stats.contacts);
  }
  CHECK(most > 1000);
}
