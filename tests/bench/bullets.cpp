// Fast bodies against thin ones: how many pass, how deep the end of any sub-step finds them, and what it costs.
// usage: bench_bullets [PHASES = 3] [auto|on|off] [RESPONSE] [MOVER] [TARGET]
#include <cstdio>
#include <cstdlib>

#include "tests/support/mechanics/bullets.hpp"

using namespace impinge;
using namespace impinge::test;

int main(int argc, char** argv) {
  const int phases = argc > 1 ? std::atoi(argv[1]) : 3;
  const std::string word = argc > 2 ? argv[2] : "auto", response = argc > 3 ? argv[3] : "";
  const std::string only_mover = argc > 4 ? argv[4] : "", only_target = argc > 5 ? argv[5] : "";
  const Continuous which = word == "on" ? Continuous::on : word == "off" ? Continuous::off : Continuous::when_needed;
  std::printf("%-10s %-13s %8s %8s  %9s %6s  %10s %6s %7s %8s %9s\n", "mover", "target", "substeps", "speed", "passed",
              "errors", "overlap/thickness", "unsafe", "unconv.", "ms", "worst ms");
  int passed_all = 0, shots = 0;
  for (const char* mover : {"box", "hull", "cube", "icosphere", "bunny", "rod_box", "rod_mesh"})
    for (const char* target :
         {"plate_1m", "plate_50", "plate_20", "moving_plate", "foil", "shell", "post", "post_mesh"}) {
      const bool is_rod = std::string(mover).starts_with("rod"), is_post = std::string(target).starts_with("post");
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
            if (r.has_passed && getenv("SHOW") != nullptr) std::printf("   passed: seed %d\n", i + 1);
            sum.overlap = std::max(sum.overlap, r.overlap / r.thickness);
            sum.unsafe += r.unsafe, sum.unconverged += r.unconverged;
            sum.ms += r.ms / phases, sum.worst_ms = std::max(sum.worst_ms, r.worst_ms);
            sum.energy = std::max(sum.energy, r.energy);
          }
          passed_all += passed, shots += phases;
          std::printf("%-10s %-13s %8d %8g  %4d of %-3d %3d  %10.1e %6lld %7lld %8.2f %9.1f energy %.3f %s\n", mover,
                      target, substeps, speed, passed, phases, errors, sum.overlap, static_cast<long long>(sum.unsafe),
                      static_cast<long long>(sum.unconverged), sum.ms, sum.worst_ms, sum.energy, error.c_str());
          std::fflush(stdout);
        }
    }
  std::printf("%d of %d passed\n", passed_all, shots);
}
