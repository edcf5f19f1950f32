// What is attached holds together, whatever swings, at whatever size and mass, in few sub-steps and under every response
// that has no excuse: points against each other, energy against what the fall gives.
#include <catch2/catch.hpp>

#include "tests/support/mechanics/chains.hpp"
#include "tests/support/mechanics/deformable_bodies.hpp"
#include "tests/support/mechanics/methods.hpp"
#include "tests/support/mechanics/worlds.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

constexpr double kFrame = 1.0 / 60.0;
constexpr double kWon = 0.06;  // of the fall: small links in few sub-steps a swing have energies so far off

/// A chain of bars on points, let go level: its first point is the world's. The last bar is `ratio` times as dense.
void add_chain(World& world, int links, double length, double ratio) {
  for (int i = 0; i < links; ++i) {
    BodyDescription bar =
        dynamic_body("bar" + std::to_string(i), Box{length * Vec3(0.5, 0.1, 0.1)}, Vec3((i + 0.5) * length, 0.0, 0.0));
    if (i == links - 1) bar.density *= ratio;
    world.add_body(bar);
  }
  for (int i = 0; i < links; ++i) {
    AttachmentDescription pin{"pin" + std::to_string(i), "bar" + std::to_string(i),
                              i > 0 ? "bar" + std::to_string(i - 1) : "", Vec3(i * length, 0.0, 0.0)};
    pin.collide = false;
    world.add_attachment(pin);
  }
}

struct Swing {
  double apart = 0.0;  // of a link
  double won = 0.0;    // of what the fall of all of it to straight down gives
};

/// Two of its swings.
Swing swing(World& world, int links, double length) {
  world.start();
  double fall = 0.0;
  for (int i = 0; i < links; ++i) fall += world.bodies()[i].mass * kGravity * (i + 0.5) * length;
  const double period = 2.0 * M_PI * std::sqrt(links * length / kGravity);
  Swing result;
  double first = 0.0;
  const int frames = static_cast<int>(2.0 * period / world.parameters.simulation.frame_time) + 30;
  for (int frame = 0; frame < frames; ++frame) {
    world.step();
    for (const AttachmentRecord& pin : world.record().attachments)
      result.apart = std::max(result.apart, (pin.point_a - pin.point_b).norm() / length);
    const double energy = world.record().stats.kinetic + world.record().stats.potential;
    if (frame == 0) first = energy;
    result.won = std::max(result.won, (energy - first) / fall);
  }
  return result;
}

/// A link of 1 kg on a point of the world, a load on it: a ball by its middle. What is carried is far more than either end of
/// the link lets move, and W has eigenvalues as far apart.
void add_hung(World& world, const SharedShape& link, double load, const Vec3& to) {
  const double tilt = std::atan2(to.x(), -to.y());
  BodyDescription of_link = dynamic_body("link", link, 0.5 * to);
  of_link.rotation.z() = tilt * 180.0 / M_PI;
  of_link.mass = 1.0;
  BodyDescription ball = dynamic_body("load", Sphere{0.05}, to);
  ball.mass = load;
  world.add_body(of_link);
  world.add_body(ball);
  AttachmentDescription above{"above", "link", "", Vec3::Zero()};
  AttachmentDescription below{"below", "link", "load", to};
  below.collide = false;
  world.add_attachment(above);
  world.add_attachment(below);
}

constexpr double kLoads[] = {1e3, 1e4, 1e5, 1e6};  // kg

}  // namespace

TEST_CASE("what hangs straight on a link that weighs a millionth of it stays, and pulls with its weight") {
  for (const bool is_rod : {false, true})
    for (const double load : kLoads) {
      CAPTURE(is_rod, load);
      World world;
      world.parameters.simulation.sleeping = false;
      add_hung(world, is_rod ? SharedShape(Box{Vec3(0.025, 0.5, 0.025)}) : SharedShape(Sphere{0.05}), load,
               Vec3(0.0, -1.0, 0.0));
      world.start();
      for (int frame = 0; frame < 30; ++frame) {
        world.step();
        REQUIRE(world.record().stats.unconverged == 0);
      }
      CHECK(std::abs(world.bodies()[1].pose.position.y() + 1.0) < 1e-8);
      CHECK(world.bodies()[0].pose.position.head<2>().isApprox(Vec2(0.0, -0.5), 1e-8));
      const double h = world.parameters.simulation.time_step();
      CHECK(world.record().attachments[0].impulse.y() == Approx((load + 1.0) * kGravity * h).epsilon(1e-6));
      CHECK(std::abs(world.record().attachments[1].impulse.y()) == Approx(load * kGravity * h).epsilon(1e-6));
    }
}

