// The books of worlds that were thrown together: they close for every response and every integrator, and are the same for
// any number of threads; states don't know of them.
#include <catch2/catch.hpp>

#include "engine/step/act.hpp"
#include "tests/support/mechanics/deformable_bodies.hpp"
#include "tests/support/mechanics/ledgers.hpp"
#include "tests/support/mechanics/methods.hpp"
#include "tests/support/mechanics/response_worlds.hpp"
#include "tests/support/mechanics/state_hashes.hpp"
#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// A floor, one that moves, boxes and balls that fall on both, overlap, are joined or slide; with `soft` a jelly among
/// them, a part of which may be held and moved.
void fill(World& world, Random& random, bool soft) {
  world.parameters.contact.friction = random.in(0.0, 0.8);
  world.parameters.contact.restitution = random.below(2) == 0 ? 0.0 : random.in(0.3, 0.9);
  world.add_body(fixed_plane("ground", Vec3::UnitY(), 0.0));
  BodyDescription lift;
  lift.name = "lift";
  lift.kind = BodyKind::scripted;
  lift.shape = Box{{0.5, 0.05, 0.5}};
  lift.motion = {{0.0, Vec3(1, 0.05, 0)}, {0.3, Vec3(1.1, 0.2, 0), Vec3(0, 20, 5)}};
  world.add_body(lift);
  const int count = 2 + random.below(3);
  for (int i = 0; i < count; ++i) {
    const Vec3 at(0.8 * random.u(), 0.15 + 0.18 * i, 0.3 * random.sym());
    const SharedShape shape = random.below(3) == 0 ? SharedShape(Sphere{0.1}) : SharedShape(Box{{0.1, 0.07, 0.12}});
    BodyDescription body = dynamic_body("body" + std::to_string(i), shape, at);
    body.rotation = 30.0 * random.vector();
    body.velocity = 2.0 * random.vector();
    body.angular_velocity = 5.0 * random.vector();
    world.add_body(body);
  }
  if (soft) {
    SoftOptions options;
    options.young = 3e4;
    options.damping_beta = random.below(2) == 0 ? 0.0 : 0.003;
    BodyDescription jelly = soft_cube("jelly", 0.2, 2, Vec3(-0.4, 0.01, -0.1), options);
    jelly.velocity = Vec3(1.0, -0.5, 0.0);
    world.add_body(jelly);
  }
  if (random.below(2) == 0)
    world.add_attachment({"pin", "body0", "body1", Vec3(0.4, 0.3, 0)});
  else
    world.add_attachment({"rail", "body0", "", Vec3(0.3, 0.2, 0), AttachmentKind::line, Vec3(1, 0.2, 0)});
}

RunLedger run_random(std::uint64_t seed, std::string_view response, std::string_view integrator, bool soft, int frames,
                     World& world) {
  Random random(seed);
  world.parameters.response.method = response;
  world.parameters.simulation.integrator = integrator;
  world.parameters.simulation.substeps = integrator == "symplectic_euler" ? 16 : 2;
  fill(world, random, soft);
  world.start();
  world.parameters.record.ledger = true;
  RunLedger books = keep_books(world, frames / 2);
  world.act({Act::push, "body1", Vec3(0.5, 1.0, 0.2), Vec3(world.bodies()[3].pose.position + Vec3(0.05, 0, 0))});
  world.act({Act::pull, soft ? "jelly" : "body0", Vec3(0.3, 1.0, 0.0), Vec3(0.05, 0.02, 0.0)});
  if (soft) world.act({Act::push, "jelly", Vec3(0, 1, 0), Vec3(-0.4, 0.1, 0)});
  for (int i = 0; i < frames - frames / 2; ++i) {
    world.step();
    books.add(*world.record().stats.ledger);
  }
  return books;
}

void check_closed(const RunLedger& books) {
  CAPTURE(books.turnover, books.motion_error, books.stored_error, books.momentum_share());
  CHECK(books.turnover > 0.0);
  CHECK(books.energy_share() <= 1e-9);
  CHECK(books.momentum_share() <= 1e-9);
}

}  // namespace

