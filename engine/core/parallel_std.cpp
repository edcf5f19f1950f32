// A pool of std::threads that wait for loops. Simple before quick: it is there for the thread sanitizer.
#include <atomic>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "engine/core/parallel_backend.hpp"

namespace impinge::backend {
namespace {

thread_local bool t_inside = false;  // a loop within a loop runs where it is met

/// One loop: whoever has time takes the next `grain` indices.
struct Loop {
  const std::function<void(std::size_t)>& body;
  const std::size_t count, grain;
  std::atomic<std::size_t> next{0};
  std::mutex mutex;  // guards the two below
  std::size_t failed = static_cast<std::size_t>(-1);
  std::exception_ptr error;  // of the lowest index that threw

  void work() {
    for (std::size_t begin; (begin = next.fetch_add(grain)) < count;)
      for (std::size_t i = begin; i < std::min(begin + grain, count); ++i) try {
          body(i);
        } catch (...) {
          const std::lock_guard lock(mutex);
          if (i < failed) failed = i, error = std::current_exception();
          break;
        }
  }
};

class Pool {
 public:
  explicit Pool(int threads) {
    for (int i = 1; i < threads; ++i) threads_.emplace_back([this] { wait_for_loops(); });
  }
  ~Pool() {
    {
      const std::lock_guard lock(mutex_);
      ended_ = true;
    }
    wake_.notify_all();
    for (std::thread& t : threads_) t.join();
  }

  void run(Loop& loop) {
    {
      const std::lock_guard lock(mutex_);
      loop_ = &loop;
      ++round_;
      busy_ = threads_.size();
    }
    wake_.notify_all();
    t_inside = true;
    loop.work();
    t_inside = false;
    std::unique_lock lock(mutex_);
    idle_.wait(lock, [this] { return busy_ == 0; });
    loop_ = nullptr;
  }

 private:
  void wait_for_loops() {
    t_inside = true;
    for (std::size_t seen = 0;;) {
      Loop* loop = nullptr;
      {
        std::unique_lock lock(mutex_);
        wake_.wait(lock, [&] { return ended_ || round_ != seen; });
        if (ended_) return;
        seen = round_;
        loop = loop_;
      }
      loop->work();
      {
        const std::lock_guard lock(mutex_);
        --busy_;
      }
      idle_.notify_one();
    }
  }

  std::mutex mutex_;  // guards what follows
  std::condition_variable wake_, idle_;
  Loop* loop_ = nullptr;
  std::size_t round_ = 0, busy_ = 0;
  bool ended_ = false;
  std::vector<std::thread> threads_;
};

std::mutex g_mutex;  // one loop at a time has the pool
std::unique_ptr<Pool> g_pool;

}  // namespace

void reset() {
  const std::lock_guard lock(g_mutex);
  g_pool.reset();
}

void run(std::size_t count, std::size_t grain, int threads, const std::function<void(std::size_t)>& body) {
  std::unique_lock lock(g_mutex, std::defer_lock);
  if (t_inside || !lock.try_lock()) {
    for (std::size_t i = 0; i < count; ++i) body(i);
    return;
  }
  if (!g_pool) g_pool = std::make_unique<Pool>(threads);
  Loop loop{body, count, grain, {}, {}, static_cast<std::size_t>(-1), {}};
  g_pool->run(loop);
  if (loop.error) std::rethrow_exception(loop.error);
}

}  // namespace impinge::backend