TEST_CASE("what hangs aslant on a light link swings as its pendulum does") {
  for (const bool is_rod : {false, true})
    for (const double load : kLoads) {
      CAPTURE(is_rod, load);
      World world;
      world.parameters.simulation.sleeping = false;
      world.parameters.simulation.substeps = 8;
      const Vec3 to(0.2, -1.0, 0.0);
      add_hung(world, is_rod ? SharedShape(Box{Vec3(0.025, 0.5 * to.norm(), 0.025)}) : SharedShape(Sphere{0.05}), load,
               to);
      world.start();
      const int frames = 12;
      for (int frame = 0; frame < frames; ++frame) {
        world.step();
        REQUIRE(world.record().stats.unconverged == 0);
      }
      // θ'' = -g/L sin θ; the link is less than a thousandth of it
      double angle = std::atan2(to.x(), -to.y()), speed = 0.0;
      const int steps = 20000;
      const double h = frames * world.parameters.simulation.frame_time / steps;
      for (int i = 0; i < steps; ++i) {
        speed -= h * kGravity / to.norm() * std::sin(angle);
        angle += h * speed;
      }
      const Vec3 there = to.norm() * Vec3(std::sin(angle), -std::cos(angle), 0.0);
      CHECK((world.bodies()[1].pose.position - there).norm() < 0.03 * (to - there).norm());
    }
}

TEST_CASE("what hangs on a light link leans on a wall with its share of the weight") {
  for (const double friction : {0.0, 0.5})
    for (const double load : kLoads) {
      CAPTURE(friction, load);
      World world;
      world.parameters.simulation.sleeping = false;
      world.parameters.simulation.gravity = Vec3(1.0, -kGravity, 0.0);
      world.parameters.contact.friction = friction;
      add_hung(world, Sphere{0.05}, load, Vec3(0.0, -1.0, 0.0));
      world.add_body(fixed_plane("wall", -Vec3::UnitX(), -0.05));
      world.start();
      for (int frame = 0; frame < 30; ++frame) {
        world.step();
        REQUIRE(world.record().stats.unconverged == 0);
      }
      CHECK((world.bodies()[1].pose.position - Vec3(0.0, -1.0, 0.0)).norm() < 1e-8);
      const double h = world.parameters.simulation.time_step();
      double pushed = 0.0;
      for (const ContactRecord& c : world.record().contacts) pushed += c.lambda.x();
      // with friction the point above may take a part of it
      const Vec3 above = world.record().attachments[0].impulse;
      CHECK(pushed - above.x() == Approx((load + 1.0) * h).epsilon(1e-6));
      if (friction > 0.0) continue;
      CHECK(pushed == Approx((load + 1.0) * h).epsilon(1e-6));
      CHECK(above.y() == Approx((load + 1.0) * kGravity * h).epsilon(1e-6));
    }
}

TEST_CASE("chains that are let go level hold together, at every size and with a heavy end") {
  for (const double length : {1.0, 0.01})
    for (const double ratio : {1.0, 300.0})
      for (const int links : {2, 8})
        for (const int substeps : {1, 4}) {
          const double step = kFrame / substeps;
          if (kGravity * step * step * ratio / length > 25.0) continue;  // pulled straight too fast, see the README
          CAPTURE(length, ratio, links, substeps);
          World world;
          world.parameters.simulation.substeps = substeps;
          add_chain(world, links, length, ratio);
          const Swing result = swing(world, links, length);
          CHECK(result.apart < 0.1);
          CHECK(result.won < kWon);
        }
}

