// The sum of squared distances of a point from planes, each times a weight: what it costs to put a vertex there that
// stands for the triangles of those planes. [Garland97]
#pragma once

#include "engine/core/types.hpp"

namespace impinge {

struct Quadric {
  Mat3 a = Mat3::Zero();
  Vec3 b = Vec3::Zero();
  double c = 0.0;

  /// normal·x = offset, the normal of length 1.
  void add_plane(const Vec3& normal, double offset, double weight) {
    a += weight * normal * normal.transpose();
    b -= weight * offset * normal;
    c += weight * offset * offset;
  }
  Quadric& operator+=(const Quadric& other) {
    a += other.a;
    b += other.b;
    c += other.c;
    return *this;
  }
  /// Not negative, whatever rounding leaves of it.
  double at(const Vec3& x) const { return std::max(0.0, x.dot(a * x) + 2.0 * b.dot(x) + c); }
};

}  // namespace impinge
