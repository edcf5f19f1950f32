// The shapes that others know by their dimensions: the exact tests of pairs, closed forms, the floor that is drawn
// without end. Sphere, box and capsule are centred at their frame's origin.
#pragma once

#include "engine/core/lazily.hpp"
#include "engine/geometry/convex/convex_polyhedron.hpp"
#include "engine/shapes/shape.hpp"

namespace impinge {

/// The half-space normal·x <= offset is solid; static or scripted bodies only.
class Plane final : public Shape {
 public:
  explicit Plane(const Vec3& unit_normal = Vec3::UnitY(), double distance = 0.0);
  Vec3 normal;    ///< unit
  double offset;  ///< metres

  ShapeForm form() const override { return this; }
  Aabb bounds(const Pose& pose) const override;
  double bounding_radius() const override { return 0.0; }
  MassProperties mass(double) const override { return {}; }
  double signed_distance(const Vec3& x) const override { return normal.dot(x) - offset; }
  TriangleMesh surface(double edge) const override;
  TriangleMesh drawn() const override { return surface(0.0); }
  std::vector<double> dimensions() const override { return {normal.x(), normal.y(), normal.z(), offset}; }
};

class Sphere final : public ConvexShape {
 public:
  explicit Sphere(double metres);
  double radius;

  Aabb bounds(const Pose& pose) const override;
  double bounding_radius() const override { return radius; }
  MassProperties mass(double density) const override;
  double signed_distance(const Vec3& x) const override { return x.norm() - radius; }
  Vec3 support(const Vec3&) const override { return Vec3::Zero(); }
  double rounding() const override { return radius; }
  Vec3 rolled(const Vec3&, const Vec3&, const Vec3& to) const override { return radius * to; }
  bool is_round_about_y() const override { return true; }
  TriangleMesh surface(double edge) const override;
  TriangleMesh drawn() const override;
  std::vector<double> dimensions() const override { return {radius}; }
};

class Box final : public ConvexShape {
 public:
  explicit Box(const Vec3& half_lengths);
  Vec3 half;  ///< half of the full lengths

  Aabb bounds(const Pose& pose) const override;
  double bounding_radius() const override { return half.norm(); }
  MassProperties mass(double density) const override;
  double signed_distance(const Vec3& x) const override;
  Vec3 outward(const Vec3& x) const override;
  Vec3 support(const Vec3& direction) const override;
  ContactFace facing(const Vec3& direction) const override { return polyhedron()->facing(direction); }
  /// Its surface is make_box_mesh's twelve triangles: two a face, in the order -z, +z, -y, +y, -x, +x.
  const ConvexPolyhedron* polyhedron() const override;
  TriangleMesh surface(double edge) const override;
  TriangleMesh drawn() const override;
  std::vector<double> dimensions() const override { return {half.x(), half.y(), half.z()}; }

 private:
  Lazily<ConvexPolyhedron> solid_;  ///< made when it is first asked for: most boxes meet nothing that needs it
};

/// Axis y; the cap centres lie at y = ±half_length.
class Capsule final : public ConvexShape {
 public:
  Capsule(double radius_in_metres, double half_length_in_metres);
  double radius, half_length;

  Aabb bounds(const Pose& pose) const override;
  double bounding_radius() const override { return half_length + radius; }
  MassProperties mass(double density) const override;
  double signed_distance(const Vec3& x) const override;
  Vec3 support(const Vec3& direction) const override;
  ContactFace facing(const Vec3& direction) const override;
  bool is_round_about_y() const override { return true; }
  double rounding() const override { return radius; }
  TriangleMesh surface(double edge) const override;
  TriangleMesh drawn() const override;
  std::vector<double> dimensions() const override { return {radius, half_length}; }
};

/// The twelve triangles of a box (exact: a box is a polyhedron), outward, with their topology.
MeshPointer make_box_mesh(const Vec3& half);

/// A box about the origin, each side cut into cells[axis] pieces, two triangles a cell; vertices shared, closed,
/// outward.
TriangleMesh box_surface(const Vec3& half, const Eigen::Vector3i& cells);

/// How many cells of one size a box has along each axis if `cells` of them lie along its longest side.
Eigen::Vector3i cells_of_box(const Vec3& half, double cells);

/// An icosahedron whose edges are halved k times, vertices on the sphere: 20·4^k triangles, closed, outward.
TriangleMesh sphere_surface(double radius, int k);

/// A capsule about the origin along y, cap centres at y = ±half_length: `around` >= 3 vertices a ring, rings about as
/// far apart as their vertices; closed, outward.
TriangleMesh capsule_surface(double radius, double half_length, int around);

}  // namespace impinge
