// Constraint anticipation against its iterative form: two lattice cubes on a floor.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "engine/core/parallel.hpp"
#include "engine/response/group_judge.hpp"
#include "engine/response/response.hpp"
#include "tests/support/mechanics/deformable_stack.hpp"
#include "tests/support/mechanics/methods.hpp"
#include "tests/support/program/bench_arguments.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

double now_ms() { return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

struct Way {
  const char *label, *response;
  std::vector<RowText> rows;
};

double relative_error(const GroupSystem& group, const GroupSystem& truth) {
  double error = 0.0, size = 0.0;
  for (std::size_t s = 0; s < group.deformable.size(); ++s) {
    const VecX difference = group.deformable_delta[s] - truth.deformable_delta[s];
    error += difference.dot(*group.deformable[s].a * difference);
    size += truth.deformable_delta[s].dot(*group.deformable[s].a * truth.deformable_delta[s]);
  }
  return std::sqrt(error / size);
}

}  // namespace

int main(int argc, char** argv) {
  int most = 8;
  BenchArguments arguments(
      "bench_responses",
      "Constraint anticipation against its iterative form: two lattice cubes on a floor (0.2 m, 1000 kg/m³,\n"
      "ν 0.4, h 10 ms, friction 0.5), from about 50 contacts to 1000, at three stiffnesses. All ratios are\n"
      "of one run. Prints CSV; processor time of one thread, ms. error: ‖Δv - Δv of CA at 1e-11‖_A,\n"
      "relative. memory: numbers a method holds beside A, MB (W; or nine vectors and two inverses).");
  arguments.number("most", most, {4}, "lattice cells a side");
  arguments.read_or_exit(argc, argv);
  set_thread_count(1);
  const char* iterative = "iterative_constraint_anticipation";
  const Way methods[] = {{"ca", "constraint_anticipation", {}},
                         {"ica", iterative, {{"factorizes", "false"}}},
                         {"ica_5_percent", iterative, {{"stop", "change"}}},
                         {"seed", iterative, {{"form", "seed"}}},
                         {"seed_5_percent", iterative, {{"form", "seed"}, {"stop", "change"}}}};
  const auto lcp = find_entry(lcp_solvers(), "projected_gauss_seidel")->make();
  std::printf("young_Pa,nodes,contacts,method,ms,to_ca,outer,sweeps,converged,residual_m_s,error,memory_MB\n");
  for (int cells = 4; cells <= most; cells += cells < 8 ? 2 : 4)
    for (const double young : {1e4, 1e5, 1e6}) {
      const SoftStack stack = make_soft_stack({.young = young, .friction = 0.5, .cells = {cells, cells - 1}});
      GroupSystem truth = stack.group;
      ResponseContext tight;
      tight.lcp = {1e-11, 100000};
      make_response("constraint_anticipation")->solve(truth, *lcp, tight);
      Eigen::Index unknowns = 0;
      for (const DeformableBlock& block : truth.deformable) unknowns += block.velocity.size();
      double exact_ms = 0.0;
      for (const Way& method : methods) {
        GroupSystem group = stack.group;
        ResponseContext context;
        context.lcp.max_iterations = 20000;
        const auto response = make_response(method.response, method.rows);
        const double start = now_ms();
        const ResponseResult result = response->solve(group, *lcp, context);
        const double ms = now_ms() - start;
        if (exact_ms == 0.0) exact_ms = ms;
        const double numbers = method.label == methods[0].label
                                   ? 9.0 * static_cast<double>(group.contacts.size() * group.contacts.size())
                                   : 15.0 * static_cast<double>(unknowns);
        std::printf("%.0e,%d,%zu,%s,%.2f,%.3f,%d,%d,%d,%.1e,%.1e,%.2f\n", young, static_cast<int>(unknowns / 3),
                    group.contacts.size(), method.label, ms, ms / exact_ms, result.outer_iterations, result.iterations,
                    result.converged(), judge_group(group).residual(), relative_error(group, truth), 8e-6 * numbers);
        std::fflush(stdout);
      }
    }
}