TEST_CASE("ledger: the books of random rigid worlds close for every response") {
  for (const auto& [response, doc, make] : responses())
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      CAPTURE(response, seed);
      World world;
      const RunLedger books = run_random(seed, response, "linearly_implicit_euler", false, 24, world);
      check_closed(books);
      // the answers of the responses are Δv = A⁻¹ Jᵀλ to their tolerances, so little is left to the solver
      CHECK(std::abs(books.world().figure(LedgerSource::solver)) <= 1e-5 * books.world().turnover());
    }
}

TEST_CASE("ledger: the books of random worlds with a soft body close for every response and integrator") {
  for (const auto& [response, doc, make] : responses())
    for (const auto& [integrator, doc_of_it, make_it] : integrators()) {
      const std::uint64_t seed = 1 + response.size() + 7 * integrator.size();
      CAPTURE(response, integrator, seed);
      World world;
      const RunLedger books = run_random(seed, response, integrator, true, 10, world);
      check_closed(books);
      CHECK(std::abs(books.world().figure(LedgerSource::solver)) <= 1e-4 * books.world().turnover());
    }
}

TEST_CASE("ledger: what free bodies do to each other keeps momentum, by source") {
  World world;
  world.parameters.simulation.gravity.setZero();
  world.parameters.contact.restitution = 0.5;
  Random random(5);
  for (int i = 0; i < 6; ++i) {
    BodyDescription body = cube("body" + std::to_string(i), 0.2, 0.25 * Vec3(i % 3 - 1, i / 3, 0.1 * i));
    body.velocity = -2.0 * body.position + 0.2 * random.vector();
    body.angular_velocity = random.vector();
    world.add_body(body);
  }
  world.start();
  const RunLedger books = keep_books(world, 30);
  for (const LedgerSource source : {LedgerSource::impact, LedgerSource::friction, LedgerSource::push_out}) {
    double size = 0.0;
    for (const BodyLedger& body : books.bodies) size += body[source].momentum.norm();
    CAPTURE(info_of(source).name, size);
    CHECK(books.world()[source].momentum.norm() <= 1e-12 * (size + 1.0));
    CHECK(books.world()[source].angular_momentum.norm() <= 1e-12 * (size + 1.0));
  }
  check_closed(books);
}

TEST_CASE("ledger: the same for any number of threads, and states don't know of it") {
  const auto run_with = [](int threads, bool keeps) {
    const Threads used(threads);
    World world;
    std::vector<double> figures;
    Random random(3);
    fill(world, random, true);
    world.start();
    world.parameters.record.ledger = keeps;
    world.parameters_changed();
    for (int i = 0; i < 12; ++i) {
      world.step();
      CHECK((world.record().stats.ledger != nullptr) == keeps);
      if (!keeps) continue;
      for (const BodyLedger& body : world.record().stats.ledger->bodies)
        for (const LedgerEntry& entry : body.of)
          for (const double v : {entry.motion, entry.stored, entry.momentum.x(), entry.angular_momentum.z()})
            figures.push_back(v);
    }
    return std::pair(world.state_hash(), figures);
  };
  const auto one = run_with(1, true), four = run_with(4, true), without = run_with(2, false);
  CHECK(one.second.size() > 100);
  CHECK(one == four);
  CHECK(one.first == without.first);
}

TEST_CASE("ledger: a held part that is moved works on the rest, and its reaction is the script's") {
  World world;
  auto soft = soft_cube("jelly", 0.2, 2, Vec3(0, 1, 0));
  auto held = std::make_shared<DeformableDescription>(*soft.deformable);
  NodeRegion top;
  top.kind = NodeRegion::box;
  top.min = Vec3(-1, 0.19, -1), top.max = Vec3(1, 1, 1);
  held->fixed = {top};
  soft.deformable = held;
  world.add_body(soft);
  world.start();
  const RunLedger still = keep_books(world, 10);
  CHECK(still.figure(LedgerSource::script) == 0.0);  // what doesn't move gives no energy, but carries the weight
  CHECK(still.bodies[0][LedgerSource::script].momentum.y() > 0.0);
  check_closed(still);
  deformable(world, 0).held[0].wanted = Vec3(0, 0.1, 0);
  const RunLedger moved = keep_books(world, 10);
  CHECK(moved.figure(LedgerSource::script) > 0.0);
  check_closed(moved);
}
