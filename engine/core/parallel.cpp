#include "engine/core/parallel.hpp"

#include <algorithm>
#include <thread>

#include "engine/core/parallel_backend.hpp"

namespace impinge {
namespace {
int g_threads = 0;
}

void set_thread_count(int count) {
  g_threads = std::max(0, count);
  backend::reset();
}

int thread_count() {
  return g_threads > 0 ? g_threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

void parallel_for(std::size_t count, std::size_t grain, const std::function<void(std::size_t)>& body) {
  grain = std::max<std::size_t>(grain, 1);
  if (thread_count() == 1 || count <= grain) {
    for (std::size_t i = 0; i < count; ++i) body(i);
    return;
  }
  backend::run(count, grain, thread_count(), body);
}

}  // namespace impinge