TEST_CASE("a light chain with an end thirty thousand times as heavy holds") {
  World world;
  add_chain(world, 4, 1.0, 3e4);
  const Swing result = swing(world, 4, 1.0);
  CHECK(result.apart < 0.1);
  CHECK(result.won < kWon);
}

TEST_CASE("penalty holds what is attached as well as constraint anticipation does, in both forms") {
  const auto form = GENERATE(as<std::string>(), "implicit", "explicit");
  for (const int links : {1, 4})
    for (const int of_one : {1, 4}) {
      // four whip in one sub-step: constraint anticipation wins no energy by that, penalty some
      const int substeps = of_one * links;
      CAPTURE(form, links, substeps);
      World exact, springs;
      for (World* world : {&exact, &springs}) {
        world->parameters.simulation.substeps = substeps;
        add_chain(*world, links, 0.2, 1.0);
      }
      springs.parameters.response.method = "penalty";
      set(springs, "response.penalty.form", form);
      exact.start(), springs.start();
      for (int frame = 0; frame < 30; ++frame) {
        exact.step(), springs.step();
        for (int i = 0; i < links; ++i)
          REQUIRE((exact.bodies()[i].pose.position - springs.bodies()[i].pose.position).norm() < 1e-3 * 0.2);
      }
    }
}

TEST_CASE("a chain that floats and turns fast keeps its angular momentum to rounding, and wins no energy") {
  constexpr double kLength = 0.1;
  const auto method = GENERATE(as<std::string>(), "constraint_anticipation", "quick");
  for (const double spin : {10.0, 60.0, 300.0})  // rad/s, a 24th, a quarter and more than one radian a sub-step
    for (const int links : {2, 5}) {
      CAPTURE(method, spin, links);
      World world;
      world.parameters.response.method = method;
      world.parameters.simulation.gravity.setZero();
      world.parameters.simulation.sleeping = false;
      for (int i = 0; i < links; ++i) {
        BodyDescription bar = dynamic_body("bar" + std::to_string(i), Box{kLength * Vec3(0.5, 0.1, 0.1)},
                                           Vec3((i + 0.5) * kLength, 0.0, 0.0));
        bar.velocity = Vec3(0.0, spin * (i + 0.5 - 0.5 * links) * kLength, 0.0);
        bar.angular_velocity = Vec3(0.0, 0.0, spin);
        if (i == 0) bar.velocity *= 1.5;  // so that it bends at its joints
        world.add_body(bar);
      }
      for (int i = 1; i < links; ++i) {
        AttachmentDescription pin{"pin" + std::to_string(i), "bar" + std::to_string(i), "bar" + std::to_string(i - 1),
                                  Vec3(i * kLength, 0.0, 0.0)};
        pin.collide = false;
        world.add_attachment(pin);
      }
      world.start();
      const auto turning = [&] {
        Vec3 sum = Vec3::Zero();
        for (int i = 0; i < links; ++i) {
          const RigidBody& body = rigid(world, i);
          sum += body.pose.position.cross(body.mass * body.velocity) + body.angular_momentum;
        }
        return sum;
      };
      const Vec3 before = turning();
      double first = 0.0;
      for (int frame = 0; frame < 120; ++frame) {
        world.step();
        const double energy = world.record().stats.kinetic;
        if (frame == 0) first = energy;
        CHECK(energy <= 1.01 * first);
        CHECK((turning() - before).norm() <= 1e-10 * before.norm());
      }
    }
}

namespace {

struct HingeRun {
  double fastest = 0.0, won = 0.0;  // kinetic energy, J; of the fall
};

HingeRun run_hinge(World& world, double fall, int frames = 120) {
  world.start();
  double highest = -INFINITY, first = 0.0;
  HingeRun result;
  for (int frame = 0; frame < frames; ++frame) {
    world.step();
    const FrameStats& stats = world.record().stats;
    if (frame == 0) first = stats.kinetic + stats.potential;
    result.fastest = std::max(result.fastest, stats.kinetic);
    highest = std::max(highest, stats.kinetic + stats.potential);
  }
  result.won = (highest - first) / fall;
  return result;
}

}  // namespace

