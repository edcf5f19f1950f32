// Fast bodies against thin ones.
#include <cstdio>
#include <cstdlib>

#include "tests/support/mechanics/bullets.hpp"
#include "tests/support/program/bench_arguments.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

const std::vector<std::string> kMovers = {"box", "hull", "cube", "icosphere", "bunny", "rod_box", "rod_mesh"};
const std::vector<std::string> kTargets = {"plate_1m", "plate_50", "plate_20", "moving_plate",
                                           "foil",     "shell",    "post",     "post_mesh"};

}  // namespace

int main(int argc, char** argv) {
  int phases = 3;
  std::string word = "auto", response, only_mover, only_target;
  BenchArguments arguments(
      "bench_bullets",
      "Fast bodies against thin ones: how many pass, how deep the end of any sub-step finds them, and what\n"
      "it costs.");
  arguments.number("phases", phases, {1}, "shots of each kind, each with other places and turns");
  arguments.word("continuous", word, one_of({"auto", "on", "off"}), "whether flights are looked at");
  std::vector<std::string> names = names_of(responses());
  names.emplace_back("");
  arguments.word("response", response, one_of(names), "response.method, the default if it is \"\"");
  arguments.word("mover", only_mover, one_of(kMovers), "what is shot; all unless given");
  arguments.word("target", only_target, one_of(kTargets), "what at; all unless given");
  arguments.read_or_exit(argc, argv);
  const Continuous which = word == "on" ? Continuous::on : word == "off" ? Continuous::off : Continuous::when_needed;
  std::printf("%-10s %-13s %8s %8s  %9s %6s  %10s %6s %7s %8s %9s\n", "mover", "target", "substeps", "speed", "passed",
              "errors", "overlap/thickness", "unsafe", "unconv.", "ms", "worst ms");
  int passed_all = 0, shots = 0;
  for (const std::string& mover : kMovers)
    for (const std::string& target : kTargets) {
      const bool is_rod = mover.starts_with("rod"), is_post = target.starts_with("post");
      if (is_rod != is_post || !can_shoot(mover)) continue;
      if (!only_mover.empty() && only_mover != mover) continue;
      if (!only_target.empty() && only_target != target) continue;
      for (int substeps : {4, 1})
        for (double speed : {1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0}) {
          ShotResult sum;
          int passed = 0, errors = 0;
          std::string error;
          for (int i = 0; i < phases; ++i) {
            const ShotResult r =
                shoot({mover, target, speed, substeps, static_cast<std::uint64_t>(i + 1), response, which});
            passed += r.has_passed ? 1 : 0;
            errors += r.error.empty() ? 0 : 1;
            if (!r.error.empty()) error = r.error;
            if (r.has_passed) std::printf("   passed: seed %d\n", i + 1);
            sum.overlap = std::max(sum.overlap, r.overlap / r.thickness);
            sum.unsafe += r.unsafe, sum.unconverged += r.unconverged;
            sum.ms += r.ms / phases, sum.worst_ms = std::max(sum.worst_ms, r.worst_ms);
            sum.energy = std::max(sum.energy, r.energy);
          }
          passed_all += passed, shots += phases;
          std::printf("%-10s %-13s %8d %8g  %4d of %-3d %3d  %10.1e %6lld %7lld %8.2f %9.1f energy %.3f %s\n",
                      mover.c_str(), target.c_str(), substeps, speed, passed, phases, errors, sum.overlap,
                      static_cast<long long>(sum.unsafe), static_cast<long long>(sum.unconverged), sum.ms, sum.worst_ms,
                      sum.energy, error.c_str());
          std::fflush(stdout);
        }
    }
  std::printf("%d of %d passed\n", passed_all, shots);
}
