// The scenes with deformable bodies by stage.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "engine/world/judge.hpp"
#include "tests/support/program/bench_arguments.hpp"
#include "viewer/controller/session.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

const std::filesystem::path kScenes = std::filesystem::path(IMPINGE_SOURCE_DIR) / "scenes";

void by_stage(const char* name, int frames, const std::vector<std::string>& overrides) {
  const std::filesystem::path script = kScenes / (std::string(name) + ".script");
  Session session(kScenes / (std::string(name) + ".toml"), overrides,
                  std::filesystem::exists(script) ? script : std::filesystem::path());
  StageTimes sum;
  std::int64_t contacts = 0, most = 0, unconverged = 0;
  double deepest = 0.0, residual = 0.0;
  int n = 0;
  for (int frame = 0; frame <= frames; ++frame, ++n) {
    session.advance();
    const FrameStats& s = session.record().stats;
    sum.broad_ms += s.times.broad_ms, sum.narrow_ms += s.times.narrow_ms, sum.assemble_ms += s.times.assemble_ms;
    sum.response_ms += s.times.response_ms, sum.integrate_ms += s.times.integrate_ms, sum.step_ms += s.times.step_ms;
    contacts += s.contacts;
    most = std::max(most, s.contacts);
    unconverged += s.unconverged;
    residual = std::max(residual, s.residual);
    deepest = std::max(deepest, judge_overlap(session.world().bodies()).penetration);
  }
  std::printf("%-17s %6d %7.2f %7.2f %9.2f %9.1f %10.1f %8.1f %8.0f (%ld) %10.1e %10.1e %6ld\n", name,
              session.record().stats.dofs, sum.broad_ms / n, sum.narrow_ms / n, sum.assemble_ms / n,
              sum.response_ms / n, sum.integrate_ms / n, sum.step_ms / n, static_cast<double>(contacts) / n,
              static_cast<long>(most), deepest, residual, static_cast<long>(unconverged));
  std::fflush(stdout);
}

struct Sample {
  std::int64_t contacts;
  double ms;
};

struct Course {
  const char* name;
  std::vector<std::string> overrides;
  std::vector<Sample> samples;
  double total = 0.0, residual = 0.0;
  std::int64_t outer = 0;
};

/// Mean response time of frames whose contacts lie in [low, high).
double mean_between(const Course& c, std::int64_t low, std::int64_t high, int& count) {
  double sum = 0.0;
  count = 0;
  for (const Sample& s : c.samples)
    if (s.contacts >= low && s.contacts < high) sum += s.ms, ++count;
  return count ? sum / count : 0.0;
}

}  // namespace

int main(int argc, char** argv) {
  int frames = 120;
  BenchArguments arguments(
      "bench_deformable_scenes",
      "The scenes with deformable bodies by stage: milliseconds a frame, contacts, and the overlap of their\n"
      "surfaces by the judge, which shares nothing with detection. And constraint anticipation against its\n"
      "iterative form over the first frames of dragon_spheres, time against contacts, at equal residual and\n"
      "with the seed's 5 % rule [Haapaoja16 Fig. 6.5].");
  arguments.number("frames", frames, {1}, "of each scene");
  arguments.read_or_exit(argc, argv);
  std::printf(
      "ms a frame           DoF   broad  narrow  assemble  response  integrate     step contacts (most)  overlap[m] "
      "residual[m/s] unconverged\n");
  by_stage("dragon_spheres", frames, {});
  by_stage("face_press", frames, {});
  by_stage("dragon_stiffness", frames, {});
  by_stage("muscle", frames, {});

  Course courses[] = {
      {"CA", {"response.method=constraint_anticipation"}, {}},
      {"ICA accelerated",
       {"response.method=iterative_constraint_anticipation",
        "response.iterative_constraint_anticipation.factorizes=false"},
       {}},
      {"ICA seed, 5 % rule",
       {"response.method=iterative_constraint_anticipation", "response.iterative_constraint_anticipation.form=seed",
        "response.iterative_constraint_anticipation.stop=change"},
       {}}};
  for (Course& c : courses) {
    Session session(kScenes / "dragon_spheres.toml", c.overrides, {});
    try {
      for (int frame = 0; frame <= frames; ++frame) {
        session.advance();
        const FrameStats& s = session.record().stats;
        c.samples.push_back({s.contacts, s.times.response_ms});
        c.total += s.times.response_ms;
        c.residual = std::max(c.residual, s.residual);
        c.outer += s.outer_iterations;
      }
    } catch (const std::exception& e) {
      std::printf("%s: %s\n", c.name, e.what());
    }
  }
  std::printf("\ndragon_spheres, %d frames: response ms a frame by contacts\n%-20s", frames, "contacts");
  const std::int64_t bins[] = {1, 25, 50, 100, 200, 400, 800, 1600};
  for (std::size_t i = 0; i + 1 < std::size(bins); ++i)
    std::printf(" %5ld-%-5ld", static_cast<long>(bins[i]), static_cast<long>(bins[i + 1]));
  std::printf("  total s  largest residual  outer iterations\n");
  for (const Course& c : courses) {
    std::printf("%-20s", c.name);
    for (std::size_t i = 0; i + 1 < std::size(bins); ++i) {
      int count = 0;
      const double mean = mean_between(c, bins[i], bins[i + 1], count);
      if (count)
        std::printf(" %11.1f", mean);
      else
        std::printf(" %11s", "-");
    }
    std::printf(" %8.1f %17.1e %17ld\n", 1e-3 * c.total, c.residual, static_cast<long>(c.outer));
  }
  return 0;
}
