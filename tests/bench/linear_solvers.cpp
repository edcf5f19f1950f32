// Linear solves of deformable bodies by route.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "engine/core/parallel.hpp"
#include "engine/integrators/deformable_integrator.hpp"
#include "tests/support/program/bench_arguments.hpp"
#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

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

/// A body's system matrix at rest, and the free nodes of its upper face.
struct System {
  BlockMatrix a;
  std::vector<int> top;
};
System lattice_system(int cells, double young) {
  std::shared_ptr<Material> material = find_entry(materials(), "linear")->make();
  MaterialSettings settings;
  settings.young = young;
  settings.poisson = 0.3;
  material->settings() = settings;
  DeformableBody body(
      FemAssembly(make_tet_box(Vec3::Ones(), cells, cells, cells), {{material, 1000.0}}, MassKind::lumped));
  std::vector<int> held;
  for (int i = 0; i < body.nodes(); ++i)
    if (body.fem.rest().vertices[i].z() == 0.0) held.push_back(i);
  body.hold(held);
  BlockMatrix k(body.fem.pattern());
  VecX f;
  body.fem.stiffness(body.position, Tangent::exact, f, k);
  DeformableStep step;
  fill_system(body, 1.0 / (0.01 * 0.01), 0.0, 1.0, &k, step);
  System system{step.a, {}};
  for (int i = 0; i < body.nodes(); ++i)
    if (body.fem.rest().vertices[i].z() > 1.0 - 1e-9) system.top.push_back(body.free_index()[i]);
  return system;
}

/// Three rows a contact, each on three nodes near one another: contacts side by side, as where two bodies press.
SparseColumns contact_columns(const System& system, int contacts) {
  test::Random random(5);
  std::vector<Eigen::Triplet<double>> entries;
  for (int c = 0; c < contacts; ++c)
    for (int k = 0; k < 3; ++k) {
      const int node = system.top[(c + 3 * k) % system.top.size()];
      for (int d = 0; d < 3; ++d)
        for (int row = 0; row < 3; ++row) entries.emplace_back(3 * node + row, 3 * c + d, random.sym());
    }
  SparseColumns b(system.a.rows(), 3 * contacts);
  b.setFromTriplets(entries.begin(), entries.end());
  return b;
}

void measure(std::string_view route, const System& system, double young) {
  const auto solver = make_linear_solver(route);
  VecX b(system.a.rows()), x;
  test::Random random(99);
  for (Eigen::Index i = 0; i < b.size(); ++i) b[i] = random.sym();
  const double analyze = median_ms(1, [&] { solver->analyze(*system.a.pattern); });
  double factor = 0.0;
  {
    // numbers that change a little each time, or there would be one factorization only
    std::vector<double> times;
    BlockMatrix a = system.a;
    for (int i = 0; i < 3; ++i) {
      a.values[0] *= 1.0 + 1e-9;
      times.push_back(median_ms(1, [&] { solver->factorize(a); }));
    }
    std::sort(times.begin(), times.end());
    factor = times[1];
  }
  solver->factorize(system.a);
  SolveReport report;
  const double solve = median_ms(5, [&] {
    x.setZero(b.size());
    report = solver->solve(b, x);
  });
  std::printf("solve,%s,%g,%d,%.2f,%.2f,%.2f,%d,%.1e\n", std::string(route).c_str(), young, system.a.rows(), analyze,
              factor, solve, report.iterations, (b - system.a * x).norm() / b.norm());
  std::fflush(stdout);
  for (const int contacts : {20, 100, 400}) {
    if (static_cast<int>(system.top.size()) < contacts / 2) continue;
    if (route == "conjugate_gradient" && contacts > 20) continue;  // as many times one solve
    const SparseColumns j = contact_columns(system, contacts);
    MatX w, whole;
    const double gram = median_ms(1, [&] { solver->gram(j, w); });
    const double full = median_ms(1, [&] { solver->LinearSolver::gram(j, whole); });
    std::printf("gram,%s,%g,%d,%d,%.1f,%.1f,%.1e\n", std::string(route).c_str(), young, system.a.rows(), contacts, gram,
                full, (w - whole).norm() / w.norm());
    std::fflush(stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  int largest = 26, smallest = 0;
  BenchArguments arguments(
      "bench_linear_solvers",
      "Linear solves of deformable bodies by route: analysis, factorization, one right-hand side, and W = J\n"
      "A⁻¹ Jᵀ of contacts on the surface, by whole solves and by half ones. Lattice solids clamped at z =\n"
      "0, K + m/Δt² (lumped, ν 0.3, ρ 1000, Δt 0.01 s). Prints CSV; processor time of one thread, ms.");
  arguments.number("largest", largest, {6}, "lattice, cells a side; from 100 on Eigen's takes part in all");
  arguments.number("smallest", smallest, {0}, "lattice, cells a side");
  arguments.read_or_exit(argc, argv);
  set_thread_count(1);
  std::printf("solve,route,young,dofs,analyze_ms,factor_ms,solve_ms,iterations,relative_residual\n");
  std::printf("gram,route,young,dofs,contacts,half_solves_ms,whole_solves_ms,relative_difference\n");
  for (const int cells : {6, 10, 14, 20, 26}) {
    if (cells > largest) break;
    if (cells < smallest) continue;
    for (const double young : {1e5, 1e7}) {
      const System system = lattice_system(cells, young);
      for (const auto& entry : linear_solvers()) {
        if (entry.name == "simplicial_llt" && cells > 14 && largest < 100) continue;  // minutes
        if (entry.name != "conjugate_gradient" && young > 1e5) continue;  // the same work whatever the numbers
        measure(entry.name, system, young);
      }
    }
  }
}
