// A plane that cuts surfaces open, so that one sees into bodies.
#pragma once

#include "engine/core/types.hpp"

namespace impinge {

/// What lies on the side that `normal` points to is left out.
struct ClipPlane {
  bool enabled = false;
  Vec3 normal = Vec3::UnitX();  ///< of any length but zero, which cuts nothing
  double offset = 0.0;          ///< metres from the origin along the normal

  bool is_on() const { return enabled && normal.squaredNorm() > 0.0; }
  /// Metres from the plane; positive on the side that is left out. The plane must be on.
  double height(const Vec3& point) const { return normal.normalized().dot(point) - offset; }
  bool removes(const Vec3& point) const { return is_on() && height(point) > 0.0; }
  /// Shortens the segment to what is left of it; false if nothing is.
  bool trim(Vec3& a, Vec3& b) const {
    if (!is_on()) return true;
    const double ha = height(a), hb = height(b);
    if (ha > 0.0 && hb > 0.0) return false;
    if (ha > 0.0) a += (b - a) * (ha / (ha - hb));
    if (hb > 0.0) b += (a - b) * (hb / (hb - ha));
    return true;
  }
};

/// How backs of surfaces are drawn.
enum class Backs { shown, hidden, only };

}  // namespace impinge
