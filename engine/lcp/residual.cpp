#include "engine/lcp/residual.hpp"

#include <algorithm>
#include <cmath>

namespace impinge {
namespace {

double ratio(double value, double scale) { return scale > 0.0 ? value / scale : value; }

/// u_i of a contact that has all its rows, or only the normal one.
Vec3 rows_there(const ConeProblem& problem, std::size_t i, const Vec3& u) {
  return problem.has_one_row(i) ? Vec3(u.x(), 0.0, 0.0) : u;
}

void take(Measured& measured, double value, std::size_t i) {
  if (std::isnan(measured.absolute) || value <= measured.absolute) return;
  measured.absolute = value;
  measured.worst = static_cast<int>(i);
}

}  // namespace

double natural_map(const Mat3& w_ii, const Vec3& u, const Vec3& lambda, double mu, FrictionLaw law) {
  if (mu == 0.0) {
    if (!(w_ii(0, 0) > 0.0)) return 0.0;
    const double rho = 1.0 / w_ii(0, 0);
    return std::abs(lambda.x() - std::max(0.0, lambda.x() - rho * u.x())) / rho;
  }
  if (!(w_ii.trace() > 0.0)) return 0.0;
  const double rho = 3.0 / w_ii.trace();
  return (lambda - project(lambda - rho * de_saxce(u, mu, law), mu, law)).norm() / rho;
}

double natural_map(RowKind kind, const Mat3& w_ii, const Vec3& u, const Vec3& lambda, double mu) {
  switch (kind) {
    case RowKind::attachment:
      return u.norm();
    case RowKind::sliding:
      return std::abs(u.x());
    case RowKind::contact:
      break;
  }
  return natural_map(w_ii, u, lambda, mu);
}

double natural_map(const ConeProblem& problem, std::size_t i, const Vec3& u, const Vec3& lambda) {
  const Mat3& w_ii = problem.w->diagonal(i);
  if (problem.kind_of(i) == RowKind::contact) return natural_map(w_ii, u, lambda, problem.mu[i], problem.law);
  return problem.is_held(i) ? 0.0 : natural_map(problem.kind_of(i), w_ii, u, lambda, problem.mu[i]);
}

double velocity_scale(const ConeProblem& problem) {
  double scale = 0.0;
  for (std::size_t i = 0; i < problem.q.size(); ++i)
    scale = std::max(scale, rows_there(problem, i, problem.q[i]).norm());
  return scale;
}

double relative_residual(const ConeProblem& problem, const std::vector<Vec3>& u, const std::vector<Vec3>& lambda,
                         Measure measure) {
  if (measure == Measure::natural_map) {
    double worst = 0.0;
    for (std::size_t i = 0; i < u.size(); ++i) {
      const double r = natural_map(problem, i, u[i], lambda[i]);
      if (!(r <= worst)) worst = r;
      if (std::isnan(worst)) return worst;
    }
    return ratio(worst, velocity_scale(problem));
  }
  double error = 0.0, size_q = 0.0, size_u = 0.0, size_lambda = 0.0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    error += (lambda[i] - problem.nearest(i, lambda[i] - problem.dual(i, u[i]))).squaredNorm();
    size_q += rows_there(problem, i, problem.q[i]).squaredNorm();
    size_u += rows_there(problem, i, u[i]).squaredNorm();
    size_lambda += lambda[i].squaredNorm();
  }
  return ratio(std::sqrt(error), std::sqrt(std::max({size_q, size_u, size_lambda})));
}

Residual judge(const ConeProblem& problem, const std::vector<Vec3>& lambda) {
  Residual result;
  problem.w->begin(lambda);
  std::vector<Vec3> u(problem.q.size());
  double impulse = 0.0;
  for (std::size_t i = 0; i < problem.q.size(); ++i) {
    u[i] = problem.w->row(i, problem.has_one_row(i)) + problem.q[i];
    const double r = natural_map(problem, i, u[i], lambda[i]);
    if (!std::isnan(result.natural_map) && !(r <= result.natural_map)) {
      result.natural_map = r;
      result.worst = static_cast<int>(i);
    }
    if (problem.kind_of(i) == RowKind::contact) take(result.product, std::abs(lambda[i].dot(problem.dual(i, u[i]))), i);
    take(result.cone, problem.violation(i, lambda[i]), i);
    impulse = std::max(impulse, lambda[i].norm());
  }
  result.map = {result.natural_map, ratio(result.natural_map, velocity_scale(problem)), result.worst};
  result.product.relative = ratio(result.product.absolute, velocity_scale(problem) * impulse);
  result.cone.relative = ratio(result.cone.absolute, impulse);
  result.complementarity = result.product.absolute;
  result.cone_violation = result.cone.absolute;
  result.siconos = relative_residual(problem, u, lambda, Measure::siconos);
  return result;
}

}  // namespace impinge
