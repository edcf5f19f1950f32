// Work that can't pause, beside a thread that does.
#include "engine/core/apart.hpp"

#include <catch2/catch.hpp>
#include <stdexcept>
#include <thread>

using namespace impinge;

TEST_CASE("what runs apart lets its thread pause again and again, and hands on what it throws") {
  const std::thread::id own = std::this_thread::get_id();
  Pause pause;
  std::atomic<int> taken = 0;
  std::thread::id where;
  pause.take = [&] { ++taken, where = std::this_thread::get_id(); };
  {
    const PauseScope scope(&pause);
    std::thread::id worker;
    run_apart([&] {
      worker = std::this_thread::get_id();
      while (taken < 3) pause.is_due = true;  // ends only if the other thread pauses meanwhile
    });
    CHECK(worker != own);
    CHECK(where == own);
    CHECK_THROWS_AS(run_apart([] { throw std::runtime_error("no"); }), std::runtime_error);

    // the flag goes with it, and the work is not left behind before it has seen it
    std::atomic<bool> flag = true;
    const InterruptScope may_stop(&flag);
    bool has_begun = false;
    CHECK_THROWS_AS(run_apart([&] {
                      has_begun = true;
                      check_interrupt();
                    }),
                    Interrupted);
    CHECK(has_begun);
  }
  run_apart([&] { CHECK(std::this_thread::get_id() == own); });  // nobody asks
}
