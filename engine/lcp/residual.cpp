#include "engine/lcp/residual.hpp"

#include <algorithm>
#include <cmath>

#include "engine/contact/friction_cone.hpp"

namespace impinge {

double natural_map(const Mat3& w_ii, const Vec3& u, const Vec3& lambda, double mu) {
  if (mu == 0.0) {
    const double rho = 1.0 / w_ii(0, 0);
    return std::abs(lambda.x() - std::max(0.0, lambda.x() - rho * u.x())) / rho;
  }
  const double rho = 3.0 / w_ii.trace();
  return (lambda - project_to_cone(lambda - rho * de_saxce(u, mu), mu)).norm() / rho;
}

double natural_map(RowKind kind, const Mat3& w_ii, const Vec3& u, const Vec3& lambda, double mu) {
  switch (kind) {
    case RowKind::attachment: return u.norm();
    case RowKind::sliding: return std::abs(u.x());
    case RowKind::contact: break;
  }
  return natural_map(w_ii, u, lambda, mu);
}

Residual judge(const ConeProblem& problem, const std::vector<Vec3>& lambda) {
  Residual result;
  problem.w->begin(lambda);
  for (std::size_t i = 0; i < problem.q.size(); ++i) {
    const double mu = problem.mu[i];
    const RowKind kind = problem.kind_of(i);
    const Vec3 u = problem.w->row(i, problem.has_one_row(i)) + problem.q[i];
    const double r = natural_map(kind, problem.w->diagonal(i), u, lambda[i], mu);
    if (!(r <= result.natural_map)) {
      result.natural_map = r;
      result.worst = static_cast<int>(i);
    }
    if (kind != RowKind::contact) continue;
    const Vec3 u_hat = mu == 0.0 ? Vec3(u.x(), 0.0, 0.0) : de_saxce(u, mu);
    result.complementarity = std::max(result.complementarity, std::abs(lambda[i].dot(u_hat)));
    result.cone_violation = std::max(result.cone_violation, std::hypot(lambda[i].y(), lambda[i].z()) - mu * lambda[i].x());
  }
  return result;
}

}  // namespace impinge
