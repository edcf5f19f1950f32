// A computation that is ended from outside: where it may be, and that nothing is lost by it.
#include <catch2/catch.hpp>

#include <atomic>
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

/// Looks at a step's every check_interrupt() of this thread, and raises the flag in the one that it is told.
class Disturbance {
 public:
  explicit Disturbance(int raised_in) : raised_in_(raised_in) {
    pause_.is_due = true;
    pause_.take = [this] {
      pause_.is_due = true;
      if (++checks_ == raised_in_) flag_ = true;
    };
  }

  /// Whether the step came through.
  bool step(World& world) {
    const InterruptScope interrupt(&flag_);
    const PauseScope pause(&pause_);
    try {
      world.step();
    } catch (const Interrupted&) {
      return false;
    }
    return true;
  }

  int checks() const { return checks_; }

 private:
  Pause pause_;
  std::atomic<bool> flag_{false};
  int raised_in_, checks_ = 0;
};

/// Whether the flag stopped a step of the world, which is then taken back, stopped or not.
bool is_stopped(World& world, int check, int threads) {
  set_thread_count(threads);
  const std::string before = state_of(world);
  const bool came_through = Disturbance(check).step(world);
  ByteReader in(before);
  world.restore(in);
  return !came_through;
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
    World plain, disturbed;
    fill(plain, methods);
    fill(disturbed, methods);
    Random random(7);
    for (int frame = 1; frame <= 5; ++frame) {
      set_thread_count(1);
      Disturbance none(0);
      REQUIRE(none.step(plain));
      for (const int threads : {1, 3, 1, 3, 1, 3}) {
        const int check = 1 + static_cast<int>(random.in(0.0, 1.0) * (none.checks() - 1));
        CAPTURE(frame, check, none.checks(), threads);
        const bool stopped = is_stopped(disturbed, check, threads);
        if (threads == 1) CHECK(stopped);  // of several, another may make checks that this one made before
      }
      disturbed.step();
      CHECK(plain.record().stats.state_hash == disturbed.record().stats.state_hash);
    }
  }
  set_thread_count(0);
}
