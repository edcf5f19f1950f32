// Parallel loops: every index once, loops within loops, and what is thrown.
#include "engine/core/parallel.hpp"

#include <catch2/catch.hpp>
#include <numeric>
#include <stdexcept>
#include <vector>

using namespace impinge;

namespace {

struct Threads {
  explicit Threads(int count) { set_thread_count(count); }
  ~Threads() { set_thread_count(0); }
};

}  // namespace

TEST_CASE("a parallel loop visits every index once, for any number of threads and grain") {
  const int threads = GENERATE(1, 2, 3, 8);
  const std::size_t grain = GENERATE(0, 1, 7, 1000), count = GENERATE(0, 1, 2, 999, 10'000);
  const Threads set(threads);
  std::vector<int> visits(count, 0);
  for (int round = 0; round < 3; ++round) parallel_for(count, grain, [&](std::size_t i) { ++visits[i]; });
  CHECK(std::accumulate(visits.begin(), visits.end(), std::size_t{0}) == 3 * count);
  CHECK((count == 0 || *std::min_element(visits.begin(), visits.end()) == 3));
}

TEST_CASE("a loop within a loop ends") {
  const Threads set(4);
  std::vector<std::vector<int>> visits(50, std::vector<int>(50, 0));
  parallel_for(50, 1, [&](std::size_t i) { parallel_for(50, 1, [&](std::size_t j) { ++visits[i][j]; }); });
  for (const auto& row : visits) CHECK(row == std::vector<int>(50, 1));
}

TEST_CASE("what a loop's body throws comes out of the loop, and the next loop works") {
  const Threads set(GENERATE(1, 4));
  CHECK_THROWS_AS(parallel_for(1000, 1,
                               [](std::size_t i) {
                                 if (i == 500) throw std::runtime_error("here");
                               }),
                  std::runtime_error);
  std::vector<int> visits(1000, 0);
  parallel_for(1000, 1, [&](std::size_t i) { visits[i] = 1; });
  CHECK(visits == std::vector<int>(1000, 1));
}
