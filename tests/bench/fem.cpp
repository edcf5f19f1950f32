// Deformable bodies without contact: steps of Vega FEM's clamped cube.
#include <cstdio>
#include <ctime>

#include "engine/core/parallel.hpp"
#include "engine/integrators/deformable_integrator.hpp"
#include "tests/support/program/bench_arguments.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

double now_ms() { return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

DeformableBody lattice(int cells, std::string_view model, double poisson, int clamp_axis, MassKind mass) {
  std::shared_ptr<Material> material = find_entry(materials(), model)->make();
  MaterialSettings settings;
  settings.young = 1e5;
  settings.poisson = poisson;
  material->settings() = settings;
  DeformableBody body(FemAssembly(make_tet_box(Vec3::Ones(), cells, cells, cells), {{material, 1000.0}}, mass));
  std::vector<int> held;
  for (int i = 0; i < body.nodes(); ++i)
    if (body.fem.rest().vertices[i][clamp_axis] == 0.0) held.push_back(i);
  body.hold(held);
  return body;
}

/// Vega's yardstick: E 1e5, ν 0.4, consistent mass, β 0.01 s, h 0.01 s, 100 steps under gravity.
void vega_steps() {
  std::printf("vega cube,material,nodes,tets,tip_y_m,step_ms,assembly_ms,iterations\n");
  for (const int cells : {8, 12})
    for (const auto& entry : materials()) {
      DeformableBody body = lattice(cells, entry.name, 0.4, 0, MassKind::consistent);
      body.damping = {0.0, 0.01};
      const auto scheme = find_entry(integrators(), "linearly_implicit_euler")->make();
      const auto solver = make_linear_solver("conjugate_gradient");
      solver->tolerance = 1e-6;  // Vega's own
      solver->analyze(*body.free_pattern());
      DeformableStep step;
      double assembly = 0.0;
      int iterations = 0;
      const double start = now_ms();
      for (int i = 0; i < 100; ++i) {
        const double before = now_ms();
        scheme->begin(body, Vec3(0, -9.81, 0), 0.01, step);
        scheme->linearize(body, {}, step);
        assembly += now_ms() - before;
        solve_free_velocity(body, step, *solver);
        iterations += step.linear_iterations;
        scheme->advance(body, step, step.v_star);
      }
      const double total = now_ms() - start;
      std::printf("vega cube,%s,%d,%zu,%.6f,%.2f,%.2f,%.1f\n", std::string(entry.name).c_str(), body.nodes(),
                  body.fem.elements().size(), body.position[3 * (body.nodes() - 1) + 1] - 1.0, total / 100.0,
                  assembly / 100.0, iterations / 100.0);
    }
}

}  // namespace

int main(int argc, char** argv) {
  BenchArguments arguments(
      "bench_fem",
      "Deformable bodies without contact: steps of Vega FEM's clamped cube by material, and how much of\n"
      "them is assembly. Prints CSV; processor time of one thread, ms.");
  arguments.read_or_exit(argc, argv);
  set_thread_count(1);
  vega_steps();
}
