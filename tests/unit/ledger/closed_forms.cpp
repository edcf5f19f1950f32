// Entries of the books against closed forms of mechanics: what a fall, a bounce, a slide, a push or a lift has to cost.
#include <catch2/catch.hpp>

#include "engine/ledger/ledger.hpp"
#include "engine/step/act.hpp"
#include "tests/support/mechanics/deformable_bodies.hpp"
#include "tests/support/mechanics/ledgers.hpp"
#include "tests/support/mechanics/methods.hpp"
#include "tests/support/mechanics/response_worlds.hpp"
#include "tests/support/mechanics/slides.hpp"

using namespace impinge;
using namespace impinge::test;
using LedgerSource::attachment, LedgerSource::damping, LedgerSource::friction, LedgerSource::gravity,
    LedgerSource::impact;
using LedgerSource::integrator, LedgerSource::push_out, LedgerSource::script, LedgerSource::solver;

namespace {

constexpr double kBooks = 1e-9;

void check_books(const RunLedger& books) {
  CHECK(books.turnover > 0.0);
  CHECK(books.energy_share() < kBooks);
  CHECK(books.momentum_share() < kBooks);
}

/// All others did nothing, to rounding.
void check_nothing_else(const RunLedger& books, std::initializer_list<LedgerSource> some) {
  for (const LedgerSourceInfo& info : ledger_sources()) {
    if (std::find(some.begin(), some.end(), info.source) != some.end()) continue;
    CAPTURE(info.name);
    CHECK(std::abs(books.world().figure(info.source)) <= 1e-12 * books.turnover);
  }
}

}  // namespace

TEST_CASE("ledger: a free fall is gravity's, and what symplectic Euler misses of it is a half m g² h² a sub-step") {
  World world;
  world.add_body(cube("a", 0.2, {0.3, 5, 0}));
  world.start();
  const RunLedger books = keep_books(world, 30);
  const double m = world.bodies()[0].mass, h = world.parameters.simulation.time_step(), g = kGravity;
  const double speed = g * 120 * h;
  CHECK(books.figure(gravity) == Approx(0.5 * m * speed * speed).epsilon(1e-12));
  CHECK(books.figure(integrator) == Approx(-120 * 0.5 * m * g * g * h * h).epsilon(1e-10));
  CHECK(books.bodies[0][gravity].momentum.y() == Approx(-m * speed).epsilon(1e-12));
  CHECK(books.bodies[0][gravity].angular_momentum.z() == Approx(-0.3 * m * speed).epsilon(1e-12));
  check_nothing_else(books, {gravity, integrator});
  check_books(books);
}

TEST_CASE(
    "ledger: what a parameter that changes between frames does is the script's, and the rise is that of the figures") {
  World world;
  world.add_body(cube("a", 0.2, {0.3, 5, 0}));
  BodyDescription jelly = soft_cube("jelly", 0.2, 2, {2, 1, 0}, {1e4, 0.3, 1000.0, 0.0, "linear"});
  world.add_body(jelly);
  world.start();
  deformable(world, 1).position.head(9) *= 1.01;
  deformable(world, 1).update_world_vertices();
  world.parameters.record.ledger = true;
  world.step();
  const auto energy = [&] {
    const FrameStats& now = world.record().stats;
    return now.kinetic + now.potential + now.elastic;
  };
  const double m = world.bodies()[0].mass, height = world.bodies()[0].pose.position.y(),
               elastic = deformable(world, 1).elastic_energy(), before = energy();
  const double weighed = deformable(world, 1).balance(-Vec3::UnitY()).potential;  // Σ m y
  CHECK(elastic > 0.0);
  set(world, "simulation.gravity", "[0, -4, 0]");
  ParameterSet rows;
  world.bind_body(rows, world.bodies()[1]);
  const Parameter* young = rows.find("body.jelly.material.young");
  REQUIRE(young != nullptr);
  young->set(parse_value(*young, "3e4"));
  world.step();
  const FrameLedger& books = *world.record().stats.ledger;
  CHECK(books.bodies[0].figure(script) == Approx(m * (4.0 - kGravity) * height).epsilon(1e-12));
  CHECK(books.bodies[1].figure(script) == Approx(2.0 * elastic + (4.0 - kGravity) * weighed).epsilon(1e-9));
  CHECK(books.world().rise.kinetic + books.world().rise.potential + books.world().rise.elastic ==
        Approx(energy() - before).epsilon(1e-9));
  CHECK(std::abs(books.world().closing_error()) < kBooks * books.world().turnover());
  world.step();
  CHECK(world.record().stats.ledger->bodies[0].figure(script) == 0.0);
}

