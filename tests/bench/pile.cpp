// A pile of boxes falling and coming to rest, by response and cone solver.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <string>

#include "engine/response/response.hpp"
#include "tests/support/mechanics/methods.hpp"
#include "tests/support/mechanics/pile.hpp"
#include "tests/support/program/bench_arguments.hpp"

using namespace impinge;
using namespace impinge::test;

int main(int argc, char** argv) {
  int boxes = 1000, frames = 60;
  std::vector<std::string> methods = names_of(responses());
  methods.emplace_back("constraint_anticipation:projected_gauss_seidel");
  methods.emplace_back("constraint_anticipation:accelerated_projected_gradient");
  BenchArguments arguments(
      "bench_pile",
      "A pile of boxes falling and coming to rest, by response and cone solver: ms of response a frame, the\n"
      "relative residual (the largest and the middle one of all frames), solves without an answer, overlap,\n"
      "and the frame from which on every speed is below 1 mm/s (sleeping off, one sub-step of 1/60 s); each\n"
      "frame on stderr as it is done.");
  arguments.number("boxes", boxes, {1}, "how many");
  arguments.number("frames", frames, {1}, "of 1/60 s");
  arguments.words(
      "method", methods, [](const std::string& word) { return method_fault(word, "frames"); },
      "response[:solver[:tolerance[:so many frames, then the default tolerance]]]");
  arguments.read_or_exit(argc, argv);
  std::printf("%d boxes, %d frames\n%-58s %12s %12s %10s %10s %12s %12s %12s %8s\n", boxes, frames, "", "response ms",
              "of the last", "residual", "median", "unconverged", "overlap m", "speed m/s", "still");
  for (const std::string& method : methods) {
    World world;
    world.parameters.simulation.sleeping = false;
    world.parameters.simulation.substeps = 1;
    const double tolerance = world.parameters.lcp.tolerance;
    std::istringstream more = choose(world.parameters, method);
    std::string word;
    const int loose = std::getline(more, word, ':') ? std::stoi(word) : frames;
    world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
    Random random(4242);
    add_pile(world, random, boxes);
    world.start();
    double ms = 0.0, last = 0.0, overlap = 0.0, speed = 0.0;
    int still = -1;
    std::int64_t unconverged = 0;
    std::vector<double> residuals;
    for (int i = 0; i < frames; ++i) {
      if (i == loose) world.parameters.lcp.tolerance = tolerance;
      world.step();
      ms += last = world.record().stats.times.response_ms;
      residuals.push_back(world.record().stats.residual_coulomb);
      unconverged += world.record().stats.unconverged;
      speed = overlap = 0.0;
      for (const Body& b : world.bodies())
        if (b.kind() == BodyKind::dynamic) speed = std::max(speed, b.fastest_point());
      for (const ContactRecord& c : world.record().contacts) overlap = std::max(overlap, -c.gap);
      still = speed >= 1e-3 ? -1 : still < 0 ? i : still;
      std::fprintf(stderr, "frame %d of %d: %zu contacts, %.0f ms, residual %.1e, speed %.1e m/s, overlap %.1e m\n",
                   i + 1, frames, world.record().contacts.size(), last, residuals.back(), speed, overlap);
    }
    std::sort(residuals.begin(), residuals.end());
    std::printf("%-58s %12.1f %12.1f %10.1e %10.1e %12lld %12.1e %12.1e %8d\n", method.c_str(), ms / frames, last,
                residuals.back(), residuals[residuals.size() / 2], static_cast<long long>(unconverged), overlap, speed,
                still);
    std::fflush(stdout);
  }
}
