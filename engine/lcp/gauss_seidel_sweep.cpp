#include "engine/lcp/gauss_seidel_sweep.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "engine/core/interrupt.hpp"

namespace impinge {
namespace {

/// The three rows of a contact with a pyramid, each exact with the others held.
Vec3 relax_rows(const Mat3& w, Vec3 u, const Vec3& lambda, double mu) {
  Vec3 next = lambda;
  for (int k = 0; k < 3; ++k) {
    const double free = next[k] - u[k] / w(k, k), bound = mu * next.x();
    const double value = k == 0 ? std::max(0.0, free) : std::clamp(free, -bound, bound);
    u += w.col(k) * (value - next[k]);
    next[k] = value;
  }
  return next;
}

}  // namespace

double relax_contact(const ConeProblem& problem, std::size_t i, std::vector<Vec3>& lambda) {
  Delassus& w = *problem.w;
  const double mu = problem.mu[i];
  const RowKind kind = problem.kind_of(i);
  const bool normal_only = problem.has_one_row(i);
  const Mat3& w_ii = w.diagonal(i);
  if (problem.is_held(i)) return 0.0;
  const Vec3 u = w.row(i, normal_only) + problem.q[i];
  Vec3 next;
  if (kind == RowKind::attachment) {
    next = lambda[i] - Vec3(w_ii.completeOrthogonalDecomposition().solve(u));
  } else if (kind == RowKind::sliding) {
    next = {lambda[i].x() - u.x() / w_ii(0, 0), 0.0, 0.0};
  } else if (normal_only) {
    next = {std::max(0.0, lambda[i].x() - u.x() / w_ii(0, 0)), 0.0, 0.0};
  } else if (problem.law == FrictionLaw::pyramid) {
    next = relax_rows(w_ii, u, lambda[i], mu);
  } else {
    next = solve_one_contact(w_ii, u - w_ii * lambda[i], mu);
  }
  const Vec3 delta = next - lambda[i];
  if (delta.isZero(0.0)) return 0.0;
  lambda[i] = next;
  w.change(i, delta, normal_only);
  return normal_only ? std::abs(w_ii(0, 0) * delta.x()) : (w_ii * delta).norm();
}

double gauss_seidel_sweep(const ConeProblem& problem, std::vector<Vec3>& lambda) {
  double change = 0.0;
  for (std::size_t i = 0; i < lambda.size(); ++i) {
    check_interrupt();  // a sweep over a dense W of thousands of contacts takes long
    change = std::max(change, relax_contact(problem, i, lambda));
  }
  return change;
}

double diagonal_scale(const ConeProblem& problem, std::size_t i) {
  const Mat3& d = problem.w->diagonal(i);
  return problem.has_one_row(i) ? d(0, 0) : d.trace() / 3.0;
}

void velocities(const ConeProblem& problem, std::vector<Vec3>& u) {
  u.resize(problem.q.size());
  for (std::size_t i = 0; i < u.size(); ++i) u[i] = problem.w->row(i, problem.has_one_row(i)) + problem.q[i];
}

SweepStop::SweepStop(const ConeProblem& problem, const LcpSettings& settings)
    : problem_(problem), settings_(settings), gate_(2.0 * settings.tolerance * velocity_scale(problem)) {
  if (settings.measure != Measure::natural_map) gate_ = velocity_scale(problem);
}

bool SweepStop::solved(const std::vector<Vec3>& lambda) {
  velocities(problem_, u_);
  residual_ = relative_residual(problem_, u_, lambda, settings_.measure);
  if (settings_.history != nullptr) settings_.history->push_back(residual_);
  return residual_ <= settings_.tolerance;
}

bool SweepStop::solved(const std::vector<Vec3>& lambda, double change) {
  // a small step is not a small residual: the residual decides
  if (change > gate_ && settings_.history == nullptr) return false;
  if (solved(lambda)) return true;
  if (settings_.measure == Measure::natural_map || settings_.history != nullptr) return false;
  // in another measure the step says nothing by itself, but it shrinks as the residual does
  gate_ = std::max(change * std::min(1.0, 3.0 * settings_.tolerance / residual_), 1e-3 * gate_);
  return false;
}

}  // namespace impinge
