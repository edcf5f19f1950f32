// Running the jobs of a sweep: here in processes of their own, or as commands for somebody else's scheduler.
#pragma once

#include "viewer/sweep/job.hpp"

namespace impinge {

/// Every job's first run, then every job's second, ..., `at_once` at a time; what is done is skipped, a job that
/// another process works on is come back to. Returns early, everything resumable, when a signal asks.
void run_sweep_jobs(const std::filesystem::path& out, const std::vector<SweepJob>& jobs, int repeats, int at_once,
                    bool shows_progress);

/// Whether all runs of a job have ended for good.
bool is_sweep_job_over(const std::filesystem::path& out, const SweepJob& job, int repeats);

/// The jobs that are not over, a shell command a line, each safe for sh.
std::string sweep_commands(const std::filesystem::path& out, const std::vector<SweepJob>& jobs, int repeats);

/// Writes and submits a job array of the jobs that are not over, `at_once` tasks at most (0: as many as Slurm gives),
/// and waits for its end. An interruption cancels the array. Throws InputError if Slurm refuses it, with Slurm's words.
void run_sweep_on_slurm(const std::filesystem::path& out, const std::vector<SweepJob>& jobs, int repeats, int at_once,
                        bool shows_progress);

}  // namespace impinge
