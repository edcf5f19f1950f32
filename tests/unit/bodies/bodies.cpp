// Motion, rotations, groups: the small parts of the model.
#include <catch2/catch.hpp>

#include "engine/bodies/motion.hpp"
#include "engine/contact/collision_groups.hpp"
#include "engine/core/error.hpp"
#include "engine/geometry/rotation.hpp"
#include "tests/support/geometry/indices.hpp"
#include "tests/support/mechanics/worlds.hpp"
#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

TEST_CASE("rotations: degrees, exponential and logarithm agree") {
  Random random(3);
  for (int i = 0; i < 500; ++i) {
    const Mat3 r = random.rotation();
    CHECK((rotation_exp(rotation_log(r)) - r).norm() < 1e-12);
    CHECK((rotation_from_degrees(degrees_from_rotation(r)) - r).norm() < 1e-7);
    const Vec3 tiny = 1e-9 * random.vector();
    CHECK((rotation_log(rotation_exp(tiny)) - tiny).norm() < 1e-15);
  }
  // about x, then y, then z: the x axis turned 90° about z points along y; z turned about x points along -y first
  CHECK((rotation_from_degrees({0, 0, 90}) * Vec3::UnitX() - Vec3::UnitY()).norm() < 1e-15);
  CHECK((rotation_from_degrees({90, 0, 90}) * Vec3::UnitZ() - Vec3::UnitX()).norm() < 1e-15);
}

TEST_CASE("key-framed motion passes its keys, rests at the ends and never overshoots") {
  const Motion motion({{0.0, {0, 0, 0}, {0, 0, 0}},
                       {1.0, {1, 0, 0}, {0, 90, 0}},
                       {1.5, {1, 2, 0}, {0, 720, 0}},
                       {3.0, {4, 2, 1}, {0, 720, 0}}});
  for (const MotionKey& key : motion.keys()) CHECK((motion.at(key.time).position - key.position).norm() < 1e-14);
  CHECK((motion.at(-1.0).position - motion.at(0.0).position).norm() == 0.0);
  CHECK((motion.at(9.0).position - Vec3(4, 2, 1)).norm() == 0.0);
  const double h = 1e-6;
  CHECK((motion.at(h).position - motion.at(0.0).position).norm() / h < 1e-4);
  CHECK((motion.at(3.0).position - motion.at(3.0 - h).position).norm() / h < 1e-4);
  for (double t = 0.0; t < 3.0; t += 0.001) {  // continuous velocity, monotone components
    const Vec3 v0 = (motion.at(t).position - motion.at(t - h).position) / h,
               v1 = (motion.at(t + h).position - motion.at(t).position) / h;
    CHECK((v1 - v0).norm() < 1e-3);
    CHECK(motion.at(t + h).position.x() >= motion.at(t).position.x() - 1e-15);
    CHECK(motion.at(t).position.y() <= 2.0 + 1e-15);
  }
}

TEST_CASE("a scripted body's velocity carries its pose exactly") {
  World world;
  BodyDescription d = dynamic_body("paddle", Box{Vec3(1, 0.1, 0.2)}, Vec3::Zero());
  d.kind = BodyKind::scripted;
  d.motion = {{0.0, Vec3(0, 1, 0), Vec3(0, 0, 0)}, {0.5, Vec3(1, 1, 0), Vec3(20, 90, -40)}};
  world.add_body(d);
  world.add_body(cube("far", 0.1, Vec3(50, 0, 0)));
  world.parameters.simulation.substeps = 1;
  world.start();
  for (int i = 0; i < 30; ++i) {
    const Pose before = world.bodies()[0].pose;
    world.step();
    const Body& b = world.bodies()[0];
    const double h = world.parameters.simulation.time_step();
    CHECK((before.position + h * b.twist().linear - b.pose.position).norm() < 1e-14);
    CHECK((rotation_exp(h * b.twist().angular) * before.rotation - b.pose.rotation).norm() < 1e-13);
  }
}

TEST_CASE("collision groups are the connected components, what does not move joins nothing") {
  // the seed's Fig. 3.6: A-B, B-C and D-E; body 5 is a floor that everybody touches
  const std::vector<char> joins = {1, 1, 1, 1, 1, 0, 1};
  std::vector<std::pair<BodyIndex, BodyIndex>> contacts;
  for (const auto& [a, b] : {std::pair{0, 1}, {1, 2}, {3, 4}, {0, 5}, {3, 5}, {4, 5}})
    contacts.emplace_back(BodyIndex(a), BodyIndex(b));
  const std::vector<CollisionGroup> groups = make_groups(contacts, joins);
  REQUIRE(groups.size() == 2);
  CHECK(groups[0].bodies == indices<BodyIndex>({0, 1, 2}));
  CHECK(groups[0].contacts == indices<ContactIndex>({0, 1, 3}));
  CHECK(groups[1].bodies == indices<BodyIndex>({3, 4}));
  CHECK(groups[1].contacts == indices<ContactIndex>({2, 4, 5}));

  Random random(5);
  for (int trial = 0; trial < 200; ++trial) {  // against repeated relabelling
    const int n = 2 + random.below(30);
    std::vector<char> free(n);
    for (char& f : free) f = random.u() < 0.8;
    std::vector<std::pair<BodyIndex, BodyIndex>> pairs;
    for (int k = random.below(40); k > 0; --k) {
      const int a = random.below(n), b = random.below(n);
      if (a != b) pairs.emplace_back(BodyIndex(std::min(a, b)), BodyIndex(std::max(a, b)));
    }
    std::vector<int> label(n);
    for (int i = 0; i < n; ++i) label[i] = i;
    for (bool changed = true; changed;) {
      changed = false;
      for (auto [a, b] : pairs)
        if (free[a] && free[b] && label[a] != label[b])
          label[a] = label[b] = std::min(label[a], label[b]), changed = true;
    }
    for (const CollisionGroup& g : make_groups(pairs, free)) {
      for (int b : g.bodies) CHECK(label[b] == label[g.bodies.front()]);
      for (int i = 0; i < n; ++i)
        if (free[i] && label[i] == label[g.bodies.front()]) CHECK(std::count(g.bodies.begin(), g.bodies.end(), i) == 1);
    }
  }
}

TEST_CASE("bodies that can't be made say why") {
  World world;
  BodyDescription d = fixed_plane("floor", Vec3::UnitY(), 0.0);
  d.kind = BodyKind::dynamic;
  CHECK_THROWS_AS(world.add_body(d), InputError);
}
