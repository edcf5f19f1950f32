#include "engine/contact/friction_cone.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace impinge {

Vec3 project_to_cone(const Vec3& z, double mu) {
  if (mu == 0.0) return {std::max(z.x(), 0.0), 0.0, 0.0};
  const double t = std::hypot(z.y(), z.z());
  if (t <= mu * z.x()) return z;
  if (mu * t <= -z.x()) return Vec3::Zero();
  const double n = (z.x() + mu * t) / (1.0 + mu * mu);
  const double scale = mu * n / t;
  return {n, z.y() * scale, z.z() * scale};
}

Vec3 project_to_pyramid(const Vec3& z, double mu) {
  if (mu == 0.0) return {std::max(z.x(), 0.0), 0.0, 0.0};
  // t_k = clamp(z_k, ±mu n); the slope of the squared distance in n, n - z_n - mu Σ max(0, |z_k| - mu n), rises with n
  const double small = std::min(std::abs(z.y()), std::abs(z.z())), large = std::max(std::abs(z.y()), std::abs(z.z()));
  double n = z.x();  // no side is clamped
  if (mu * n < large) n = (z.x() + mu * large) / (1.0 + mu * mu);
  if (mu * n < small) n = (z.x() + mu * (large + small)) / (1.0 + 2.0 * mu * mu);
  n = std::max(n, 0.0);
  return {n, std::clamp(z.y(), -mu * n, mu * n), std::clamp(z.z(), -mu * n, mu * n)};
}

double cone_violation(const Vec3& lambda, double mu, FrictionLaw law) {
  const double t = law == FrictionLaw::cone ? std::hypot(lambda.y(), lambda.z())
                                            : std::max(std::abs(lambda.y()), std::abs(lambda.z()));
  return std::max({0.0, -lambda.x(), t - mu * lambda.x()});
}

Vec3 project_to_dual_cone(const Vec3& z, double mu) { return z + project_to_cone(-z, mu); }  // Moreau

Vec3 solve_one_contact(const Mat3& w, const Vec3& b, double mu) {
  if (b.x() >= 0.0) return Vec3::Zero();
  if (mu == 0.0) return {-b.x() / w(0, 0), 0.0, 0.0};

  // eliminate the normal row with u_n = 0: λ_n = -(b_n + w_nt λ_t) / w_nn leaves a 2 x 2 problem in λ_t
  const double inv_nn = 1.0 / w(0, 0);
  const double s00 = w(1, 1) - w(1, 0) * w(0, 1) * inv_nn, s01 = w(1, 2) - w(1, 0) * w(0, 2) * inv_nn;
  const double s10 = w(2, 1) - w(2, 0) * w(0, 1) * inv_nn, s11 = w(2, 2) - w(2, 0) * w(0, 2) * inv_nn;
  const double c0 = b.y() - w(1, 0) * b.x() * inv_nn, c1 = b.z() - w(2, 0) * b.x() * inv_nn;
  // u_t = -k λ_t with k >= 0 (k = 0: stick), so λ_t(k) = -(S + k I)⁻¹ c; the root of |λ_t| - mu λ_n is slip
  double t0 = 0.0, t1 = 0.0, n = 0.0;
  const auto evaluate = [&](double k) {
    const double a = s00 + k, d = s11 + k, inv = 1.0 / (a * d - s01 * s10);
    t0 = -inv * (d * c0 - s01 * c1);
    t1 = -inv * (a * c1 - s10 * c0);
    n = -(b.x() + w(0, 1) * t0 + w(0, 2) * t1) * inv_nn;
    return std::hypot(t0, t1) - mu * n;
  };
  double f = evaluate(0.0);
  if (f <= 0.0) return {n, t0, t1};

  double low = 0.0, high = 0.0, k = std::max(s00 + s11, 1e-300);
  for (int i = 0; i < 200; ++i, k *= 4.0) {  // |λ_t| -> 0 and λ_n -> -b_n/w_nn > 0 as k grows: the bracket closes
    f = evaluate(k);
    if (f <= 0.0) break;
    low = k;
  }
  high = k;
  for (int i = 0; i < 100; ++i) {
    const double t = std::hypot(t0, t1);
    if (std::abs(f) <= 4e-16 * (t + mu * std::abs(n)) || high - low <= 1e-16 * high) break;
    (f > 0.0 ? low : high) = k;
    // Newton on |λ_t| - mu λ_n: dλ_t/dk = -(S + k I)⁻¹ λ_t
    const double a = s00 + k, d = s11 + k, inv = 1.0 / (a * d - s01 * s10);
    const double d0 = -inv * (d * t0 - s01 * t1), d1 = -inv * (a * t1 - s10 * t0);
    const double slope = (t > 0.0 ? (t0 * d0 + t1 * d1) / t : 0.0) + mu * inv_nn * (w(0, 1) * d0 + w(0, 2) * d1);
    double next = slope < 0.0 ? k - f / slope : -1.0;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    k = next;
    f = evaluate(k);
  }
  // put the answer on the cone exactly, at the normal impulse found
  const double t = std::hypot(t0, t1);
  n = std::max(n, 0.0);
  const double scale = t > 0.0 ? mu * n / t : 0.0;
  return {n, t0 * scale, t1 * scale};
}

}  // namespace impinge
