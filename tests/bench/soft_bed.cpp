// A heap of rigid boxes on a soft mat on the ground: one group, contacts more than nodes.
#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "tests/support/mechanics/deformable_bodies.hpp"
#include "tests/support/median.hpp"
#include "tests/support/program/bench_arguments.hpp"
#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

int main(int argc, char** argv) {
  int side = 6, layers = 3, frames = 40;
  std::string solver = "automatic";
  BenchArguments arguments(
      "bench_soft_bed",
      "A heap of rigid boxes on a soft mat of 9 x 3 x 9 nodes on the ground: one group, contacts more than\n"
      "nodes. Friction 0.5, 1/60 s, one sub-step, nothing sleeps. The frames with the most contacts, ms of\n"
      "response, iterations, residual; then the middle ones of all frames.");
  arguments.number("side", side, {1}, "boxes a side");
  arguments.number("layers", layers, {1}, "of boxes");
  arguments.number("frames", frames, {1}, "of 1/60 s");
  arguments.word("solver", solver, one_of(names_of(lcp_solvers())), "lcp.method");
  arguments.read_or_exit(argc, argv);
  World world;
  world.parameters.simulation.substeps = 1;
  world.parameters.simulation.sleeping = false;
  world.parameters.contact.friction = 0.5;
  world.parameters.lcp.method = solver;
  world.add_body(fixed_plane("ground", Vec3::UnitY(), 0.0));
  const double width = 0.2 * side;
  world.add_body(soft_box("mat", Vec3(width, 0.2, width), Eigen::Vector3i(8, 2, 8), Vec3(0.0, 0.0005, 0.0),
                          {.young = 1e5, .poisson = 0.3, .density = 300.0}));
  Random random(3);
  for (int y = 0; y < layers; ++y)
    for (int x = 0; x < side; ++x)
      for (int z = 0; z < side; ++z) {
        const Vec3 at = Vec3(0.5 * width + 0.16 * (x - 0.5 * (side - 1)), 0.29 + 0.16 * y,
                             0.5 * width + 0.16 * (z - 0.5 * (side - 1))) +
                        0.02 * random.vector();
        BodyDescription box = cube("box" + std::to_string((y * side + x) * side + z), 0.1, at);
        box.mass = 0.5;
        box.rotation = 30.0 * random.vector();
        world.add_body(box);
      }
  world.start();
  std::vector<double> response, iterations;
  double residual = 0.0, overlap = 0.0;
  std::int64_t unconverged = 0, most = 0;
  for (int frame = 1; frame <= frames; ++frame) {
    world.step();
    const FrameStats& s = world.record().stats;
    response.push_back(s.times.response_ms), iterations.push_back(static_cast<double>(s.lcp_iterations));
    residual = std::max(residual, s.residual_coulomb), overlap = std::max(overlap, s.max_penetration);
    unconverged += s.unconverged;
    if (s.contacts <= most) continue;
    most = s.contacts;
    std::printf("frame %3d  contacts %5lld  response %9.1f ms  iterations %5lld  residual %.1e\n", frame,
                static_cast<long long>(s.contacts), s.times.response_ms, static_cast<long long>(s.lcp_iterations),
                s.residual_coulomb);
    std::fflush(stdout);
  }
  std::printf(
      "%d boxes, %d frames: response %.1f ms a frame (the middle one), iterations %.0f, most contacts %lld, "
      "residual %.1e at most, unconverged %lld, overlap %.1e m\n",
      side * side * layers, frames, median(response), median(iterations), static_cast<long long>(most), residual,
      static_cast<long long>(unconverged), overlap);
}
