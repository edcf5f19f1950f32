// Closed meshes of machine parts, made by formula: what is turned, flat bars with holes or pins, a bolt and its nut.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "engine/geometry/triangle_mesh.hpp"

namespace impinge::test {

/// A profile (radius, z) turned about z; it begins and ends on the axis and runs upwards.
TriangleMesh turned(const std::vector<std::pair<double, double>>& profile, int sides);

/// A flat bar along x with its middle in the origin.
struct Bar {
  double length = 0.2, width = 0.04;  ///< metres; the length is that between the middles of its ends
  bool is_round = false;              ///< its ends: half discs, or square
  int sides = 64;                     ///< of a circle
};

/// A loop round either end: a circle of that radius, or the bar's outline. Heights are z, metres.
struct BarLoop {
  std::optional<double> radius;
  double z = 0.0;
};

/// The surface that goes from loop to loop, the solid on its left where z is up and the axis is left: with a first and a
/// last radius of 0 from axis to axis, else from the last loop back to the first.
TriangleMesh bar_of_loops(const Bar& bar, const std::vector<BarLoop>& loops);

inline constexpr int kThreadSides = 64;
inline constexpr double kThreadRadius = 0.02, kThreadDepth = 0.004, kPitch = 0.012, kThreadPlay = 3e-4;  ///< metres
TriangleMesh bolt(int turns);
TriangleMesh nut(int turns);

}  // namespace impinge::test
