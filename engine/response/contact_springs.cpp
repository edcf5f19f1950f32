#include "engine/response/contact_springs.hpp"

#include <algorithm>
#include <cmath>

namespace impinge {
namespace {

constexpr int kHalvings = 8;
constexpr double kInnerTolerance = 1e-2;  // friction is followed step by step anyway: solving each exactly pays nothing

/// Where the potential's slope along p has fallen to a tenth: 1 in the usual case, or by bisection, since it only
/// rises.
double line_search(const std::vector<SpringLaw>& law, const std::vector<double>& normal, const std::vector<Vec3>& u,
                   const std::vector<Vec3>& step, double p_ax, double p_ap) {
  const auto slope = [&](double alpha) {
    double sum = p_ax + alpha * p_ap;
    for (std::size_t i = 0; i < law.size(); ++i) sum -= law[i].impulse(u[i] + alpha * step[i], normal[i]).dot(step[i]);
    return sum;
  };
  const double first = slope(0.0);
  double low = 0.0, high = 1.0;
  if (!(slope(1.0) > 0.1 * std::abs(first))) return 1.0;
  for (int k = 0; k < 40; ++k) {
    const double middle = 0.5 * (low + high), value = slope(middle);
    if (std::abs(value) <= 0.1 * std::abs(first)) return middle;
    (value > 0.0 ? high : low) = middle;
  }
  return low > 0.0 ? low : high;
}

}  // namespace

double SpringLaw::normal(const Vec3& u) const {
  const double n = offset - slope * u.x();
  return kind == RowKind::contact ? std::max(0.0, n) : n;
}

double SpringLaw::resistance(double speed) const {
  const double y = speed / slip_speed;
  return y < 1.0 ? y * (2.0 - y) : 1.0;
}

Vec3 SpringLaw::impulse(const Vec3& u, double n) const {
  if (kind == RowKind::attachment) return Vec3(offset, 0, 0) - slope * u;
  Vec3 lambda(normal(u), 0, 0);
  const double speed = std::hypot(u.y(), u.z());
  if (kind == RowKind::contact && friction > 0.0 && speed > 0.0)
    lambda.tail<2>() = -friction * n * resistance(speed) / speed * u.tail<2>();
  return lambda;
}

Mat3 SpringLaw::stiffness(const Vec3& u, double n) const {
  if (kind == RowKind::attachment) return slope * Mat3::Identity();
  Mat3 h = Mat3::Zero();
  if (kind == RowKind::sliding || normal(u) > 0.0) h(0, 0) = slope;
  if (kind == RowKind::sliding || friction == 0.0 || n == 0.0) return h;
  const double speed = std::hypot(u.y(), u.z()), y = speed / slip_speed;
  const double across = y > 0.0 ? resistance(speed) / speed : 2.0 / slip_speed,
               along = y < 1.0 ? 2.0 * (1.0 - y) / slip_speed : 0.0;
  const Vec2 d = speed > 0.0 ? Vec2(u.tail<2>() / speed) : Vec2(1, 0);
  h.bottomRightCorner<2, 2>() =
      friction * n * (across * Eigen::Matrix2d::Identity() + (along - across) * d * d.transpose());
  return h;
}

Mat3 SpringLaw::derivative(const Vec3& u) const {
  const double n = normal(u), speed = std::hypot(u.y(), u.z());
  Mat3 h = stiffness(u, n);
  if (kind == RowKind::contact && n > 0.0 && friction > 0.0 && speed > 0.0)
    h.block<2, 1>(1, 0) = -friction * slope * resistance(speed) / speed * u.tail<2>();
  return h;
}

namespace {

/// Newton's method on A Δv = J^T λ(u) with friction that follows the normal impulse: no potential has these forces, so
/// steps are measured by what is left. False where none serves; ax and u stay at the best then.
bool newton_with_friction(const GroupOperator& a, const std::vector<SpringLaw>& law, double tolerance,
                          int max_iterations, GroupSystem& group, SpringSolver& linear, VecX& ax, std::vector<Vec3>& u,
                          int& steps) {
  const std::size_t m = law.size();
  std::vector<Vec3> along(m), trial(m);
  std::vector<Mat3> h(m);
  double size = 0.0;
  const auto left = [&](const std::vector<Vec3>& at, const VecX& a_at) {
    VecX r = VecX::Zero(a.size());
    for (std::size_t i = 0; i < m; ++i)
      a.add_impulse(i, group.lambda[i] = law[i].impulse(at[i], law[i].normal(at[i])), r);
    size = std::max(size, a.norm(r));
    return VecX(r - a_at);
  };
  VecX r = left(u, ax);
  double residual = a.norm(r);
  while (residual > tolerance * size) {
    if (steps == max_iterations) return false;
    ++steps;
    for (std::size_t i = 0; i < m; ++i) h[i] = law[i].derivative(u[i]);
    VecX p;
    linear.solve_unsymmetric(h, r, kInnerTolerance, p);
    const VecX ap = a.multiply(p);
    for (std::size_t i = 0; i < m; ++i) along[i] = a.row(i, p);
    double length = 1.0, next = 0.0;
    for (int k = 0;; ++k, length *= 0.5) {
      if (k > kHalvings) return false;
      for (std::size_t i = 0; i < m; ++i) trial[i] = u[i] + length * along[i];
      r = left(trial, ax + length * ap);
      next = a.norm(r);
      if (next <= (1.0 - 0.1 * length) * residual) break;
    }
    ax += length * ap;
    u.swap(trial);
    residual = next;
  }
  return true;
}

}  // namespace

SpringsResult solve_springs(const GroupOperator& a, const std::vector<SpringLaw>& law, double tolerance,
                            int max_iterations, GroupSystem& group, SpringSolver& linear) {
  const std::size_t m = law.size();
  std::vector<Vec3> u, step(m);
  // what friction goes by: follows the normal impulses, by a part of the way once they swing
  std::vector<double> normal(m);
  std::vector<Mat3> h(m);
  for (std::size_t i = 0; i < m; ++i) u.push_back(group.contact_velocity(i, false));
  VecX ax = VecX::Zero(a.size());
  double size = 0.0, part = 1.0, before = 0.0;
  SpringsResult result;
  if (std::any_of(law.begin(), law.end(),
                  [](const SpringLaw& l) { return l.kind == RowKind::contact && l.friction > 0.0; }) &&
      newton_with_friction(a, law, tolerance, max_iterations, group, linear, ax, u, result.iterations))
    return {result.iterations, true};
  while (true) {
    VecX r = VecX::Zero(a.size()), change = VecX::Zero(a.size());
    for (std::size_t i = 0; i < m; ++i) {
      const double now = law[i].normal(u[i]);
      normal[i] = result.iterations == 0 ? now : normal[i] + part * (now - normal[i]);
      group.lambda[i] = law[i].impulse(u[i], now);
      h[i] = law[i].stiffness(u[i], normal[i]);
      a.add_impulse(i, group.lambda[i], r);
      if (normal[i] != now) a.add_impulse(i, law[i].impulse(u[i], normal[i]) - group.lambda[i], change);
    }
    size = std::max(size, a.norm(r));
    r -= ax;
    const double residual = a.norm(r);
    result.converged = residual <= tolerance * size;
    if (result.converged || result.iterations == max_iterations) return result;
    if (result.iterations > 1 && residual > before) part = std::max(0.5 * part, 0.1);
    before = residual;
    r += change;
    ++result.iterations;
    VecX p;
    linear.solve(h, r, kInnerTolerance, p);  // what it falls short of shows in the next residual
    for (std::size_t i = 0; i < m; ++i) step[i] = a.row(i, p);
    const VecX ap = a.multiply(p);
    const double alpha = line_search(law, normal, u, step, dot(p, ax), dot(p, ap));
    ax += alpha * ap;
    for (std::size_t i = 0; i < m; ++i) u[i] += alpha * step[i];
  }
}

bool apply_springs(const GroupOperator& a, GroupSystem& group, const SpringSolver& linear) {
  VecX b = VecX::Zero(a.size()), x;
  for (std::size_t i = 0; i < group.contacts.size(); ++i) a.add_impulse(i, group.lambda[i], b);
  const bool solved = linear.free(b, 1e-12, x);
  a.store(x, group);
  return solved;
}

}  // namespace impinge
