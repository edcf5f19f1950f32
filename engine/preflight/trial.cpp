#include "engine/preflight/trial.hpp"

#include <atomic>
#include <chrono>
#include <thread>

#include "engine/core/error.hpp"
#include "engine/core/interrupt.hpp"
#include "engine/core/memory.hpp"

namespace impinge {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kQuick = 1.0;  // s: a second sub-step is worth its time
constexpr auto kPoll = std::chrono::milliseconds(5);

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// Raises a flag of its own at the deadline, or when the flag of the thread that made it is raised.
class Deadline {
 public:
  explicit Deadline(double seconds)
      : watch_([this, outer = InterruptScope::flag(), seconds, start = Clock::now()] {
          while (!over_ && !flag_) {
            if (seconds_since(start) > seconds || (outer != nullptr && *outer)) flag_ = true;
            std::this_thread::sleep_for(kPoll);
          }
        }) {}
  ~Deadline() {
    over_ = true;
    watch_.join();
  }
  Deadline(const Deadline&) = delete;
  Deadline& operator=(const Deadline&) = delete;
  const std::atomic<bool>& flag() const { return flag_; }

 private:
  std::atomic<bool> flag_{false}, over_{false};
  std::thread watch_;  // last: it uses the others
};

template <class Report>
void take_slowest(const StageTimes& times, Report& report) {
  const std::pair<std::string_view, double> stages[] = {
      {"broad phase", times.broad_ms}, {"narrow phase", times.narrow_ms},   {"assembly", times.assemble_ms},
      {"response", times.response_ms}, {"integration", times.integrate_ms}, {"looks back at motions", times.guard_ms}};
  double most = 0.0;
  for (const auto& [name, ms] : stages)
    if (ms > most) most = ms, report.stage = name;
  report.share = times.step_ms > 0.0 ? most / times.step_ms : 0.0;
}

}  // namespace

Trial try_sub_steps(const std::function<const FrameStats&()>& step, int made, double most_seconds) {
  Trial trial;
  Clock::time_point start;
  const auto go = [&] {
    start = Clock::now();
    const FrameStats& stats = step();
    trial.seconds = seconds_since(start) / made;
    return stats;
  };
  try {
    const Deadline deadline(most_seconds);
    const InterruptScope scope(&deadline.flag());
    trial.stats = go();  // what comes of the first one, however quick this machine is
    take_slowest(trial.seconds < kQuick ? go().times : trial.stats.times, trial);
  } catch (const Interrupted&) {
    trial.ended = false;
    trial.seconds = seconds_since(start) / made;
  } catch (const DivergenceError& error) {
    trial.diverged = error.what();
  }
  check_interrupt();  // the deadline's flag is gone: what is raised now is somebody else's
  trial.bytes = static_cast<double>(memory_in_use());
  return trial;
}

Ahead look_ahead(const std::function<const FrameStats&()>& frame, int most_frames, double most_seconds) {
  Ahead ahead;
  Clock::time_point start;
  try {
    const Deadline deadline(most_seconds);
    const InterruptScope scope(&deadline.flag());
    while (ahead.frames < most_frames) {
      start = Clock::now();
      const FrameStats& stats = frame();
      const double seconds = seconds_since(start);
      ++ahead.frames;
      ahead.seconds += seconds;
      if (seconds <= ahead.dearest_seconds) continue;
      ahead.dearest = ahead.frames;
      ahead.dearest_seconds = seconds;
      take_slowest(stats.times, ahead);
    }
  } catch (const Interrupted&) {
    ahead.given_up = seconds_since(start);
  } catch (const DivergenceError&) {
    ++ahead.frames;
  }
  check_interrupt();
  return ahead;
}

}  // namespace impinge
