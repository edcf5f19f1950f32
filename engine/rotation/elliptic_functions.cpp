#include "engine/rotation/elliptic_functions.hpp"

#include <algorithm>
#include <cmath>

namespace impinge {
namespace {

constexpr double kSettled = 1e-8;  // relative; the mean's next step would square it
constexpr double kLinear = 1e-8;   // sn u = u, cn u = dn u = 1 to rounding

/// R_C(1, 1 + e) = atan(√e)/√e, e >= 0.
double carlson_rc(double e) {
  if (e > 1e-2) return std::atan(std::sqrt(e)) / std::sqrt(e);
  double sum = 0.0;
  for (int n = 15; n > 0; n -= 2) sum = 1.0 / n - e * sum;
  return sum;
}

}  // namespace

JacobiFunctions::JacobiFunctions(double complement) {
  double a = 1.0, b = std::sqrt(complement);
  for (;;) {
    a_[steps_] = a, b_[steps_] = b;
    ++steps_;
    mean_ = 0.5 * (a + b);
    if (std::abs(a - b) <= kSettled * a || steps_ == kMostSteps) return;
    b = std::sqrt(a * b);
    a = mean_;
  }
}

double JacobiFunctions::quarter_period() const { return M_PI / (2.0 * mean_); }

JacobiFunctions::Values JacobiFunctions::at(double u) const {
  if (std::abs(u) < kLinear) return {u, 1.0, 1.0};
  const double angle = u * mean_, sine = std::sin(angle);
  double ratio = std::cos(angle) / sine, c = mean_ * ratio, dn = 1.0;
  for (int i = steps_ - 1; i >= 0; --i) {
    ratio *= c;
    c *= dn;
    dn = (b_[i] + ratio) / (a_[i] + ratio);
    ratio = c / a_[i];
  }
  const double sn = std::copysign(1.0 / std::sqrt(c * c + 1.0), sine);
  return {sn, c * sn, dn};
}

double carlson_rj(double x, double y, double z, double p) {
  const double mean = (x + y + z + 2.0 * p) / 5.0, dx = mean - x, dy = mean - y, dz = mean - z;
  // the series at the end is of fifth order: its error is below rounding once everything is this near to the mean
  const double far = 600.0 * std::max({std::abs(dx), std::abs(dy), std::abs(dz), std::abs(mean - p)});
  double a = mean, scale = 1.0, sum = 0.0, delta = (p - x) * (p - y) * (p - z);
  while (scale * far > a) {
    const double rx = std::sqrt(x), ry = std::sqrt(y), rz = std::sqrt(z), rp = std::sqrt(p);
    const double lambda = rx * ry + rx * rz + ry * rz, d = (rp + rx) * (rp + ry) * (rp + rz);
    sum += scale / d * carlson_rc(delta / (d * d));
    for (double* value : {&x, &y, &z, &p, &a}) *value = 0.25 * (*value + lambda);
    scale *= 0.25;
    delta /= 64.0;
  }
  const double u = dx * scale / a, v = dy * scale / a, w = dz * scale / a, q = -0.5 * (u + v + w);
  const double e2 = u * v + u * w + v * w - 3.0 * q * q, e3 = u * v * w + 2.0 * e2 * q + 4.0 * q * q * q;
  const double e4 = (2.0 * u * v * w + e2 * q + 3.0 * q * q * q) * q, e5 = u * v * w * q * q;
  const double series = 1.0 - 3.0 * e2 / 14.0 + e3 / 6.0 + 9.0 * e2 * e2 / 88.0 - 3.0 * e4 / 22.0 -
                        9.0 * e2 * e3 / 52.0 + 3.0 * e5 / 26.0;
  return scale * series / (a * std::sqrt(a)) + 6.0 * sum;
}

}  // namespace impinge
