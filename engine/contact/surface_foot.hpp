// The foot of a point on a body's surface: the nearest point there, with the surface's normal.
#pragma once

#include "engine/bodies/body.hpp"

namespace impinge {

struct SurfaceFoot {
  Vec3 point = Vec3::Zero();
  Vec3 normal = Vec3::UnitY();  ///< unit, outward; point + distance * normal is what was asked for, up to rounding
  double distance = 0.0;        ///< metres; negative: inside
  TriangleIndex triangle;       ///< of a mesh
};

/// World coordinates, at the body's present place. Of a compound, the foot on the part that it is deepest in or nearest
/// to. On a mesh's edge or vertex the normal is the direction of x as seen from there; where x lies in it, the mean of
/// the faces round it [Baerentzen05].
SurfaceFoot surface_foot(const Body& body, const Vec3& x);

}  // namespace impinge
