// Velocities of the middle of sub-steps: what moves converges to second order in the sub-step against formulas, and what
// rests goes on resting.
#include <catch2/catch.hpp>
#include <cmath>

#include "engine/step/act.hpp"
#include "tests/support/mechanics/deformable_bodies.hpp"
#include "tests/support/mechanics/ledgers.hpp"
#include "tests/support/mechanics/methods.hpp"
#include "tests/support/mechanics/response_worlds.hpp"
#include "tests/support/mechanics/state_hashes.hpp"
#include "tests/support/mechanics/timed_motions.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

constexpr double kExact = 1e-9;  // an error below this is rounding, or a solver's tolerance

void in_the_middle(World& world) { world.parameters.simulation.velocities = VelocityTime::middle; }

std::vector<double> errors_of(const TimedMotion& motion, const std::function<void(World&)>& settings,
                              const std::vector<int>& substeps = {4, 8, 16}) {
  std::vector<double> errors;
  for (const int n : substeps) errors.push_back(motion.error({n, settings}));
  return errors;
}

/// Of second order, or exact.
void check_second(const TimedMotion& motion, const std::function<void(World&)>& settings) {
  const std::vector<double> errors = errors_of(motion, settings);
  CAPTURE(motion.name, errors);
  if (errors.back() > kExact) CHECK(observed_order(errors) > 1.8);
}

const std::vector<const char*> kRigid = {"free fall, place",     "free fall, speed",          "sliding, place",
                                         "sliding, speed",       "sliding to a stop",         "bounce, height",
                                         "bounce, place",        "pendulum, angle after 3 s", "pendulum, period",
                                         "rolling down a slope", "skidding into rolling"};

bool moves_once_a_sub_step(std::string_view response) {
  const auto method = find_entry(responses(), response)->make();
  return !method->is_approximate() || method->lives_on_overlap();
}

}  // namespace

TEST_CASE("with velocities of the middle rigid bodies move to second order in the sub-step") {
  for (const char* name : kRigid) check_second(timed_motion(name), in_the_middle);
}

TEST_CASE("with velocities of the end they move to first order, by the known amount") {
  const double h = 1.0 / 240.0;
  CHECK(timed_motion("free fall, place").error({4}) == Approx(0.5 * kGravity * h).epsilon(1e-9));
  const std::vector<double> stop = errors_of(timed_motion("sliding to a stop"), [](World&) {});
  CHECK(stop[0] == Approx(0.5 * 1.575 * h).epsilon(0.02));  // v h / 2
  CHECK(observed_order(stop) == Approx(1.0).margin(0.1));
}

TEST_CASE("with velocities of the middle symplectic_euler moves what deforms to second order") {
  const auto settings = [](World& world) {
    in_the_middle(world);
    world.parameters.simulation.integrator = "symplectic_euler";
  };
  for (const char* name : {"soft: free fall", "soft: free oscillation", "soft: hanging on an attachment"})
    check_second(timed_motion(name), settings);
}

TEST_CASE("a pendulum keeps its swing over a minute with velocities of the middle") {
  CHECK(std::abs(swing_left({4, in_the_middle}, 60.0) - 1.0) < 1e-4);
}

TEST_CASE("every response that moves bodies once a sub-step slides to second order with velocities of the middle") {
  for (const auto& response : responses()) {
    if (!moves_once_a_sub_step(response.name)) continue;
    const auto settings = [&](World& world) {
      use(world, response.name);
      in_the_middle(world);
    };
    const std::vector<double> fall = errors_of(timed_motion("free fall, place"), settings);
    const std::vector<double> slide = errors_of(timed_motion("sliding, place"), settings);
    CAPTURE(response.name, fall, slide);
    CHECK(fall.back() < kExact);
    if (!regularised(response.name) && slide.back() > 1e-7) CHECK(observed_order(slide) > 1.8);
    if (regularised(response.name))
      CHECK(slide.front() < 0.003);  // a third of a per cent of the way: springs sink first
  }
}

TEST_CASE("a response with shorter steps of its own is refused velocities of the middle") {
  for (const auto& response : responses()) {
    World world;
    use(world, response.name);
    in_the_middle(world);
    world.add_body(cube("cube", 0.2, {0, 0, 0}));
    if (moves_once_a_sub_step(response.name))
      CHECK_NOTHROW(world.start());
    else
      CHECK_THROWS_WITH(world.start(), Catch::Contains("simulation.velocities is middle with response.method"));
  }
}

