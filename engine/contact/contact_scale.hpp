// The length and the speed of a contact that automatic thresholds are parts of.
#pragma once

namespace impinge {

/// By default those of bodies of 0.42 m on the earth.
struct ContactScale {
  double length = 1.0 / 2.4;  ///< metres
  double speed = 1.0 / 0.49;  ///< m/s
};

}  // namespace impinge
