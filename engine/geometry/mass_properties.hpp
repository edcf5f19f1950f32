// Mass, centre of mass and inertia of solids: by exact volume integrals for closed triangle surfaces, by formula for
// exact shapes. For a Shape see engine/shapes/shape_mass.hpp.
#pragma once

#include "engine/geometry/aabb.hpp"
#include "engine/geometry/triangle_mesh.hpp"

namespace impinge {

/// Of its triangles: a vertex that none has doesn't count.
Aabb bounds_of(const TriangleMesh& mesh);

/// Of a solid of uniform density.
struct MassProperties {
  double mass = 0.0;            ///< kg; <= 0 for a mesh that is inside out or encloses nothing: the caller says so
  Vec3 center = Vec3::Zero();   ///< centre of mass, in the axes of the shape, metres
  Mat3 inertia = Mat3::Zero();  ///< about `center`, kg·m², in the axes of the shape
};

/// The moments about a body's principal axes.
struct PrincipalInertia {
  Vec3 moments = Vec3::Ones();   ///< kg·m², ascending, positive
  Mat3 axes = Mat3::Identity();  ///< columns: the axis of each moment, right-handed

  Mat3 matrix() const { return axes * moments.asDiagonal() * axes.transpose(); }
  Mat3 inverse() const { return axes * moments.cwiseInverse().asDiagonal() * axes.transpose(); }
};

/// Of a symmetric matrix of inertia. A diagonal one keeps its moments to the last bit, whatever their ratio; of any
/// other a moment below 1e-15 of the largest is rounding, and is taken as that.
PrincipalInertia principal_inertia(const Mat3& inertia);

/// Signed volume that a closed mesh encloses, m³; negative when its triangles face inwards.
double signed_volume(const TriangleMesh& mesh);

/// Mass properties of the solid that a closed mesh bounds; density in kg/m³. Exact up to rounding: the volume integrals
/// of 1, x and x xᵀ are sums over the tetrahedra that each triangle spans with one point (divergence theorem).
/// For a volume <= 0 the mass is <= 0 and the centre is that of the bounding box.
MassProperties mesh_mass(const TriangleMesh& mesh, double density);

/// Centred at the origin. `half`: half of the full lengths. Capsule: axis y, cap centres at y = +-half_length.
MassProperties sphere_mass(double radius, double density);
MassProperties box_mass(const Vec3& half, double density);
MassProperties capsule_mass(double radius, double half_length, double density);

}  // namespace impinge
