// Every method on the hardest frame of the seed's dragon scene.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "tests/support/mechanics/frozen_dragon.hpp"
#include "tests/support/mechanics/frozen_reference.hpp"
#include "tests/support/program/bench_arguments.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

double difference(const FrozenStep& step, const std::vector<GroupAnswer>& x, const std::vector<GroupAnswer>& y) {
  double error = 0.0, size = 0.0;
  for (std::size_t g = 0; g < step.groups.size(); ++g) {
    error += std::pow(energy_distance(step.groups[g], x[g], y[g]), 2);
    size += energy_product(step.groups[g], y[g], y[g]);
  }
  return std::sqrt(error / size);
}

void print(const char* label, const FrozenRuler& ruler, const FrozenOutcome& o) {
  const FrozenVerdict v = ruler.judge(o.answers);
  std::printf("  %-44s %7d sweeps %6d outer %9.1f ms  residual %.1e  natural map %.1e  distance %.1e  %s\n", label,
              o.iterations, o.outer_iterations, o.ms, v.residual, v.natural_map_relative, v.distance, o.stop.c_str());
  std::fflush(stdout);
}

void iterative(const FrozenStep& step, const FrozenRuler& ruler) {
  for (const int digits : {8, 9, 10, 11}) {
    const std::string label = "ICA 1e-" + std::to_string(digits);
    print(label.c_str(), ruler,
          solved(step, "iterative_constraint_anticipation", "projected_gauss_seidel", std::pow(10.0, -digits)));
  }
}

void routes(const FrozenStep& step) {
  double symmetric = 0.0, eigen = 0.0, whole = 0.0, dense = 0.0;
  for (const FrozenGroup& group : step.groups) {
    const MatX w = w_assembled(group, LinearSolverChoice("automatic"));
    const double size = w.norm();
    const MatX solves = w_by_whole_solves(group, LinearSolverChoice("automatic"));
    symmetric = std::max(symmetric, (solves - solves.transpose()).norm() / size);
    whole = std::max(whole, (solves - w).norm() / size);
    eigen = std::max(eigen, (w_assembled(group, LinearSolverChoice("simplicial_llt")) - w).norm() / size);
    dense = std::max(dense, (w_by_dense_inverse(group) - w).norm() / size);
  }
  std::printf(
      "  W: whole solves symmetric to %.1e (half solves are by construction); away from half solves: those of Eigen's "
      "factorization %.1e, ",
      symmetric, eigen);
  std::printf("whole solves %.1e, dense inverse %.1e\n", whole, dense);
}

}  // namespace

int main(int argc, char** argv) {
  int frames = 30;
  std::vector<std::string> stiffnesses = {"as_is", "1e4", "1e5", "1e6"};
  BenchArguments arguments(
      "bench_frozen_methods",
      "The hardest frame (most contacts) of the seed's dragon scene, as it is and with a dragon of 1e4,\n"
      "1e5, 1e6 Pa: constraint anticipation (CA), its iterative form (ICA) and a monolithic KKT system\n"
      "without friction; natural maps with friction; W by several routes. Distances are of Δv in A's norm,\n"
      "relative to CA's.");
  arguments.number("frames", frames, {1}, "of which the hardest is taken");
  const auto stiffness_fault = [](const std::string& word) {
    return word == "as_is" ? "" : number_fault(word).empty() ? "" : std::string("as_is or a number");
  };
  arguments.words("E", stiffnesses, stiffness_fault, "Young's moduli of the dragon, Pa");
  arguments.read_or_exit(argc, argv);
  for (const std::string& young : stiffnesses) {
    std::vector<std::string> overrides;
    if (young != "as_is") overrides.push_back("body.dragon.material.young=" + young);
    const FrozenStep step = hardest_frame(overrides, frames);
    std::printf("dragon E %s: frame %d, %zu contacts, %zu groups\n", young.c_str(), step.frame, step.contacts(),
                step.groups.size());
    routes(step);
    const FrozenStep smooth = without_friction(step);
    const FrozenRuler smooth_ruler(smooth), ruler(step);
    std::vector<GroupAnswer> kkt;
    for (const FrozenGroup& group : smooth.groups) kkt.push_back(kkt_answer(group));
    std::printf("  without friction: KKT against CA (%s) %.1e\n", smooth_ruler.exact_solver().c_str(),
                difference(smooth, kkt, smooth_ruler.exact()));
    iterative(smooth, smooth_ruler);
    std::printf("  friction 0.3\n");
    for (const char* solver : {"nonsmooth_nonlinear_conjugate_gradient", "semismooth_newton"})
      print((std::string("CA 1e-9 ") + solver).c_str(), ruler, solved(step, "constraint_anticipation", solver, 1e-9));
    iterative(step, ruler);
  }
}
