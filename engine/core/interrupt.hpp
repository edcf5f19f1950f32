// How a long computation is ended from outside. Whoever may want that lends a flag to the thread that computes; the
// model looks at it between stages and inside its long loops, and leaves by an exception. What is computed never
// depends on the flag while it is down.
#pragma once

#include <atomic>

namespace impinge {

/// Thrown where the flag was found raised. Not a std::exception: whoever makes messages of failures must not take it
/// for one. A world that it left in the middle of a step is usable again after World::restore.
struct Interrupted {};

/// While it lives, check_interrupt() in this thread looks at `flag`; null: at nothing, so that what must be finished
/// is. parallel_for hands the flag on to the threads it uses. Of scopes within each other the inner one counts.
class InterruptScope {
 public:
  explicit InterruptScope(const std::atomic<bool>* flag) : outer_(own_flag) { own_flag = flag; }
  ~InterruptScope() { own_flag = outer_; }
  InterruptScope(const InterruptScope&) = delete;
  InterruptScope& operator=(const InterruptScope&) = delete;

  /// The flag that counts in this thread, or null.
  static const std::atomic<bool>* flag() { return own_flag; }

 private:
  static inline constinit thread_local const std::atomic<bool>* own_flag = nullptr;

  const std::atomic<bool>* outer_;
};

/// Throws Interrupted once the flag is raised. Costs a nanosecond.
inline void check_interrupt() {
  const std::atomic<bool>* flag = InterruptScope::flag();
  if (flag != nullptr && flag->load(std::memory_order_relaxed)) throw Interrupted{};
}

/// check_interrupt() at every thousandth call, for loops whose rounds are short.
class InterruptPoll {
 public:
  void operator()() {
    if (++calls_ % 1000 == 0) check_interrupt();
  }

 private:
  unsigned calls_ = 0;
};

}  // namespace impinge
