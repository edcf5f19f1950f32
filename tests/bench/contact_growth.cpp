// Fig. 6.5 beyond the seed: one step of its dragon scene as the contacts grow.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "engine/frozen/frozen_comparison.hpp"
#include "tests/support/mechanics/frozen_reference.hpp"
#include "tests/support/program/bench_arguments.hpp"
#include "viewer/controller/session.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

constexpr double kTolerance = 1e-6;

void print(const char* label, const FrozenRuler& ruler, const FrozenStep& step, const char* response,
           const char* solver, double megabytes) {
  Parameters settings;
  take_settings(step.settings, settings);
  ResponseContext context = response_context(settings);
  context.lcp = {kTolerance, 2000};
  const FrozenOutcome o =
      solve_frozen(step, settings.response.method.at(response), settings.lcp.method.at(solver), context);
  const FrozenVerdict v = ruler.judge(o.answers);
  std::printf("  %-34s %9.1f ms  residual %.1e  distance %.1e  %6d sweeps or Newton steps %5d outer  %7.1f MB  %s\n",
              label, o.ms, v.residual, v.distance, o.iterations, o.outer_iterations, megabytes,
              o.converged ? "" : o.stop.c_str());
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  int frames = 26;
  std::string dense = "no";
  BenchArguments arguments(
      "bench_contact_growth",
      "Fig. 6.5 beyond the seed: one step of the seed's dragon scene as the contacts grow, a soft dragon\n"
      "(1e4 Pa) sinking onto the rest. Constraint anticipation by the seed's dense A⁻¹, by half solves with\n"
      "Gauss-Seidel, and by half solves with the default solver, against iterative anticipation; all at the\n"
      "same tolerance, judged by the same ruler.");
  arguments.number("frames", frames, {1}, "of the scene");
  arguments.word("dense", dense, one_of({"dense", "no"}), "whether A⁻¹ is written out, which takes minutes");
  arguments.read_or_exit(argc, argv);
  const std::filesystem::path scene = std::filesystem::path(IMPINGE_SOURCE_DIR) / "scenes/dragon_spheres";
  Session session(scene.string() + ".toml",
                  {"body.dragon.material.young=1e4", "response.iterative_constraint_anticipation.factorizes=false"},
                  scene.string() + ".script");
  session.advance();
  std::size_t seen = 100;  // each has a quarter more contacts than the last
  FrozenStep largest;
  for (int frame = 1; frame <= frames; ++frame) {
    FrozenStep step;
    session.advance(&step);
    if (step.contacts() < seen + seen / 4) continue;
    seen = step.contacts();
    const FrozenRuler ruler(step);
    double unknowns = 0.0, blocks = 0.0;
    for (const FrozenGroup& g : step.groups)
      for (const BlockMatrix& a : g.matrices) unknowns += a.rows(), blocks += static_cast<double>(a.values.size());
    const double rows = 3.0 * static_cast<double>(seen), w = rows * rows * 8e-6;
    std::printf("frame %d: %zu contacts, %.0f unknowns; A %.1f MB, W %.1f MB\n", frame, seen, unknowns, blocks * 72e-6,
                w);
    print("CA, Gauss-Seidel", ruler, step, "constraint_anticipation", "projected_gauss_seidel", w);
    print("CA, automatic", ruler, step, "constraint_anticipation", "automatic", w);
    print("CA, semismooth Newton", ruler, step, "constraint_anticipation", "semismooth_newton", 2.0 * w);
    print("ICA", ruler, step, "iterative_constraint_anticipation", "automatic", 12.0 * unknowns * 8e-6);
    largest = std::move(step);
  }
  if (dense == "no" || largest.groups.empty()) return 0;
  double megabytes = 0.0;
  for (const FrozenGroup& g : largest.groups)
    for (const BlockMatrix& a : g.matrices) megabytes += 8e-6 * a.rows() * a.rows();
  const auto start = std::chrono::steady_clock::now();
  for (const FrozenGroup& g : largest.groups) w_by_dense_inverse(g);
  const double ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  std::printf("frame %d: W by the seed's dense A⁻¹ %.0f ms, %.0f MB, before any solving\n", largest.frame, ms,
              megabytes);
}
