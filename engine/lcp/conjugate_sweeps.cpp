#include "engine/lcp/conjugate_sweeps.hpp"

#include <algorithm>

#include "engine/lcp/gauss_seidel_sweep.hpp"

namespace impinge {

ConjugateSweeps::ConjugateSweeps(const ConeProblem& problem)
    : problem_(problem), step_(problem.q.size(), Vec3::Zero()), direction_(problem.q.size(), Vec3::Zero()) {}

double ConjugateSweeps::sweep(std::vector<Vec3>& lambda) {
  double size = 0.0;  // of the last step, an energy: units of contacts with unlike masses agree
  for (std::size_t i = 0; i < step_.size(); ++i) size += step_[i].dot(problem_.w->diagonal(i) * step_[i]);
  const double beta = size / size_before_;
  if (size > 0.0) size_before_ = size;
  if (beta > 1.0) {  // steps that grow: the direction is dropped, and what is left is Gauss-Seidel
    std::fill(direction_.begin(), direction_.end(), Vec3::Zero());
  } else {
    for (std::size_t i = 0; i < step_.size(); ++i) {
      const Vec3 momentum = beta * direction_[i];
      direction_[i] = momentum + step_[i];
      if (momentum.isZero(0.0)) continue;
      lambda[i] += momentum;
      problem_.w->change(i, momentum, problem_.has_one_row(i));
    }
  }
  step_ = lambda;
  const double change = gauss_seidel_sweep(problem_, lambda);
  for (std::size_t i = 0; i < step_.size(); ++i) step_[i] = lambda[i] - step_[i];
  return change;
}

}  // namespace impinge
