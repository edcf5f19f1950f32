// How a surface moves through a piece of time: a rigid one through poses, a deforming one on straight lines.
#pragma once

#include <span>

#include "engine/geometry/surface/exempt_pairs.hpp"
#include "engine/geometry/triangle_mesh.hpp"

namespace impinge {

/// What stays the same of a surface however it moves: its triangles with their tree, and which triangle answers for
/// each vertex and edge, so that a feature that several triangles share is looked at once.
struct PathSurface {
  explicit PathSurface(const SurfaceMesh& surface);
  const SurfaceMesh* surface;
  double radius = 0.0;              ///< of the farthest vertex from the frame's origin, metres
  std::vector<std::uint8_t> owned;  ///< by triangle: bits 0-2 its corners, 3-5 its edges
};

/// Time goes from 0 to 1.
struct SurfacePath {
  const PathSurface* of = nullptr;
  /// Of a rigid surface: poses at equal steps of time, 2^k + 1 of them, each less than a quarter turn from the next,
  /// between which it moves on the screw that joins them. Empty: `start` and `end` say it.
  std::vector<Pose> poses;
  std::span<const Vec3> start, end;     ///< of a deforming surface: its vertices, metres
  const ExemptPairs* exempt = nullptr;  ///< of its triangles, held against themselves; null: none

  bool is_rigid() const { return !poses.empty(); }
  int pieces() const { return is_rigid() ? static_cast<int>(poses.size()) - 1 : 1; }
  Pose pose_at(double t) const;
  /// How far a vertex may be off the straight line between its places at t0 and t1 on the way between them, metres. The
  /// two lie between neighbouring poses.
  double bend(double t0, double t1) const;
  /// How far a vertex moves from t0 to t1 at most, metres, between neighbouring poses.
  double travel(double t0, double t1) const;
};

}  // namespace impinge