TEST_CASE("a stack of boxes stands with velocities of the middle, with a restitution too") {
  for (const double restitution : {0.0, 0.5}) {
    World world;
    in_the_middle(world);
    world.parameters.contact.restitution = restitution;
    world.parameters.simulation.sleeping = false;
    world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
    for (int i = 0; i < 5; ++i)
      world.add_body(cube("box" + std::to_string(i), 0.2, {0.01 * (i % 2), 0.1 + 0.2 * i, 0}));
    world.start();
    double fastest = 0.0;
    for (int i = 0; i < 300; ++i) {
      world.step();
      for (const BodyRecord& body : world.record().bodies) fastest = std::max(fastest, body.velocity.norm());
    }
    CAPTURE(restitution);
    CHECK(fastest < 1e-6);
    for (int i = 0; i < 5; ++i) {
      const Vec3 at = world.bodies()[1 + i].pose.position;
      CHECK((at - Vec3(0.01 * (i % 2), 0.1 + 0.2 * i, 0)).norm() < 1e-6);
    }
  }
}

TEST_CASE("a ball that bounces with velocities of the middle wins nothing and comes to rest") {
  World world;
  in_the_middle(world);
  world.parameters.contact.restitution = 0.8;
  world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
  world.add_body(dynamic_body("ball", Sphere{0.1}, {0, 1.1, 0}));
  world.start();
  double most = 1.0, lowest = 1.0;  // of its energy over m g, between impacts
  for (int i = 0; i < 600; ++i) {
    world.step();
    const double y = world.bodies()[1].pose.position.y() - 0.1, v = world.record().bodies[1].velocity.y();
    lowest = std::min(lowest, y);
    most = std::max(most, y + v * v / (2.0 * kGravity));
  }
  CHECK(most < 1.0 + 1e-6);
  CHECK(lowest > -1e-6);
  CHECK(world.bodies()[1].pose.position.y() == Approx(0.1).margin(1e-6));
  CHECK(world.record().bodies[1].velocity.norm() < 1e-6);
}

TEST_CASE("the books close with velocities of the middle") {
  World world;
  in_the_middle(world);
  world.parameters.contact.restitution = 0.4;
  world.parameters.simulation.integrator = "symplectic_euler";
  world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
  BodyDescription box = cube("box", 0.2, {0, 0.5, 0});
  box.rotation = {20, 30, 10}, box.velocity = {1, 0, 0}, box.angular_velocity = {1, 2, 3};
  world.add_body(box);
  SoftOptions soft;
  soft.young = 2e4, soft.damping_beta = 0.0;
  world.add_body(soft_cube("soft", 0.2, 1, {0.6, 0.3, 0}, soft));
  world.start();
  const RunLedger books = keep_books(world, 60);
  CHECK(books.energy_share() < 1e-9);
  CHECK(books.momentum_share() < 1e-9);
}

TEST_CASE("a state with velocities of the middle goes on from a snapshot bit for bit") {
  const auto build = [](World& world) {
    in_the_middle(world);
    world.parameters.contact.restitution = 0.3;
    world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
    for (int i = 0; i < 3; ++i) {
      BodyDescription box = cube("box" + std::to_string(i), 0.2, {0.05 * i, 0.3 + 0.3 * i, 0});
      box.velocity = {1, 0, 0.2};
      world.add_body(box);
    }
    world.start();
  };
  World whole, later;
  build(whole), build(later);
  run(whole, 17);
  ByteWriter state;
  whole.save(state);
  ByteReader in(state.bytes());
  later.restore(in);
  CHECK(later.record().bodies[1].velocity == whole.record().bodies[1].velocity);
  CHECK(hashes(whole, 40) == hashes(later, 40));
}

namespace {

/// Of a body: where it is and how fast it moves, along y.
std::pair<double, double> upright(const World& world, int body) {
  const BodyRecord& record = world.record().bodies[static_cast<std::size_t>(body)];
  return {world.bodies()[body].center_of_mass().y(), record.velocity.y()};
}

}  // namespace

