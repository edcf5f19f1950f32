// Deformable bodies without contact: steps of Vega FEM's clamped cube, linear solves by route, assembly by material.
// Prints CSV; processor time of one thread unless said. usage: bench_fem [largest lattice, cells a side]
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "engine/core/parallel.hpp"
#include "engine/integrators/deformable_integrator.hpp"
#include "tests/support/random.hpp"

using namespace impinge;

namespace {

double now_ms() { return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

template <class Work>
double median_ms(int repeats, Work&& work) {
  std::vector<double> times;
  for (int i = 0; i < repeats; ++i) {
    const double start = now_ms();
    work();
    times.push_back(now_ms() - start);
  }
  std::nth_element(times.begin(), times.begin() + repeats / 2, times.end());
  return times[repeats / 2];
}

DeformableBody lattice(int cells, std::string_view model, double poisson, int clamp_axis, MassKind mass) {
  std::shared_ptr<Material> material = find_entry(materials(), model)->make();
  MaterialSettings settings;
  settings.young = 1e5;
  settings.poisson = poisson;
  material->configure(settings);
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
      const auto scheme = find_entry(deformable_integrators(), "linearly_implicit_euler")->make();
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

/// Lattice solid clamped at z = 0: K + m/Δt² (lumped, Δt 0.01), right side sym(), seed 99.
void solves(int largest) {
  std::printf("solve,route,dofs,analyze_ms,factor_ms,solve_ms,iterations,relative_residual\n");
  for (const int cells : {6, 10, 14, 20, 26}) {
    if (cells > largest) break;
    DeformableBody body = lattice(cells, "linear", 0.3, 2, MassKind::lumped);
    BlockMatrix k(body.fem.pattern());
    VecX f;
    body.fem.stiffness(body.position, Tangent::exact, f, k);
    DeformableStep step;
    fill_system(body, 1.0 / (0.01 * 0.01), 0.0, 1.0, &k, step);
    test::Random random(99);
    VecX b(body.dofs()), x;
    for (Eigen::Index i = 0; i < b.size(); ++i) b[i] = random.sym();
    for (const auto& entry : linear_solvers()) {
      if (entry.name == "simplicial_llt" && cells > 14 && largest < 100) continue;  // minutes
      const auto solver = entry.make();
      const double analyze = median_ms(1, [&] { solver->analyze(*body.free_pattern()); });
      const double factor = median_ms(3, [&] { solver->factorize(step.a); });
      SolveReport report;
      const double solve = median_ms(5, [&] {
        x.setZero(b.size());
        report = solver->solve(b, x);
      });
      std::printf("solve,%s,%d,%.2f,%.2f,%.2f,%d,%.1e\n", std::string(entry.name).c_str(), body.dofs(), analyze, factor,
                  solve, report.iterations, (b - step.a * x).norm() / b.norm());
      std::fflush(stdout);
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  set_thread_count(1);
  vega_steps();
  solves(argc > 1 ? std::atoi(argv[1]) : 26);
}
