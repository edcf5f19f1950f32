// What can't be asked to pause, as a library's factorization, beside a thread that can.
#pragma once

#include <chrono>
#include <future>

#include "engine/core/interrupt.hpp"

namespace impinge {

/// Runs `work` to its end. Where somebody wants this thread to pause now and then, in a thread of its own, while this one
/// waits and takes the pauses; what `work` throws is thrown here. The flag of InterruptScope goes with it.
template <typename Work>
void run_apart(Work&& work) {
  if (PauseScope::pause() == nullptr) return work();
  constexpr std::chrono::milliseconds kPoll(2);
  const std::atomic<bool>* flag = InterruptScope::flag();
  std::future<void> done = std::async(std::launch::async, [&] {
    const InterruptScope scope(flag);
    work();
  });
  {
    const InterruptScope finished(nullptr);  // what runs can't be left behind
    while (done.wait_for(kPoll) != std::future_status::ready) check_interrupt();
  }
  done.get();
}

}  // namespace impinge
