// Where a deformable body's surface is now: the rest surface's triangles with other positions and normals.
#pragma once

#include <span>

#include "viewer/draw/shaded_surface.hpp"

namespace impinge {

/// As many positions and normals as the rest surface has, relative to `origin`.
struct MovedSurface {
  std::vector<Eigen::Vector3f> positions, normals;
  Eigen::AlignedBox3f bounds;
  bool solid = false;  ///< from outside, no triangle is seen from its back
  Vec3 origin = Vec3::Zero();
};
using MovedSurfacePointer = std::shared_ptr<const MovedSurface>;

/// `vertices`: where the source's vertices are, world coordinates. Corners that creased at rest stay creases, smooth
/// ones stay smooth: a normal is the area-weighted mean over the triangles that share its position. `everted`: whether
/// some part of the body is turned inside out, so that backs may be seen from outside.
MovedSurface move_surface(const ShadedSurface& rest, std::span<const Vec3> vertices, bool everted);

}  // namespace impinge
