// Pauses of a computation: taken where it looks for an interrupt, in its own thread only, never within each other.
#include <catch2/catch.hpp>

#include <thread>

#include "engine/core/interrupt.hpp"
#include "engine/core/parallel.hpp"

using namespace impinge;

TEST_CASE("a pause is taken once each time that it is due") {
  Pause pause;
  int taken = 0;
  pause.take = [&] { ++taken; };
  const PauseScope scope(&pause);
  check_interrupt();
  CHECK(taken == 0);
  pause.is_due = true;
  check_interrupt();
  check_interrupt();
  CHECK(taken == 1);
}

TEST_CASE("in a pause nothing pauses and nothing is interrupted") {
  std::atomic<bool> raised = false;
  const InterruptScope may_end(&raised);
  Pause pause;
  int taken = 0;
  pause.take = [&] {
    ++taken;
    pause.is_due = raised = true;
    check_interrupt();
  };
  const PauseScope scope(&pause);
  pause.is_due = true;
  CHECK_THROWS_AS(check_interrupt(), Interrupted);  // behind the pause, which raised the flag
  CHECK(taken == 1);
  {
    const PauseScope none(nullptr);
    const InterruptScope finished(nullptr);
    check_interrupt();
  }
  CHECK(taken == 1);
}

TEST_CASE("the threads of a loop take no pause, and whoever began it does") {
  Pause pause;
  const std::thread::id own = std::this_thread::get_id();
  std::atomic<int> elsewhere = 0, here = 0;
  pause.take = [&] { std::this_thread::get_id() == own ? ++here : ++elsewhere; };
  const PauseScope scope(&pause);
  for (int k = 0; k < 100; ++k) {
    pause.is_due = true;
    parallel_for(64, 1, [](std::size_t) { check_interrupt(); });
  }
  check_interrupt();
  CHECK(elsewhere == 0);
  CHECK(here > 0);
}
