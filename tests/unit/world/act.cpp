// What somebody does to bodies between frames, held against closed forms: the damped oscillator, impulse and momentum, and
// worlds in which it never was.
#include "engine/step/act.hpp"

#include <catch2/catch.hpp>

#include "engine/geometry/rotation.hpp"
#include "engine/integrators/deformable_integrator.hpp"
#include "tests/support/mechanics/deformable_bodies.hpp"
#include "tests/support/mechanics/methods.hpp"
#include "tests/support/mechanics/state_hashes.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

Act pull(const std::string& body, const Vec3& own, const Vec3& to, double stiffness = 0.0) {
  return {Act::pull, body, to, own, stiffness};
}

/// A mass on a critically damped spring that is let go at rest at distance 1.
double settled(double frequency, double time) { return (1.0 + frequency * time) * std::exp(-frequency * time); }

/// A cube by itself that nothing moves but what is done to it, and that is stiff enough to move as a whole.
void add_alone(World& world, bool soft) {
  world.parameters.simulation.gravity.setZero();
  SoftOptions stiff;
  stiff.young = 1e8;
  world.add_body(soft ? soft_cube("a", 0.2, 2, Vec3::Constant(-0.1), stiff) : cube("a", 0.2, Vec3::Zero()));
}

/// How far from the closed form a cube is after half a second of a pull of 1 m, at its worst, metres.
double pull_error(bool soft, int substeps) {
  World world;
  add_alone(world, soft);
  world.parameters.simulation.substeps = substeps;
  world.start();
  const double frequency = 8.0, stiffness = world.bodies()[0].mass * frequency * frequency;
  const Vec3 middle = soft ? Vec3(0.1, 0.1, 0.1) : Vec3::Zero();  // in the axes of what it is made of
  world.act(pull("a", middle, Vec3(1, 0, 0), stiffness));
  double worst = 0.0;
  for (int k = 0; k < 30; ++k) {
    world.step();
    worst = std::max(worst, std::abs(world.bodies()[0].center_of_mass().x() - 1.0 + settled(frequency, world.time())));
  }
  return worst;
}

}  // namespace

TEST_CASE("a pulled mass comes after as a critically damped spring brings it, the nearer the shorter the sub-steps") {
  const double coarse = pull_error(false, 16), fine = pull_error(false, 32);
  CHECK(fine < 0.005);
  CHECK(coarse / fine == Approx(2.0).epsilon(0.05));  // of first order
  CHECK(pull_error(true, 16) == Approx(coarse).epsilon(0.02));
}

TEST_CASE("a mass on a spring hangs where its weight stretches it, with every integrator") {
  for (const bool soft : {false, true})
    for (const auto& entry : integrators()) {
      if (!soft && entry.name != "newmark") continue;
      const bool is_explicit = entry.name == "symplectic_euler";  // whose pull is as weak as its nodes are light
      if (is_explicit) continue;
      CAPTURE(soft, entry.name);
      World world;
      world.add_body(soft ? soft_cube("a", 0.2, 2, Vec3::Constant(-0.1)) : cube("a", 0.2, Vec3::Zero()));
      world.parameters.simulation.integrator = entry.name;
      world.start();
      const double mass = world.bodies()[0].mass, stiffness = 400.0 * mass;
      const Vec3 corner = soft ? Vec3(0.2, 0.2, 0.2) : Vec3(0.1, 0.1, 0.1), to(0.5, 0.7, -0.2);
      world.act(pull("a", corner, to, stiffness));
      Vec3 late = Vec3::Zero();
      double weight = 0.0;
      for (int k = 0; k < 1800; ++k) {
        world.step();
        if (k >= 1200) late += world.record().bodies[0].pull->point, weight += 1.0;
      }
      // it goes on swinging about the point that is held
      CHECK((late / weight - to - Vec3(0, -9.81 / 400.0, 0)).norm() < 0.0015);
    }
}

TEST_CASE("an impulse changes the momentum by itself and the angular momentum by its arm") {
  for (const bool soft : {false, true})
    for (const MassKind mass : {MassKind::lumped, MassKind::consistent}) {
      CAPTURE(soft, mass);
      World world;
      SoftOptions options;
      BodyDescription d = soft ? soft_cube("a", 0.2, 2, Vec3::Constant(-0.1), options) : cube("a", 0.2, Vec3::Zero());
      if (soft) {
        auto own = std::make_shared<DeformableDescription>(*d.deformable);
        own->mass = mass;
        d.deformable = own;
      }
      d.velocity = Vec3(0.3, 0.2, -1.0);
      d.rotation = Vec3(10, 20, 30);
      d.angular_velocity = Vec3(1, 2, 3);
      Body& body = world.add_body(d);
      world.start();
      const Vec3 impulse(3.0, -2.0, 5.0);
      const Vec3 at = body.position_of(body.own_point(Vec3(0.07, -0.02, 0.03)));
      for (const bool is_at_point : {false, true}) {
        const Balance before = body.balance(Vec3::Zero());
        const Vec3 where = is_at_point ? at : body.center_of_mass();
        world.act({Act::push, "a", impulse, is_at_point ? std::optional(at) : std::nullopt});
        const Balance after = body.balance(Vec3::Zero());
        CHECK((after.momentum - before.momentum - impulse).norm() < 1e-11);
        CHECK((after.angular_momentum - before.angular_momentum - where.cross(impulse)).norm() < 1e-11);
      }
    }
}