TEST_CASE(
    "gravity that changes in a run with velocities of the middle acts from then on, and the one before until then") {
  for (const int substeps : {1, 4, 16})
    for (const bool is_soft : {false, true}) {
      CAPTURE(substeps, is_soft);
      World world;
      in_the_middle(world);
      world.parameters.simulation.substeps = substeps;
      world.parameters.simulation.integrator = "symplectic_euler";
      SoftOptions soft;
      soft.young = 2e3, soft.damping_beta = 0.0;
      world.add_body(is_soft ? soft_cube("body", 0.2, 1, {0, 4.9, 0}, soft)
                             : dynamic_body("body", Sphere{0.1}, {0, 5, 0}));
      world.start();
      const double frame = world.parameters.simulation.frame_time, before = 20 * frame, after = 15 * frame;
      run(world, 20);
      world.parameters.simulation.gravity = {0, 5, 0};
      world.parameters_changed();
      const RunLedger later = keep_books(world, 15);
      const auto [y, v] = upright(world, 0);
      const double turned = -kGravity * before;
      CHECK(v == Approx(turned + 5.0 * after).margin(1e-9));
      CHECK(y == Approx(5.0 + 0.5 * turned * before + turned * after + 2.5 * after * after).margin(1e-9));
      CHECK(later.momentum_share() < 1e-9);
    }
}

TEST_CASE("what loses its support with velocities of the middle falls from rest, as long as it has none") {
  for (const bool hangs : {false, true})
    for (const int substeps : {1, 4, 16}) {
      CAPTURE(hangs, substeps);
      World world;
      in_the_middle(world);
      world.parameters.simulation.substeps = substeps;
      world.parameters.simulation.sleeping = false;
      BodyDescription support = cube(hangs ? "hook" : "post", 0.2, {0, 0.1, 0});
      support.kind = BodyKind::fixed;
      world.add_body(support);
      const double side = hangs ? -1.0 : 1.0;
      for (int i = 0; i < 2; ++i)
        world.add_body(cube("box" + std::to_string(i), 0.2, {0, 0.1 + side * 0.2 * (i + 1), 0}));
      for (int i = 0; hangs && i < 2; ++i)
        for (const double x : {-0.05, 0.05}) {
          AttachmentDescription pin{"pin" + std::to_string(i), "box" + std::to_string(i), i == 0 ? "hook" : "box0",
                                    Vec3(x, -0.2 * i, 0)};
          pin.collide = false;
          world.add_attachment(pin);
        }
      world.start();
      run(world, 20);
      const std::vector<double> before = {upright(world, 1).first, upright(world, 2).first};
      Act act;
      act.verb = Act::remove, act.body = support.name;
      world.act(act);
      const RunLedger books = keep_books(world, 12);
      const double fallen = 12 * world.parameters.simulation.frame_time;
      for (int i = 0; i < 2; ++i) {
        const auto [y, v] = upright(world, 1 + i);
        CHECK(v == Approx(-kGravity * fallen).epsilon(1e-6));
        CHECK(y - before[static_cast<std::size_t>(i)] == Approx(-0.5 * kGravity * fallen * fallen).epsilon(1e-5));
      }
      CHECK(books.momentum_share() < 1e-9);
    }
}

TEST_CASE("a pull acts with velocities of the middle from when it begins until it ends") {
  for (const int substeps : {1, 4, 16}) {
    CAPTURE(substeps);
    World world;
    in_the_middle(world);
    world.parameters.simulation.gravity.setZero();
    world.parameters.simulation.substeps = substeps;
    BodyDescription ball = dynamic_body("ball", Sphere{0.1}, {0, 0, 0});
    ball.mass = 1.0;
    world.add_body(ball);
    world.start();
    run(world, 3);
    Act act;  // as good as a force of 1 N: its spring is soft and long, and its damping hardly there
    act.body = "ball", act.vector = {0, 1e10, 0}, act.point = Vec3::Zero(), act.stiffness = 1e-10;
    world.act(act);
    run(world, 20);
    const double frame = world.parameters.simulation.frame_time, pulled = 20 * frame, free = 10 * frame;
    CHECK(upright(world, 0).second == Approx(pulled).epsilon(1e-4));
    act.verb = Act::release;
    world.act(act);
    run(world, 10);
    const auto [y, v] = upright(world, 0);
    CHECK(v == Approx(pulled).epsilon(1e-4));
    CHECK(y == Approx(0.5 * pulled * pulled + pulled * free).epsilon(1e-4));
  }
}
