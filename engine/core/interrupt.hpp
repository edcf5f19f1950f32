// How a long computation is ended from outside, or paused. Whoever may want that lends a flag to the thread that computes;
// the model looks at it between stages and inside its long loops, and leaves by an exception. What is computed never
// depends on the flag while it is down. In the same places a computation lets others have their turn.
#pragma once

#include <atomic>
#include <functional>

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

/// Who has something to do while another computes: shows a window, say.
struct Pause {
  std::atomic<bool> is_due = false;  ///< raised by whoever keeps the time
  std::function<void()> take;        ///< must leave what is being computed alone, and not throw
};

/// While it lives, check_interrupt() in this thread (not in those that parallel_for uses) takes the pause when it is due.
class PauseScope {
 public:
  explicit PauseScope(Pause* pause) : outer_(own_pause) { own_pause = pause; }
  ~PauseScope() { own_pause = outer_; }
  PauseScope(const PauseScope&) = delete;
  PauseScope& operator=(const PauseScope&) = delete;

  static Pause* pause() { return own_pause; }

 private:
  static inline constinit thread_local Pause* own_pause = nullptr;

  Pause* outer_;
};

/// Takes the pause if it is due, and throws Interrupted once the flag is raised. Costs a nanosecond.
inline void check_interrupt() {
  if (Pause* pause = PauseScope::pause(); pause != nullptr && pause->is_due.load(std::memory_order_relaxed)) {
    pause->is_due = false;
    const PauseScope none(nullptr);  // in which nothing pauses
    const InterruptScope finished(nullptr);
    pause->take();
  }
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