TEST_CASE("ledger: a bounce takes a half (1 - e²) m v², and its momentum goes to the ground") {
  World world;
  world.parameters.simulation.gravity.setZero();
  world.parameters.contact.restitution = 0.6;
  world.parameters.contact.friction = 0.0;
  world.add_body(fixed_plane("ground", Vec3::UnitY(), 0.0));
  BodyDescription ball = dynamic_body("ball", Sphere{0.1}, {0, 0.3, 0});
  ball.velocity = Vec3(0, -3, 0);
  world.add_body(ball);
  world.start();
  const RunLedger books = keep_books(world, 20);
  const double m = world.bodies()[1].mass;
  CHECK(books.figure(impact, 1) == Approx(-0.5 * (1.0 - 0.36) * m * 9.0).epsilon(1e-12));
  CHECK(books.bodies[1][impact].momentum.y() == Approx(1.6 * m * 3.0).epsilon(1e-12));
  check_nothing_else(books, {impact});
  check_books(books);
}

TEST_CASE("ledger: a cradle hands its energy on, in sub-steps that are cut and repeated") {
  World world;
  add_cradle(world, 5e-4, 2.0);
  world.start();
  const double m = world.bodies()[0].mass, energy = 0.5 * m * 4.0;
  const RunLedger books = keep_books(world, 10);
  REQUIRE(rigid(world, 4).velocity.x() == Approx(2.0).epsilon(1e-6));
  CHECK(books.figure(impact, 0) == Approx(-energy).epsilon(1e-6));
  CHECK(books.figure(impact, 4) == Approx(energy).epsilon(1e-6));
  CHECK(std::abs(books.world().figure(impact)) < 1e-6 * energy);
  CHECK(books.world()[impact].momentum.norm() < 1e-12 * m);
  check_books(books);
}

TEST_CASE("ledger: what slides loses mu m g by the way to friction") {
  World world;
  world.parameters.contact.friction = 0.3;
  world.parameters.simulation.sleeping = false;
  world.add_body(fixed_plane("ground", Vec3::UnitY(), 0.0));
  BodyDescription box = dynamic_body("box", Box{{0.4, 0.05, 0.4}}, {0, 0.05, 0});
  box.velocity = Vec3(2, 0, 0);
  world.add_body(box);
  world.start();
  const double m = world.bodies()[1].mass;
  const RunLedger books = keep_books(world, 20);  // it still slides
  const double v = rigid(world, 1).velocity.x();
  REQUIRE(v > 0.5);
  CHECK(books.figure(friction, 1) == Approx(0.5 * m * (v * v - 4.0)).epsilon(1e-9));
  // the work of the mean velocity, h g mu / 2 ahead of that of the way
  const double way = world.bodies()[1].pose.position.x(), h = world.parameters.simulation.time_step();
  CHECK(books.figure(friction, 1) ==
        Approx(-0.3 * m * kGravity * (way + 80 * 0.5 * h * h * 0.3 * kGravity)).epsilon(1e-7));
  check_books(books);
}

TEST_CASE("ledger: a pendulum's attachment does no work but what its drift is worth") {
  World world;
  prepare_slides(world, Vec3(0, -kGravity, 0), 32);
  world.add_body(cube("bob", 0.1, {1, 0, 0}));
  world.add_attachment({"pin", "bob", "", Vec3::Zero()});
  world.start();
  const RunLedger books = keep_books(world, 60);
  CHECK(std::abs(books.figure(attachment)) < 0.01 * books.figure(gravity));
  CHECK(books.bodies[0][attachment].momentum.norm() > 0.0);
  check_nothing_else(books, {gravity, attachment, integrator});
  check_books(books);
}

