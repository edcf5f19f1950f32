// What doesn't move costs nothing: a plane of boxes that sleep.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "engine/world/world.hpp"
#include "tests/support/mechanics/worlds.hpp"
#include "tests/support/median.hpp"
#include "tests/support/program/bench_arguments.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

void measure(int boxes, int steps, bool is_one_awake) {
  World world;
  world.parameters.simulation.substeps = 1;
  world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
  const int side = static_cast<int>(std::ceil(std::sqrt(boxes)));
  for (int k = 0; k < boxes; ++k) world.add_body(cube("box" + std::to_string(k), 0.5, Vec3(k % side, 0.25, k / side)));
  if (is_one_awake) {
    BodyDescription sliding = cube("slider", 0.5, Vec3(-5.0, 0.25, 0.0));
    sliding.velocity = Vec3(0.0, 0.0, 1e3);  // far too fast to come to rest
    world.add_body(sliding);
  }
  world.start();
  int asleep = 0;
  for (int i = 0; i < 200; ++i) world.step();
  for (const Body& b : world.bodies()) asleep += b.asleep ? 1 : 0;
  std::vector<double> frame, step, broad, narrow, response, integrate;
  for (int i = 0; i < steps; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    world.step();
    frame.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count());
    const StageTimes& t = world.record().stats.times;
    step.push_back(t.step_ms), broad.push_back(t.broad_ms), narrow.push_back(t.narrow_ms);
    response.push_back(t.assemble_ms + t.response_ms), integrate.push_back(t.integrate_ms);
  }
  std::printf(
      "%6d boxes, %6d asleep, %s: frame %8.4f  step %8.4f  broad %7.4f  narrow %7.4f  response %7.4f  integrate "
      "%7.4f\n",
      boxes, asleep, is_one_awake ? "one awake" : "all      ", median(frame), median(step), median(broad),
      median(narrow), median(response), median(integrate));
}

}  // namespace

int main(int argc, char** argv) {
  int boxes = 10000, steps = 200;
  BenchArguments arguments(
      "bench_asleep",
      "What doesn't move: a plane of boxes that sleep, and the same with one that slides beside them for\n"
      "ever. Milliseconds, the middle one of the frames, by stage: \"step\" is all sub-steps, \"frame\" is that\n"
      "and publishing, before anybody asks for the hash.");
  arguments.number("boxes", boxes, {1}, "how many");
  arguments.number("steps", steps, {1}, "frames of each scene");
  arguments.read_or_exit(argc, argv);
  measure(boxes, steps, false);
  measure(boxes, steps, true);
}
