// A computation that is ended from outside: where it may be, and that nothing is lost by it.
#include <catch2/catch.hpp>

#include <atomic>
#include <chrono>
#include <thread>

#include "engine/core/interrupt.hpp"
#include "engine/core/parallel.hpp"
#include "tests/support/mechanics/deformable_bodies.hpp"
#include "tests/support/mechanics/worlds.hpp"
#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

TEST_CASE("an interrupt is seen in the scope it was lent to, and nowhere else") {
  const std::atomic<bool> up{true}, down{false};
  CHECK_NOTHROW(check_interrupt());
  {
    const InterruptScope scope(&up);
    CHECK_THROWS_AS(check_interrupt(), Interrupted);
    {
      const InterruptScope finish(nullptr);
      CHECK_NOTHROW(check_interrupt());
    }
    {
      const InterruptScope other(&down);
      CHECK_NOTHROW(check_interrupt());
    }
    CHECK_THROWS_AS(check_interrupt(), Interrupted);
    std::thread([] { CHECK_NOTHROW(check_interrupt()); }).join();
  }
  CHECK_NOTHROW(check_interrupt());
}

TEST_CASE("a poll looks at the flag at every thousandth call") {
  const std::atomic<bool> up{true};
  const InterruptScope scope(&up);
  InterruptPoll poll;
  for (int i = 1; i < 1000; ++i) CHECK_NOTHROW(poll());
  CHECK_THROWS_AS(poll(), Interrupted);
}

TEST_CASE("a parallel loop hands the flag on to its threads and ends early") {
  for (const int threads : {1, 3}) {
    set_thread_count(threads);
    std::atomic<bool> flag{false};
    const InterruptScope scope(&flag);
    std::atomic<int> calls{0};
    CHECK_THROWS_AS(parallel_for(100000, 1,
                                 [&](std::size_t) {
                                   if (++calls == 50) flag = true;
                                 }),
                    Interrupted);
    CHECK(calls < 100000);
    flag = false;
    calls = 0;
    parallel_for(1000, 1, [&](std::size_t) { ++calls; });
    CHECK(calls == 1000);
    const InterruptScope none(nullptr);  // threads that served an interrupted loop keep nothing of it
    flag = true;
    CHECK_NOTHROW(parallel_for(1000, 1, [&](std::size_t) { check_interrupt(); }));
  }
  set_thread_count(0);
}

namespace {

std::string state_of(const World& world) {
  ByteWriter out;
  world.save(out);
  return out.bytes();
}

/// Steps the world five frames, each interrupted at random moments until one try comes through; the hashes of the
/// frames.
std::vector<std::uint64_t> stepped(World& world, bool interrupts, int& interrupted) {
  std::vector<std::uint64_t> hashes;
  Random random(7);
  for (int frame = 1; frame <= 5; ++frame) {
    const std::string before = state_of(world);
    for (int tries = 0;; ++tries) {
      std::atomic<bool> flag{false}, ended{false};
      std::thread raiser;
      if (interrupts && tries < 6)
        raiser = std::thread([&, wait = std::chrono::microseconds(static_cast<int>(random.in(0, 3000)))] {
          const auto until = std::chrono::steady_clock::now() + wait;
          while (!ended && std::chrono::steady_clock::now() < until) {
          }
          flag = true;
        });
      bool came_through = true;
      {
        const InterruptScope scope(&flag);
        try {
          world.step();
        } catch (const Interrupted&) {
          came_through = false;
        }
      }
      ended = true;
      if (raiser.joinable()) raiser.join();
      if (came_through) break;
      ++interrupted;
      ByteReader in(before);
      world.restore(in);
    }
    hashes.push_back(world.record().stats.state_hash);
  }
  return hashes;
}

struct Methods {
  const char *response, *integrator;
  ContactPoints points;
};

void fill(World& world, const Methods& methods) {
  world.parameters.response.method = methods.response;
  world.parameters.simulation.integrator = methods.integrator;
  world.parameters.contact.points = methods.points;
  world.parameters.simulation.substeps = 2;
  world.parameters.contact.friction = 0.4;
  world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
  Random random(3);
  for (int i = 0; i < 12; ++i)
    world.add_body(
        cube("cube" + std::to_string(i), 0.2, Vec3(random.in(-0.1, 0.1), 0.12 + 0.05 * i, random.in(-0.1, 0.1))));
  world.add_body(soft_cube("soft", 0.2, 3, {0.2, 0.01, 0.0}));
  world.add_body(soft_cube("softer", 0.2, 2, {0.3, 0.2, 0.05}));
  world.start();
}

}  // namespace

TEST_CASE("a step that was interrupted and taken back comes out the same bit for bit") {
  const Methods all[] = {{"constraint_anticipation", "linearly_implicit_euler", ContactPoints::proximity},
                         {"iterative_constraint_anticipation", "implicit_euler", ContactPoints::proximity},
                         {"iterative_constraint_anticipation", "newmark", ContactPoints::intersection},
                         {"sequential_impulse", "linearly_implicit_euler", ContactPoints::proximity},
                         {"simultaneous_impulse", "linearly_implicit_euler", ContactPoints::proximity},
                         {"penalty", "linearly_implicit_euler", ContactPoints::proximity},
                         {"soft_constraint", "linearly_implicit_euler", ContactPoints::intersection}};
  for (const Methods& methods : all) {
    CAPTURE(methods.response, methods.integrator, methods.points);
    int interrupted = 0, none = 0;
    World plain, disturbed;
    fill(plain, methods);
    fill(disturbed, methods);
    const std::vector<std::uint64_t> wanted = stepped(plain, false, none),
                                     found = stepped(disturbed, true, interrupted);
    CHECK(wanted == found);
    CHECK(none == 0);
    CHECK(interrupted > 0);
  }
}