TEST_CASE("ledger: a spinning body that is left alone has empty books") {
  World world;
  world.parameters.simulation.gravity.setZero();
  BodyDescription box = dynamic_body("box", Box{{0.1, 0.2, 0.35}}, {1, 2, 3});
  box.angular_velocity = Vec3(0.1, 9, 0.1);
  box.velocity = Vec3(1, 0, 2);
  world.add_body(box);
  world.start();
  const double kinetic = rigid(world, 0).balance(Vec3::Zero()).kinetic;
  const RunLedger books = keep_books(world, 60);
  CHECK(books.turnover < 1e-12 * kinetic);
  CHECK(books.motion_error < 1e-12 * kinetic);
  CHECK(books.spin_error < 1e-12 * rigid(world, 0).balance(Vec3::Zero()).angular_momentum.norm());
}

TEST_CASE("ledger: recovery from overlap lifts bodies, and that is all it does") {
  World world;
  world.parameters.simulation.sleeping = false;
  world.add_body(fixed_plane("ground", Vec3::UnitY(), 0.0));
  world.add_body(cube("a", 0.2, {0, 0.1, 0}));
  world.add_body(cube("b", 0.2, {0, 0.28, 0}));  // 2 cm inside
  world.start();
  const RunLedger books = keep_books(world, 30);
  const double m = world.bodies()[2].mass;
  const BodyLedger of_b = books.bodies[2];
  CHECK(of_b[push_out].energy() == Approx(m * kGravity * 0.02).epsilon(0.05));
  CHECK(of_b[push_out].momentum.norm() == 0.0);
  CHECK(of_b.rise.potential == Approx(of_b[push_out].stored + of_b[gravity].stored + of_b[integrator].stored));
  check_books(books);
}

TEST_CASE("ledger: a push is the script's, by the velocity of its point in the middle of it") {
  World world;
  world.parameters.simulation.gravity.setZero();
  world.parameters.record.ledger = true;
  BodyDescription ball = dynamic_body("ball", Sphere{0.1}, {0, 1, 0});
  ball.velocity = Vec3(2, 0, 0);
  world.add_body(ball);
  world.start();
  const double m = world.bodies()[0].mass;
  world.act({Act::push, "ball", Vec3(3, 0, 0)});
  RunLedger books = keep_books(world, 2);
  CHECK(books.figure(script) == Approx(3.0 * (2.0 + 1.5 / m)).epsilon(1e-12));
  CHECK(books.bodies[0][script].momentum.x() == Approx(3.0).epsilon(1e-12));
  CHECK(books.bodies[0][script].angular_momentum.z() == Approx(-3.0).epsilon(1e-12));
  check_nothing_else(books, {script});
  check_books(books);

  // off the centre it turns the ball too: 2/5 m r² of a sphere
  const double spin = 0.1 * 0.7 / (0.4 * m * 0.01), before = rigid(world, 0).balance(Vec3::Zero()).kinetic;
  world.act({Act::push, "ball", Vec3(0, 0, 0.7), Vec3(world.bodies()[0].pose.position + Vec3(0.1, 0, 0))});
  books = keep_books(world, 1);
  CHECK(books.figure(script) == Approx(0.49 / (2.0 * m) + 0.5 * 0.4 * m * 0.01 * spin * spin).epsilon(1e-9));
  CHECK(rigid(world, 0).balance(Vec3::Zero()).kinetic - before == Approx(books.figure(script)).epsilon(1e-9));
  check_books(books);
}