TEST_CASE("a bar that hangs at rest on a hinge stays there, however narrow that is, and one let go keeps its energy") {
  const auto method = GENERATE(as<std::string>(), "quick", "soft_constraint");
  for (const HingeKind kind : {HingeKind::points, HingeKind::point_and_line})
    for (const double half : {0.001, 0.025, 0.05, 0.1, 0.2, 0.5})
      for (const int substeps : {1, 4, 16})
        for (const bool is_level : {false, true}) {
          CAPTURE(method, static_cast<int>(kind), half, substeps, is_level);
          World world;
          settle_method(world, method, substeps);
          BodyDescription bar =
              dynamic_body("bar", Box{Vec3(0.025, 0.5, 0.025)}, is_level ? Vec3(0.5, 0, 0) : Vec3(0, -0.5, 0));
          bar.mass = 1.0;
          if (is_level) bar.rotation.z() = 90.0;
          world.add_body(bar);
          add_hinge(world, kind, "bar", "", Vec3::Zero(), half);
          const double fall = kGravity * 0.5;
          const HingeRun of = run_hinge(world, fall);
          if (!is_level) CHECK(of.fastest < 1e-9 * fall);
          CHECK(of.won < kWon);
        }
}

TEST_CASE("quick and soft_constraint: chains of hinges and of single points let go level win nothing") {
  const auto method = GENERATE(as<std::string>(), "quick", "soft_constraint");
  for (const bool is_rope : {false, true})
    for (const int links : {2, 5, 20})
      for (const double ratio : {1.0, 100.0})
        for (const int substeps : {4, 16, 64}) {
          if (substeps == 64 && links == 20) continue;
          CAPTURE(method, is_rope, links, ratio, substeps);
          World world;
          settle_method(world, method, substeps);
          const double fall =
              add_bars(world, links, ratio, is_rope, links == 5 ? HingeKind::swapped : HingeKind::points);
          CHECK(run_hinge(world, fall).won < 0.02);
        }
}

TEST_CASE("quick and soft_constraint: a linkage that closes, and closes by a tenth of a millimetre not, wins nothing") {
  const auto method = GENERATE(as<std::string>(), "quick", "soft_constraint");
  for (const double off : {0.0, 1e-4})
    for (const int substeps : {4, 16, 64}) {
      CAPTURE(method, off, substeps);
      World world;
      settle_method(world, method, substeps);
      const std::vector<Vec3> joints = {{0, 0, 0}, {0, 0.5, 0}, {1.3, 0.9, 0}, {1.5, 0, 0}};
      double fall = 0.0;
      for (int i = 0; i < 3; ++i) {
        const Vec3 along = joints[i + 1] - joints[i];
        BodyDescription bar = dynamic_body("bar" + std::to_string(i), Box{Vec3(0.5 * along.norm(), 0.025, 0.025)},
                                           0.5 * (joints[i] + joints[i + 1]) + Vec3(0, 0, i == 2 ? off : 0.0));
        bar.rotation.z() = std::atan2(along.y(), along.x()) * 180.0 / M_PI;
        bar.mass = 1.0;
        fall += kGravity * bar.position.y();
        world.add_body(bar);
      }
      for (int i = 0; i < 4; ++i)
        add_hinge(world, HingeKind::points, "bar" + std::to_string(std::min(i, 2)),
                  i == 0 || i == 3 ? "" : "bar" + std::to_string(i - 1), joints[static_cast<std::size_t>(i)], 0.1);
      CHECK(run_hinge(world, fall).won < 0.02);
      CHECK(widest(world) < 1e-3);
    }
}

