// The states of a run by their hashes, and runs on a number of threads.
#pragma once

#include <vector>

#include "engine/core/parallel.hpp"
#include "engine/world/world.hpp"

namespace impinge::test {

/// Of the state now and after each of some frames.
inline std::vector<std::uint64_t> hashes(World& world, int frames) {
  std::vector<std::uint64_t> list = {world.record().stats.state_hash};
  for (int i = 0; i < frames; ++i) {
    world.step();
    list.push_back(world.record().stats.state_hash);
  }
  return list;
}

/// While it lives; then as many as the machine has.
struct Threads {
  explicit Threads(int n) { set_thread_count(n); }
  ~Threads() { set_thread_count(0); }
};

}  // namespace impinge::test