TEST_CASE("ledger: what is moved or deleted takes its energy from the script, and what is pulled gets it there") {
  World world;
  world.parameters.record.ledger = true;
  world.add_body(cube("a", 0.2, {0, 1, 0}));
  world.start();
  const double m = world.bodies()[0].mass;
  world.act({Act::move, "a", Vec3(0, 2, 0)});
  RunLedger books = keep_books(world, 1);
  CHECK(books.figure(script) == Approx(m * kGravity * 2.0).epsilon(1e-12));
  check_books(books);
  const Balance before = rigid(world, 0).balance(world.parameters.simulation.gravity);
  world.act({Act::remove, "a"});
  books = keep_books(world, 1);
  CHECK(books.figure(script) == Approx(-before.kinetic - before.potential).epsilon(1e-12));
  check_books(books);

  // what comes brings its own: 1/2 m v^2 and m g h
  World joined;
  joined.parameters.record.ledger = true;
  joined.add_body(cube("a", 0.2, {0, 1, 0}));
  BodyDescription late = cube("late", 0.2, {1, 3, 0});
  late.velocity = Vec3(0.0, 2.0, 0.0);
  joined.add_absent_body(late);
  joined.start();
  joined.act({Act::add, "late"});
  books = keep_books(joined, 1);
  CHECK(books.figure(script, 1) == Approx(m * (0.5 * 4.0 + kGravity * 3.0)).epsilon(1e-12));
  check_books(books);

  World pulled;
  pulled.parameters.simulation.gravity.setZero();
  pulled.add_body(cube("a", 0.2, Vec3::Zero()));
  pulled.start();
  pulled.act({Act::pull, "a", Vec3(1, 0.5, 0), Vec3(0.1, 0, 0.05)});
  books = keep_books(pulled, 20);
  CHECK(books.figure(script) == Approx(rigid(pulled, 0).balance(Vec3::Zero()).kinetic).epsilon(1e-10));
  check_nothing_else(books, {script, integrator});
  check_books(books);
}

TEST_CASE("ledger: a floor that lifts a box gives what the box has more of in the end") {
  World world;
  world.parameters.simulation.sleeping = false;
  BodyDescription floor;
  floor.name = "floor";
  floor.kind = BodyKind::scripted;
  floor.shape = Box{{1, 0.1, 1}};
  floor.motion = {{0.0, Vec3(0, -0.1, 0)}, {1.0, Vec3(0, 0.4, 0)}};
  world.add_body(floor);
  world.add_body(cube("box", 0.2, {0, 0.1, 0}));
  world.start();
  const RunLedger books = keep_books(world, 66);
  const double m = world.bodies()[1].mass, work = m * kGravity * 0.5;
  CHECK(books.figure(script, 1) == Approx(work).epsilon(0.01));
  CHECK(std::abs(books.figure(impact, 1)) < 0.01 * work);
  CHECK(books.bodies[1].rise.potential == Approx(work).epsilon(0.01));
  check_books(books);
}

TEST_CASE("ledger: a soft cube that lands gives to elasticity and damping, and the books close for every integrator") {
  for (const auto& [name, doc, make] : integrators()) {
    CAPTURE(name);
    World world;
    world.parameters.simulation.integrator = name;
    world.parameters.simulation.substeps = name == "symplectic_euler" ? 32 : 4;
    set(world, "simulation.sleeping", "false");
    SoftOptions soft;
    soft.damping_beta = 0.002;
    world.add_body(fixed_plane("ground", Vec3::UnitY(), 0.0));
    world.add_body(soft_cube("jelly", 0.2, 2, Vec3(-0.1, 0.02, -0.1), soft));
    world.start();
    const RunLedger books = keep_books(world, 30);
    CHECK(books.figure(damping, 1) < 0.0);
    CHECK(books.figure(impact, 1) < 0.0);
    CHECK(books.figure(gravity, 1) > 0.0);
    CHECK(books.bodies[1].rise.elastic > 0.0);
    CHECK(std::abs(books.figure(solver, 1)) < 1e-5 * books.figure(gravity, 1));
    INFO(books.energy_share() << " " << books.momentum_share());
    check_books(books);
  }
}

TEST_CASE("ledger: what falls asleep gives up its motion, once") {
  World world;
  world.add_body(fixed_plane("ground", Vec3::UnitY(), 0.0));
  world.add_body(cube("a", 0.2, {0, 0.101, 0}));
  world.start();
  const RunLedger books = keep_books(world, 200);
  REQUIRE(world.bodies()[1].asleep);
  CHECK(books.figure(LedgerSource::sleep, 1) <= 0.0);
  CHECK(world.record().stats.ledger->bodies[1].turnover() == 0.0);
  check_books(books);
}
