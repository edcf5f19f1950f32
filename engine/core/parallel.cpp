#include "engine/core/parallel.hpp"

#include <algorithm>
#include <thread>

#include "engine/core/interrupt.hpp"
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
  // asked once: the C library reads a file for it
  static const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  return g_threads > 0 ? g_threads : cores;
}

void parallel_for(std::size_t count, std::size_t grain, const std::function<void(std::size_t)>& body) {
  grain = std::max<std::size_t>(grain, 1);
  if (thread_count() == 1 || count <= grain) {
    for (std::size_t i = 0; i < count; ++i) {
      check_interrupt();
      body(i);
    }
    return;
  }
  const std::atomic<bool>* flag = InterruptScope::flag();  // of the thread that asks, lent to those that help
  backend::run(count, grain, thread_count(), [&](std::size_t i) {
    const InterruptScope scope(flag);
    check_interrupt();
    body(i);
  });
}

}  // namespace impinge
