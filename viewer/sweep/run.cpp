#include "viewer/sweep/run.hpp"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <deque>
#include <thread>

#include "engine/io/paths.hpp"
#include "viewer/controller/interrupt.hpp"
#include "viewer/sweep/progress.hpp"

namespace impinge {

namespace {

namespace fs = std::filesystem;

struct Task {
  const SweepJob* job;
  int repeat;
};

// of a repeat only the figures count
void drop_pictures(const fs::path& run) {
  std::error_code error;
  for (const char* name : {"frames", "surfaces", "snapshots", "contacts.csv", "contact_sheet.png"})
    fs::remove_all(run / name, error);
}

}  // namespace

void run_sweep_jobs(const fs::path& out, const std::vector<SweepJob>& jobs, int repeats, int at_once,
                    bool shows_progress) {
  explain_interrupt("the jobs in work stop at their last whole frames, within 2 s; the same command goes on");
  limit_interrupt(1.9);              // a little longer than its jobs have
  setenv("LP_NUM_THREADS", "0", 1);  // the renderer paints in the run's own thread: a job has one
  SweepProgress progress(jobs.size() * static_cast<std::size_t>(repeats), shows_progress);
  std::deque<Task> waiting;
  for (int k = 1; k <= repeats; ++k)
    for (const SweepJob& job : jobs) waiting.push_back({&job, k});
  struct Running {
    SweepWorker worker;
    Task task;
  };
  std::vector<Running> running;
  bool told = false;
  while (!running.empty() || (!waiting.empty() && !interrupted())) {
    std::size_t tries = waiting.size();
    while (!interrupted() && tries-- > 0 && running.size() < static_cast<std::size_t>(at_once)) {
      const Task task = waiting.front();
      waiting.pop_front();
      const fs::path folder = repeat_folder(job_folder(out, task.job->hash), task.repeat);
      if (task.repeat > 1) make_folder(folder);
      SweepWorker worker;
      switch (worker.start(folder, *task.job)) {
        case SweepWorker::started:
          running.push_back({std::move(worker), task});
          break;
        case SweepWorker::busy:
          waiting.push_back(task);
          break;
        case SweepWorker::already_done:
          progress.ended(false);
      }
    }
    if (interrupted() && !told)
      for (const Running& run : running) run.worker.interrupt();
    told = interrupted();
    if (running.empty())
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    else
      SweepWorker::wait_for_any(std::chrono::milliseconds(50));
    std::erase_if(running, [&](Running& run) {
      const bool ended = run.worker.poll();
      if (ended) progress.ended(true);
      if (ended && run.task.repeat > 1 && run.worker.outcome().is_final())
        drop_pictures(repeat_folder(job_folder(out, run.task.job->hash), run.task.repeat) / "run");
      return ended;
    });
    progress.show(running.size());
  }
  progress.clear();
}

bool is_sweep_job_over(const fs::path& out, const SweepJob& job, int repeats) {
  for (int k = 1; k <= repeats; ++k) {
    const fs::path folder = repeat_folder(job_folder(out, job.hash), k);
    if (!is_there(folder / "done") || !has_what_was_asked(folder, job)) return false;
  }
  return true;
}

}  // namespace impinge
