#include "engine/core/parallel.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <memory>
#include <thread>

namespace impinge {
namespace {
int g_threads = 0;
std::unique_ptr<tbb::task_arena> g_arena;
}  // namespace

void set_thread_count(int count) {
  g_threads = std::max(0, count);
  g_arena.reset();
}

int thread_count() {
  return g_threads > 0 ? g_threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

void parallel_for(std::size_t count, std::size_t grain, const std::function<void(std::size_t)>& body) {
  if (thread_count() == 1 || count <= std::max<std::size_t>(grain, 1)) {
    for (std::size_t i = 0; i < count; ++i) body(i);
    return;
  }
  if (!g_arena) g_arena = std::make_unique<tbb::task_arena>(thread_count());
  g_arena->execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, std::max<std::size_t>(grain, 1)),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        for (std::size_t i = range.begin(); i != range.end(); ++i) body(i);
                      });
  });
}

}  // namespace impinge
