// What the elements of deformable bodies cost and what they are worth.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "engine/core/parallel.hpp"
#include "tests/support/mechanics/fem.hpp"
#include "tests/support/program/bench_arguments.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

double now_ms() { return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

struct Beam {
  const char* name;
  ElementKind element;
  int cells;
};
constexpr Beam kBeams[] = {{"linear", ElementKind::linear, 10},       {"linear", ElementKind::linear, 20},
                           {"linear", ElementKind::linear, 40},       {"quadratic", ElementKind::quadratic, 10},
                           {"quadratic", ElementKind::quadratic, 20}, {"quadratic", ElementKind::quadratic, 40}};

DeformableBody beam_of(const Beam& beam, double poisson, std::string_view material) {
  DeformableBody body =
      test::make_body(make_alternating_box(Vec3(1.0, 0.2, 0.1), beam.cells, beam.cells / 5, beam.cells / 10),
                      {.material = material,
                       .young = 5e7,
                       .poisson = poisson,
                       .density = 800.0,
                       .mass = MassKind::lumped,
                       .element = beam.element});
  body.hold(test::nodes_where(body, [](const Vec3& p) { return p.x() < 1e-9; }));
  return body;
}

void tips() {
  std::printf("tip,element,cells,nodes,poisson,tip_mm,first_Hz,residual_N\n");
  for (const double poisson : {0.3, 0.45, 0.49, 0.499, 0.4999, 0.49999})
    for (const Beam& beam : kBeams) {
      if (beam.cells > 20 && (poisson > 0.499 || beam.element == ElementKind::quadratic)) continue;
      DeformableBody body = beam_of(beam, poisson, "linear");
      const double frequency = test::lowest_mode(body).omega / (2.0 * M_PI);
      const double residual =
          test::solve_static(body, applied_force(body, Vec3(0, -9.81, 0)), "simplicial_llt", 20, 1e-9);
      double sum = 0.0;
      const std::vector<int> tip = test::nodes_where(body, [](const Vec3& p) { return p.x() > 1.0 - 1e-9; });
      for (const int i : tip) sum += body.fem.rest().vertices[i].y() - body.position[3 * i + 1];
      std::printf("tip,%s,%d,%d,%g,%.4f,%.4f,%.1e\n", beam.name, beam.cells, body.nodes(), poisson,
                  1e3 * sum / static_cast<double>(tip.size()), frequency, residual);
      std::fflush(stdout);
    }
}

/// Of one step at 1/120 s: assembly, v* by conjugate gradients and by a factorization, 300 columns of A⁻¹ (contact).
struct Times {
  double assembly = 1e300, gradients = 1e300, factorization = 1e300, columns = 1e300;
  int iterations = 0;
};

void time_step(DeformableBody& body, Times& least) {
  const auto scheme = find_entry(integrators(), "linearly_implicit_euler")->make();
  const auto iterative = make_linear_solver("conjugate_gradient"), direct = make_linear_solver("simplicial_llt");
  iterative->analyze(*body.free_pattern());
  direct->analyze(*body.free_pattern());
  DeformableStep step;
  const auto timed = [](double& least_ms, auto&& work) {
    const double start = now_ms();
    work();
    least_ms = std::min(least_ms, now_ms() - start);
  };
  timed(least.assembly, [&] {
    scheme->begin(body, Vec3(0, -9.81, 0), 1.0 / 120.0, step);
    scheme->linearize(body, {}, step);
  });
  timed(least.gradients, [&] { solve_free_velocity(body, step, *iterative); });
  least.iterations = step.linear_iterations;
  timed(least.factorization, [&] { direct->factorize(step.a); });
  SparseColumns columns(body.dofs(), std::min(300, body.dofs()));
  for (int c = 0; c < columns.cols(); ++c) columns.insert(c, c) = 1.0;
  MatX w;
  timed(least.columns, [&] { direct->gram(columns, w); });
}

void costs(int rounds) {
  std::printf("cost,element,cells,nodes,material,assembly_ms,cg_ms,cg_iterations,factorization_ms,columns_ms\n");
  for (const char* material : {"corotational", "neo_hookean"}) {
    std::vector<DeformableBody> bodies;
    for (const Beam& beam : kBeams)
      if (beam.cells < 40) bodies.push_back(beam_of(beam, 0.4, material));
    std::vector<Times> least(bodies.size());
    for (int round = 0; round < rounds; ++round)
      for (std::size_t i = 0; i < bodies.size(); ++i) time_step(bodies[i], least[i]);
    std::size_t i = 0;
    for (const Beam& beam : kBeams) {
      if (beam.cells >= 40) continue;
      const Times& t = least[i];
      std::printf("cost,%s,%d,%d,%s,%.3f,%.3f,%d,%.3f,%.3f\n", beam.name, beam.cells, bodies[i].nodes(), material,
                  t.assembly, t.gradients, t.iterations, t.factorization, t.columns);
      ++i;
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  int rounds = 5;
  BenchArguments arguments(
      "bench_elements",
      "What the elements of deformable bodies cost and what they are worth: a cantilever under its weight\n"
      "by element, mesh and Poisson's ratio, static tip against the converged one; milliseconds of a step's\n"
      "parts, linear and quadratic in turns, the least of several rounds. Prints CSV; one thread.");
  arguments.number("rounds", rounds, {1}, "of each measurement");
  arguments.read_or_exit(argc, argv);
  set_thread_count(1);
  costs(rounds);
  tips();
}
