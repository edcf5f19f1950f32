#include "engine/lcp/smoothed_alart_curnier.hpp"

#include <algorithm>
#include <cmath>

namespace impinge {
namespace {

// Friction is rounded off wider: where a contact that slides turns about, its λ_t goes round a disc that is large beside
// the width, and steps along tangents must be short. On frozen heaps of 1,000 boxes 3 … 30 were alike, 0.3 and 1 worse.
constexpr double kFriction = 10.0;

/// A maximum of a and b with its derivatives.
struct Rounded {
  double value, by_a, by_b;
  Rounded(double a, double b, double width) {
    const double apart = std::abs(a - b), root = std::sqrt(apart * apart + 4.0 * width * width);
    const double above = 2.0 * width * width / (root + apart);  // the larger one
    value = std::max(a, b) + above;
    by_a = by_b = above / root;
    (a > b ? by_a : by_b) = 1.0 - above / root;
  }
};

/// No kink to round off: an equation, or both bodies are held.
bool is_smooth(const ConeProblem& problem, std::size_t i, const Vec2& rho) {
  return problem.kind_of(i) != RowKind::contact || !(rho.x() > 0.0);
}

}  // namespace

AlartCurnier smoothed_alart_curnier(const ConeProblem& problem, std::size_t i, const Vec3& u, const Vec3& lambda,
                                    const Vec2& rho, double width) {
  if (is_smooth(problem, i, rho)) return alart_curnier(problem, i, u, lambda, rho);
  const double mu = problem.mu[i];
  const Rounded normal(lambda.x() - rho.x() * u.x(), 0.0, rho.x() * width);
  AlartCurnier e{lambda, Mat3::Zero(), Mat3::Identity(), false};
  e.value.x() -= normal.value;
  e.by_u(0, 0) = rho.x() * normal.by_a;
  e.by_lambda(0, 0) = 1.0 - normal.by_a;
  if (mu == 0.0) {
    e.value.tail<2>().setZero();
    return e;
  }
  const Vec2 z = lambda.tail<2>() - rho.y() * u.tail<2>();
  const double bound = mu * normal.value, friction = kFriction * mu * rho.x() * width;
  Eigen::Matrix2d by_z;  // of the nearest point
  Vec2 by_bound;
  const auto nearest = [&](double size, double& factor, double& factor_by_size) {
    const Rounded larger(bound, size, friction);
    factor = bound / larger.value;
    factor_by_size = -factor / larger.value * larger.by_b;
    return (1.0 - factor * larger.by_a) / larger.value;  // the factor by the bound
  };
  if (problem.law == FrictionLaw::pyramid) {
    by_z.setZero();
    for (int k = 0; k < 2; ++k) {
      double factor, by_size;
      by_bound[k] = nearest(std::abs(z[k]), factor, by_size) * z[k];
      by_z(k, k) = factor + by_size * std::abs(z[k]);
      e.value[k + 1] -= factor * z[k];
    }
  } else {
    const double size = z.norm();
    double factor, by_size;
    by_bound = nearest(size, factor, by_size) * z;
    by_z = factor * Eigen::Matrix2d::Identity();
    if (size > 0.0) by_z += (by_size / size) * (z * z.transpose());
    e.value.tail<2>() -= factor * z;
  }
  e.by_u.block<2, 2>(1, 1) = rho.y() * by_z;
  e.by_lambda.block<2, 2>(1, 1) -= by_z;
  e.by_u.block<2, 1>(1, 0) = (mu * normal.by_a * rho.x()) * by_bound;
  e.by_lambda.block<2, 1>(1, 0) = (-mu * normal.by_a) * by_bound;
  return e;
}

Vec3 smoothed_alart_curnier_value(const ConeProblem& problem, std::size_t i, const Vec3& u, const Vec3& lambda,
                                  const Vec2& rho, double width) {
  if (is_smooth(problem, i, rho)) return alart_curnier_value(problem, i, u, lambda, rho);
  const double mu = problem.mu[i];
  const Rounded normal(lambda.x() - rho.x() * u.x(), 0.0, rho.x() * width);
  if (mu == 0.0) return {lambda.x() - normal.value, 0.0, 0.0};
  const double bound = mu * normal.value, friction = kFriction * mu * rho.x() * width;
  Vec2 z = lambda.tail<2>() - rho.y() * u.tail<2>();
  const auto factor = [&](double size) { return bound / Rounded(bound, size, friction).value; };
  if (problem.law == FrictionLaw::pyramid)
    z = Vec2(factor(std::abs(z.x())) * z.x(), factor(std::abs(z.y())) * z.y());
  else
    z *= factor(z.norm());
  return {lambda.x() - normal.value, lambda.y() - z.x(), lambda.z() - z.y()};
}

}  // namespace impinge
