#include "engine/lcp/alart_curnier.hpp"

#include <algorithm>
#include <cmath>

namespace impinge {
namespace {

/// Where both bodies are held ρ is 0, and nothing answers to λ.
bool is_equation(const ConeProblem& problem, std::size_t i, const Vec2& rho) {
  return problem.kind_of(i) != RowKind::contact && (rho.x() > 0.0 || rho.y() > 0.0);
}

}  // namespace

Vec2 alart_curnier_scale(const ConeProblem& problem, std::size_t i) {
  const Mat3& w_ii = problem.w->diagonal(i);
  const auto inverse = [](double w) { return w > 0.0 ? 1.0 / w : 0.0; };
  return {inverse(w_ii(0, 0)), problem.has_one_row(i) ? 0.0 : inverse(0.5 * (w_ii(1, 1) + w_ii(2, 2)))};
}

AlartCurnier alart_curnier(const ConeProblem& problem, std::size_t i, const Vec3& u, const Vec3& lambda,
                           const Vec2& rho) {
  const double mu = problem.mu[i];
  AlartCurnier e{lambda, Mat3::Zero(), Mat3::Identity(), true};
  if (is_equation(problem, i, rho)) {
    e.value = Vec3(rho.x(), rho.y(), rho.y()).cwiseProduct(u);  // ρ_t is 0 where there are no tangential rows
    e.by_u.diagonal() << rho.x(), rho.y(), rho.y();
    e.by_lambda.diagonal() << 0.0, rho.y() > 0.0 ? 0.0 : 1.0, rho.y() > 0.0 ? 0.0 : 1.0;
    e.open = false;
    return e;
  }
  const double z_n = lambda.x() - rho.x() * u.x();
  if (mu == 0.0) e.value.tail<2>().setZero();
  if (!(z_n > 0.0)) return e;
  e.open = false;
  e.value.x() = rho.x() * u.x();
  e.by_u(0, 0) = rho.x();
  e.by_lambda(0, 0) = 0.0;
  if (mu == 0.0) return e;
  const Vec2 z = lambda.tail<2>() - rho.y() * u.tail<2>();
  const double bound = mu * z_n, size = z.norm();
  if (problem.law == FrictionLaw::pyramid) {
    for (int k = 0; k < 2; ++k) {
      const int row = k + 1;
      if (std::abs(z[k]) <= bound) {  // sticks along this tangent
        e.value[row] = rho.y() * u[row];
        e.by_u(row, row) = rho.y();
        e.by_lambda(row, row) = 0.0;
      } else {
        const double side = z[k] > 0.0 ? 1.0 : -1.0;
        e.value[row] = lambda[row] - side * bound;
        e.by_u(row, 0) = side * mu * rho.x();
        e.by_lambda(row, 0) = -side * mu;
      }
    }
  } else if (size <= bound) {
    e.value.tail<2>() = rho.y() * u.tail<2>();
    e.by_u(1, 1) = e.by_u(2, 2) = rho.y();
    e.by_lambda(1, 1) = e.by_lambda(2, 2) = 0.0;
  } else {
    const Vec2 d = z / size;
    const Eigen::Matrix2d across = (bound / size) * (Eigen::Matrix2d::Identity() - d * d.transpose());
    e.value.tail<2>() = lambda.tail<2>() - bound * d;
    e.by_u.block<2, 1>(1, 0) = mu * rho.x() * d;
    e.by_u.block<2, 2>(1, 1) = rho.y() * across;
    e.by_lambda.block<2, 1>(1, 0) = -mu * d;
    e.by_lambda.block<2, 2>(1, 1) -= across;
  }
  return e;
}

Vec3 alart_curnier_value(const ConeProblem& problem, std::size_t i, const Vec3& u, const Vec3& lambda,
                         const Vec2& rho) {
  const double mu = problem.mu[i];
  if (is_equation(problem, i, rho)) return Vec3(rho.x(), rho.y(), rho.y()).cwiseProduct(u);
  const double z_n = std::max(0.0, lambda.x() - rho.x() * u.x());
  if (mu == 0.0) return {lambda.x() - z_n, 0.0, 0.0};
  Vec2 z = lambda.tail<2>() - rho.y() * u.tail<2>();
  const double bound = mu * z_n;
  if (problem.law == FrictionLaw::pyramid)
    z = z.cwiseMax(-bound).cwiseMin(bound);
  else if (const double size = z.norm(); size > bound)
    z *= bound / size;
  return {lambda.x() - z_n, lambda.y() - z.x(), lambda.z() - z.y()};
}

}  // namespace impinge
