#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <memory>

#include "engine/core/parallel_backend.hpp"

namespace impinge::backend {
namespace {
std::unique_ptr<tbb::global_control> g_limit;  // TBB warns on the terminal where more than the cores are asked for
std::unique_ptr<tbb::task_arena> g_arena;
}  // namespace

void reset() {
  g_arena.reset();
  g_limit.reset();
}

void run(std::size_t count, std::size_t grain, int threads, const std::function<void(std::size_t)>& body) {
  if (!g_arena) {
    g_limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, threads);
    g_arena = std::make_unique<tbb::task_arena>(threads);
  }
  g_arena->execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        for (std::size_t i = range.begin(); i != range.end(); ++i) body(i);
                      });
  });
}

}  // namespace impinge::backend