TEST_CASE("a body that is moved is elsewhere as it was") {
  World world;
  BodyDescription d = cube("a", 0.2, Vec3(1, 2, 3));
  d.rotation = Vec3(10, 20, 30);
  d.velocity = Vec3(1, 0, 2);
  d.angular_velocity = Vec3(1, 2, 3);
  RigidBody& a = *world.add_body(d).as<RigidBody>();
  DeformableBody& b = *world.add_body(soft_cube("b", 0.2, 2, Vec3(3, 0, 0))).as<DeformableBody>();
  world.start();
  run(world, 3);
  const Pose before = a.pose;
  const Vec3 v = a.velocity, w = a.angular_velocity();
  const VecX nodes = b.position, of_nodes = b.velocity;
  const Vec3 by(0.5, -1.0, 2.0);
  world.act({Act::move, "a", by, {}, 0.0, Vec3(0, 3, 0), 90.0});
  world.act({Act::move, "b", by});
  CHECK((a.pose.position - before.position - by).norm() < 1e-15);
  Mat3 quarter;  // x goes to -z, z to x
  quarter << 0, 0, 1, 0, 1, 0, -1, 0, 0;
  CHECK((a.pose.rotation - quarter * before.rotation).norm() < 1e-14);
  CHECK(a.velocity == v);
  CHECK((a.angular_velocity() - w).norm() < 1e-14);
  CHECK(b.velocity == of_nodes);
  for (int i = 0; i < b.nodes(); ++i)
    CHECK((b.position.segment<3>(3 * i) - nodes.segment<3>(3 * i) - by).norm() < 1e-15);
  CHECK((b.world_vertices[0] - b.center_of_mass()).norm() < 0.2);
}

TEST_CASE("a held body that is moved is held where it is now") {
  World world;
  BodyDescription d = soft_cube("a", 0.2, 2, Vec3::Zero());
  auto own = std::make_shared<DeformableDescription>(*d.deformable);
  NodeRegion& side = own->fixed.emplace_back();
  side.min = Vec3(-1, -1, -1), side.max = Vec3(0.01, 1, 1);
  d.deformable = own;
  DeformableBody& a = *world.add_body(d).as<DeformableBody>();
  world.start();
  run(world, 2);
  const Vec3 by(0, 3, 1), before = a.position.segment<3>(3 * a.held[0].nodes[0]);
  world.act({Act::move, "a", by});
  run(world, 5);
  CHECK((Vec3(a.position.segment<3>(3 * a.held[0].nodes[0])) - before - by).norm() < 1e-12);
}

TEST_CASE("what is deleted leaves the states that a world without it has") {
  // bodies that fall, rest, hang and bend; and beside them one of each kind that touches nobody
  const auto make = [](World& world, const BodyDescription* extra) {
    world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
    if (extra != nullptr) world.add_body(*extra);
    world.add_body(cube("low", 0.3, Vec3(0, 0.15, 0)));
    world.add_body(cube("high", 0.3, Vec3(0.02, 0.6, 0)));
    world.add_body(soft_cube("soft", 0.3, 2, Vec3(1, 0.1, 0)));
    if (extra != nullptr && extra->kind == BodyKind::dynamic)
      world.add_attachment({"string", extra->name, "", Vec3(10, 5, 0)});
    world.add_attachment({"rope", "high", "low", Vec3(0.02, 0.6, 0)});
    world.start();
  };
  BodyDescription hanging = cube("extra", 0.3, Vec3(10, 5, 0)), wall = hanging, moving = hanging,
                  soft = soft_cube("extra", 0.3, 2, Vec3(10, 9, 0));
  hanging.restitution = 0.5;
  wall.kind = BodyKind::fixed;
  moving.kind = BodyKind::scripted;
  moving.motion = {{0.0, Vec3(10, 5, 0), Vec3::Zero()}, {1.0, Vec3(11, 5, 0), Vec3(0, 90, 0)}};
  for (const BodyDescription* extra : {&hanging, &wall, &moving, &soft}) {
    CAPTURE(extra->kind);
    World with, without;
    make(with, extra), make(without, nullptr);
    const auto states = [](World& world) {
      ByteWriter out;
      for (Body& body : world.bodies()) {
        if (body.name == "extra" || body.name == "floor") continue;
        body.balance(Vec3::Zero());
        const Twist twist = body.twist();
        out.put(body.center_of_mass()), out.put(body.pose.rotation), out.put(twist.linear), out.put(twist.angular);
        out.put(body.rest_time), out.put(body.asleep);
      }
      return out.take();
    };
    for (int k = 0; k < 90; ++k) {
      if (k == 10) with.act({Act::remove, "extra"});
      with.step(), without.step();
      CHECK((states(with) == states(without)));
    }
    const FrameStats &now = with.record().stats, &plain = without.record().stats;
    CHECK(now.bodies == plain.bodies);
    CHECK(now.dofs == plain.dofs);
    CHECK(now.contacts == plain.contacts);
    CHECK(now.kinetic == plain.kinetic);
    CHECK(now.potential == plain.potential);
    CHECK(with.record().attachments.size() == 1);
    CHECK(with.record().attachments[0].impulse == without.record().attachments[0].impulse);
    CHECK(with.record().bodies[1].deleted);
  }
}