TEST_CASE(
    "soft_constraint: a bar that bends and hangs on two close points wins nothing, and a rigid one on it neither") {
  for (const double half : {0.01, 0.05})
    for (const int substeps : {1, 4, 16})
      for (const bool carries : {false, true}) {
        CAPTURE(half, substeps, carries);
        World world;
        settle_method(world, "soft_constraint", substeps);
        SoftOptions soft;
        soft.young = 1e5, soft.damping_beta = 0.002;
        world.add_body(soft_box("bar", Vec3(0.5, 0.1, 0.1), Eigen::Vector3i(10, 2, 2), Vec3(0, -0.05, -0.05), soft));
        if (carries) world.add_body(dynamic_body("rod", Box{Vec3(0.15, 0.025, 0.025)}, Vec3(0.65, 0, 0)));
        add_hinge(world, HingeKind::points, "bar", "", Vec3::Zero(), half);
        if (carries) add_hinge(world, HingeKind::swapped, "rod", "bar", Vec3(0.5, 0, 0), half);
        world.start();
        double first = 0.0, highest = -INFINITY;
        for (int frame = 0; frame < 60; ++frame) {
          world.step();
          const FrameStats& stats = world.record().stats;
          const double energy = stats.kinetic + stats.potential + stats.elastic;
          if (frame == 0) first = energy;
          highest = std::max(highest, energy);
        }
        CHECK(highest - first < 1e-6 * kGravity);  // it has 5 kg, and falls by a quarter of a metre
        CHECK(widest(world) < 0.01);
      }
}

TEST_CASE("a wheel that turns about two points of its axle contradicts nothing, wherever it stands") {
  for (const double at : {0.1, 1000.0})
    for (const double spin : {7.5, 0.02})
      for (const double elevation : {0.0, 35.0}) {
        CAPTURE(at, spin, elevation);
        World world;
        world.parameters.simulation.gravity.setZero();
        world.parameters.simulation.sleeping = false;
        BodyDescription wheel = dynamic_body("wheel", Box{Vec3(0.1, 0.1, 0.01)}, Vec3(at, 0, 0));
        wheel.rotation = Vec3(0.0, elevation, 0.0);
        const Vec3 axle(std::sin(elevation * M_PI / 180.0), 0.0, std::cos(elevation * M_PI / 180.0));
        wheel.angular_velocity = spin * axle;
        world.add_body(wheel);
        for (const double side : {-0.02, 0.02})
          world.add_attachment({side < 0.0 ? "left" : "right", "wheel", "", wheel.position + side * axle});
        world.start();
        const Vec3 spoke = world.bodies()[0].pose.rotation.col(0), across = axle.cross(spoke);
        double off = 0.0;
        for (int frame = 1; frame <= 120; ++frame) {
          world.step();
          const FrameStats& stats = world.record().stats;
          CHECK(stats.unconverged == 0);
          CHECK(stats.residual_coulomb <= 1e-8);
          const double angle = spin * frame * kFrame;
          off = std::max(
              off,
              (world.bodies()[0].pose.rotation.col(0) - std::cos(angle) * spoke - std::sin(angle) * across).norm());
        }
        // points are known to 1e-13 m at 1 km, and tilt an axle by that over 0.04 m
        CHECK(off < 1e-11 * std::max(1.0, at));
      }
}

TEST_CASE("a rod that is pulled apart is told so, however slowly") {
  for (const double speed : {1e-8, 1e-3}) {
    CAPTURE(speed);
    World world;
    world.parameters.simulation.gravity.setZero();
    world.add_body(dynamic_body("rod", Box{Vec3(0.5, 0.05, 0.05)}, Vec3::Zero()));
    for (const double side : {-1.0, 1.0}) {
      BodyDescription end = cube(side < 0.0 ? "left" : "right", 0.1, Vec3(0.7 * side, 0, 0));
      end.kind = BodyKind::scripted;
      end.motion = {{0.0, end.position, Vec3::Zero()},
                    {10.0, end.position + 10.0 * side * speed * Vec3::UnitX(), Vec3::Zero()}};
      world.add_body(end);
      AttachmentDescription pin{end.name, "rod", end.name, Vec3(0.5 * side, 0, 0)};
      pin.collide = false;
      world.add_attachment(pin);
    }
    world.start();
    for (int frame = 0; frame < 10; ++frame) {
      world.step();
      CHECK(world.record().stats.unconverged > 0);
    }
  }
}
