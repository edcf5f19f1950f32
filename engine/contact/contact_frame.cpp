#include "engine/contact/contact_frame.hpp"

namespace impinge {

Vec3 tangent1(const Vec3& normal) {
  int axis = 0;  // the first of the world axes along which the normal is smallest
  for (int k = 1; k < 3; ++k)
    if (std::abs(normal[k]) < std::abs(normal[axis])) axis = k;
  return Vec3::Unit(axis).cross(normal).normalized();
}

Mat3 contact_axes(const Vec3& normal) {
  const Vec3 t1 = tangent1(normal);
  Mat3 axes;
  axes << normal.transpose(), t1.transpose(), normal.cross(t1).transpose();
  return axes;
}

}  // namespace impinge
