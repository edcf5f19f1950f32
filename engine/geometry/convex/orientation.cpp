#include "engine/geometry/convex/orientation.hpp"

#include <cmath>

#include "engine/geometry/expansion.hpp"

namespace impinge {
namespace {

int exact_sign(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  std::array<std::array<Expansion, 3>, 3> row;  // a - d, b - d, c - d
  for (int k = 0; k < 3; ++k) {
    row[0][k] = difference(a[k], d[k]);
    row[1][k] = difference(b[k], d[k]);
    row[2][k] = difference(c[k], d[k]);
  }
  Expansion determinant;
  for (int k = 0; k < 3; ++k) {
    const int u = (k + 1) % 3, v = (k + 2) % 3;
    Expansion minor;
    add_product(minor, row[1][u], row[2][v], 1.0);
    add_product(minor, row[1][v], row[2][u], -1.0);
    add_product(determinant, row[0][k], minor, 1.0);
  }
  return sign_of(determinant);
}

/// a d - b c
double difference_of_products(double a, double b, double c, double d) {
  const double bc = b * c, error = std::fma(-b, c, bc);
  return std::fma(a, d, -bc) + error;
}

}  // namespace

int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 ad = a - d, bd = b - d, cd = c - d;
  const double yz1 = bd.y() * cd.z(), yz2 = bd.z() * cd.y(), zx1 = bd.z() * cd.x(), zx2 = bd.x() * cd.z(),
               xy1 = bd.x() * cd.y(), xy2 = bd.y() * cd.x();
  const double determinant = ad.x() * (yz1 - yz2) + ad.y() * (zx1 - zx2) + ad.z() * (xy1 - xy2);
  const double permanent = std::abs(ad.x()) * (std::abs(yz1) + std::abs(yz2)) +
                           std::abs(ad.y()) * (std::abs(zx1) + std::abs(zx2)) +
                           std::abs(ad.z()) * (std::abs(xy1) + std::abs(xy2));
  constexpr double kEpsilon = 0x1p-53;
  const double bound = (7.0 + 56.0 * kEpsilon) * kEpsilon * permanent;  // [Shewchuk97 §4.3]
  if (determinant > bound) return 1;
  if (determinant < -bound) return -1;
  return exact_sign(a, b, c, d);
}

Vec3 accurate_cross(const Vec3& u, const Vec3& v) {
  return {difference_of_products(u.y(), u.z(), v.y(), v.z()), difference_of_products(u.z(), u.x(), v.z(), v.x()),
          difference_of_products(u.x(), u.y(), v.x(), v.y())};
}

}  // namespace impinge
