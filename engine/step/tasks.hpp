// How loops over things of very different size are shared among threads.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "engine/bodies/bodies.hpp"
#include "engine/core/parallel.hpp"

namespace impinge {

/// work(i) for 0 <= i < count; tasks are runs of neighbours whose sizes sum to `enough` or more. What of several is
/// thrown is what the lowest i throws.
template <class Size, class Work>
void for_each_in_tasks(std::size_t count, std::size_t enough, Size&& size, Work&& work) {
  std::vector<std::size_t> begin = {0};
  std::size_t sum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    sum += size(i);
    if (sum < enough) continue;
    begin.push_back(i + 1);
    sum = 0;
  }
  if (begin.back() < count) begin.push_back(count);
  parallel_for(begin.size() - 1, 1, [&](std::size_t task) {
    for (std::size_t i = begin[task]; i < begin[task + 1]; ++i) work(i);
  });
}

// a task should last longer than it takes to wake a thread: some 20 µs
constexpr std::size_t kEnoughOfBodies = 500;  // rigid bodies, or unknowns of deformable ones

inline std::size_t task_size(const Body& body) {
  const std::size_t surface = body.world_vertices.size() / 16;
  if (body.asleep) return 0;
  return std::max(surface, body.dofs() > 6 ? static_cast<std::size_t>(body.dofs()) : 1);
}

/// work(i, body) for every body.
template <class BodyList, class Work>
void for_each_body(BodyList& bodies, Work&& work) {
  for_each_in_tasks(
      static_cast<std::size_t>(bodies.size().value()), kEnoughOfBodies,
      [&](std::size_t i) { return task_size(bodies[i]); }, [&](std::size_t i) { work(BodyIndex(i), bodies[i]); });
}

/// The same for every active one.
template <class BodyList, class Work>
void for_each_active(BodyList& bodies, Work&& work) {
  const std::span<const BodyIndex> active = bodies.active();
  for_each_in_tasks(
      active.size(), kEnoughOfBodies, [&](std::size_t i) { return task_size(bodies[active[i]]); },
      [&](std::size_t i) { work(active[i], bodies[active[i]]); });
}

}  // namespace impinge
