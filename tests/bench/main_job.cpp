// The main job by stage.
#include <sys/resource.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "engine/world/judge.hpp"
#include "tests/support/program/bench_arguments.hpp"
#include "viewer/controller/session.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

struct Figures {
  StageTimes times;
  double seconds = 0, deepest = 0, mean_overlap = 0, render_ms = 0;
  std::int64_t contacts = 0, most_contacts = 0, crossings = 0, iterations = 0, unconverged = 0;
  // largest kinetic energy over the last half second before frame 85, where the pile should rest
  double late_speed = 0;
  int frames = 0;
};

Figures run_job(const char* points, int frames, bool pictures, bool judged) {
  const std::filesystem::path root = IMPINGE_SOURCE_DIR;
  Session session(root / "scenes/drop.toml", {std::string("contact.points=") + points}, root / "scenes/drop.script");
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "impinge_bench_frames";
  if (pictures) {
    std::filesystem::create_directories(folder);
    session.view().open("drop.toml");
  }
  Figures f;
  const auto start = std::chrono::steady_clock::now();
  double judging = 0;
  for (int frame = 0; frame <= frames; ++frame) {
    const std::vector<Command> commands = session.advance();
    const FrameStats& s = session.record().stats;
    if (pictures) f.render_ms += session.view().draw(session.record(), commands, folder);
    f.times.broad_ms += s.times.broad_ms, f.times.narrow_ms += s.times.narrow_ms,
        f.times.assemble_ms += s.times.assemble_ms;
    f.times.response_ms += s.times.response_ms, f.times.integrate_ms += s.times.integrate_ms,
        f.times.step_ms += s.times.step_ms;
    f.contacts += s.contacts;
    f.most_contacts = std::max(f.most_contacts, s.contacts);
    f.iterations += s.lcp_iterations;
    f.unconverged += s.unconverged;
    if (frame >= 60 && frame <= 84) f.late_speed = std::max(f.late_speed, s.kinetic);
    ++f.frames;
    if (judged && frame % 10 == 0) {
      const auto before = std::chrono::steady_clock::now();
      const OverlapVerdict v = judge_overlap(session.world().bodies());
      judging += std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
      f.deepest = std::max(f.deepest, v.penetration);
      f.mean_overlap += v.penetration / (frames / 10 + 1);
      f.crossings += v.intersections;
    }
  }
  if (pictures) session.view().finish();
  f.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() - judging;
  if (pictures) std::filesystem::remove_all(folder);
  return f;
}

}  // namespace

int main(int argc, char** argv) {
  int frames = 240;
  BenchArguments arguments(
      "bench_main_job",
      "The main job by stage: milliseconds a frame, frames a second with and without pictures, peak memory.\n"
      "And which meaning of contact.points is better at what: overlap (by the judge, which shares nothing\n"
      "with detection), chatter, contacts, time.");
  arguments.number("frames", frames, {1}, "of the scene");
  arguments.read_or_exit(argc, argv);
  std::printf("scenes/drop.toml, %d frames of 4 sub-steps, 12 dynamic meshes (52,000 triangles)\n\n", frames);
  std::printf(
      "ms a frame      broad  narrow  assemble  response  integrate    step   contacts (most)  sweeps  unconverged\n");
  Figures by_points[2];
  const char* names[2] = {"proximity", "intersection"};
  for (int i = 0; i < 2; ++i) {
    const Figures f = by_points[i] = run_job(names[i], frames, false, true);
    const double n = f.frames;
    std::printf("%-13s %7.2f %7.2f %9.2f %9.2f %10.2f %7.2f %10.0f (%ld) %7.0f %8ld\n", names[i], f.times.broad_ms / n,
                f.times.narrow_ms / n, f.times.assemble_ms / n, f.times.response_ms / n, f.times.integrate_ms / n,
                f.times.step_ms / n, f.contacts / n, static_cast<long>(f.most_contacts), f.iterations / n,
                static_cast<long>(f.unconverged));
  }
  std::printf(
      "\njudged overlap  deepest [m]   mean [m]   crossing triangle pairs   kinetic energy of the pile, frames 60-84 "
      "[J]\n");
  for (int i = 0; i < 2; ++i)
    std::printf("%-13s   %10.2e %10.2e %25ld %20.2e\n", names[i], by_points[i].deepest, by_points[i].mean_overlap,
                static_cast<long>(by_points[i].crossings), by_points[i].late_speed);

  const int drawn = std::min(frames, 120);
  const Figures with = run_job("proximity", drawn, true, false), without = run_job("proximity", drawn, false, false);
  std::printf(
      "\nframes a second, first %d frames: %.1f without pictures, %.1f with 1280x720 PNG (drawing %.1f ms a frame, "
      "encoding on another thread)\n",
      drawn, without.frames / without.seconds, with.frames / with.seconds, with.render_ms / with.frames);
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  std::printf("peak memory: %.0f MB\n", usage.ru_maxrss / 1024.0);
}