TEST_CASE("what rested on a deleted body wakes and falls, and what is pushed or pulled wakes too") {
  const auto sleeping = [](World& world) {
    BodyDescription table = cube("table", 1.0, Vec3(0, -0.5, 0));
    table.kind = BodyKind::fixed;
    world.add_body(table);
    world.add_body(cube("a", 0.2, Vec3(0, 0.1, 0)));
    world.start();
    for (int k = 0; k < 600 && !world.bodies()[1].asleep; ++k) world.step();
    run(world, 3);  // and frames in which nothing moves
    REQUIRE(world.bodies()[1].asleep);
  };
  for (const Act& act : {Act{Act::remove, "table"}, Act{Act::push, "a", Vec3(0, 30, 0)},
                         pull("a", Vec3::Zero(), Vec3(0, 1, 0)), Act{Act::move, "a", Vec3(0, 1, 0)}}) {
    CAPTURE(act.verb);
    World world;
    sleeping(world);
    const double height = rigid(world, 1).pose.position.y();
    world.act(act);
    run(world, 10);
    CHECK(std::abs(rigid(world, 1).pose.position.y() - height) > 0.05);
  }
}

TEST_CASE("worlds with pulls, pushes and deleted bodies have the same states on any thread, and from a snapshot") {
  const auto make = [](World& world) {
    world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
    for (int i = 0; i < 4; ++i) world.add_body(cube("c" + std::to_string(i), 0.2, Vec3(0.01 * i, 0.15 + 0.21 * i, 0)));
    world.add_body(soft_cube("soft", 0.3, 3, Vec3(0.6, 0.1, 0)));
    world.parameters.simulation.integrator = "newmark";
    world.start();
  };
  const auto go = [](World& world, int from, int to) {
    std::vector<std::uint64_t> list;
    for (int k = from; k < to; ++k) {
      if (k == 3) world.act(pull("c1", Vec3(0.1, 0.1, 0.1), Vec3(1, 1, 0)));
      if (k == 4) world.act(pull("soft", Vec3(0.3, 0.3, 0.3), Vec3(1, 2, 0)));
      if (k == 8) world.act({Act::remove, "c2"});
      if (k == 14) world.act({Act::push, "soft", Vec3(1, 0, 3), Vec3(0.6, 0.2, 0)});
      if (k == 20) world.act({Act::release, "c1"});
      world.step();
      list.push_back(world.record().stats.state_hash);
    }
    return list;
  };
  World first;
  std::vector<std::uint64_t> hashes;
  {
    const Threads one(1);
    make(first);
    hashes = go(first, 0, 30);
  }
  const Threads two(2);
  World second, third;
  make(second), make(third);
  go(second, 0, 10);
  ByteWriter state;
  second.save(state);
  ByteReader in(state.bytes());
  third.restore(in);
  CHECK(in.at_end());
  CHECK(third.record().bodies[3].deleted);
  CHECK(third.record().bodies[2].pull->target == Vec3(1, 1, 0));
  CHECK((go(third, 10, 30) == std::vector(hashes.begin() + 10, hashes.end())));
  CHECK((go(second, 10, 30) == std::vector(hashes.begin() + 10, hashes.end())));
}

TEST_CASE("a hard pull, through a floor and back, leaves every response and integrator finite", "[methods]") {
  for (const auto& response : responses())
    for (const auto& integrator : integrators())
      for (const double stiffness : {0.0, 1e9}) {
        CAPTURE(response.name, integrator.name, stiffness);
        World world;
        world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
        world.add_body(cube("a", 0.2, Vec3(0, 0.11, 0)));
        SoftOptions soft;
        soft.damping_beta = 0.001;  // what the explicit scheme bears with these sub-steps
        world.add_body(soft_cube("b", 0.2, 2, Vec3(1, 0.01, 0), soft));
        world.parameters.response.method = response.name;
        world.parameters.simulation.integrator = integrator.name;
        world.parameters.simulation.substeps = 8;
        world.start();
        double fastest = 0.0;
        for (int k = 0; k < 24; ++k) {
          const double depth = k < 12 ? -0.5 : 0.5;
          world.act(pull("a", Vec3(0.1, -0.1, 0.1), Vec3(0.3, depth, 0), stiffness));
          world.act(pull("b", Vec3(0.2, 0, 0.2), Vec3(1.3, depth, 0), stiffness));
          REQUIRE_NOTHROW(world.step());
          for (const Body& body : world.bodies()) fastest = std::max(fastest, body.twist().linear.norm());
        }
        // 1 m at most, in no less than a sub-step
        CHECK(fastest < 1.0 / world.parameters.simulation.time_step());
      }
}
