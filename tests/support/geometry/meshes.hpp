// Closed meshes made by formula, and colliders made from them, for tests and benchmarks.
#pragma once

#include <deque>
#include <string>

#include "engine/detection/collider.hpp"
#include "engine/detection/triangles/narrow_phase.hpp"
#include "tests/support/random.hpp"

namespace impinge::test {

/// Icosahedron of circumradius `radius` split k times, new vertices pushed out to the sphere: 20·4ᵏ triangles.
TriangleMesh icosphere(int k, double radius = 1.0);
/// Axis y, around × across quads, two triangles each.
TriangleMesh torus(double major, double minor, int around, int across);
/// An icosphere whose radius varies smoothly by ±amplitude (relative), with dents: neither convex nor symmetric.
TriangleMesh bumpy_sphere(int k, double amplitude = 0.25);
/// A torus with the same kind of bumps along its normals.
TriangleMesh bumpy_torus(int around, int across, double amplitude = 0.2);
/// A box, each side cut into cells[axis] pieces; two triangles a cell, vertices shared at edges and corners.
TriangleMesh box(const Vec3& half, const Eigen::Vector3i& cells = Eigen::Vector3i::Ones());
/// A flat open sheet in the plane y = 0, facing up, [-half, half] in x and z.
TriangleMesh sheet(double half, int cells);

/// Appends the other, moved by `shift`, as a part of its own.
void append(TriangleMesh& mesh, const TriangleMesh& other, const Vec3& shift = Vec3::Zero());
/// Every triangle the other way round.
TriangleMesh inside_out(TriangleMesh mesh);

/// The shared data folder (IMPINGE_SHARED_DATA, or ../shared/data beside the sources) with that file, or "" if it is
/// absent.
std::string shared_file(const std::string& name);

MeshPointer surface(TriangleMesh mesh);
TriangleMesh scaled_to(TriangleMesh mesh, double longest_side);  ///< box centred at the origin

/// Owns what colliders point to. Colliders stay valid while the set lives and no body is added.
class ColliderSet {
 public:
  int add(MeshPointer mesh, const Pose& pose = {});
  /// Moves a body and its world vertices.
  void place(int body, const Pose& pose);
  /// Sets world vertices as they are: it is a deforming body then.
  void place(int body, std::vector<Vec3> world);
  Collider& operator[](int body) { return colliders_[body]; }
  std::span<const Collider> all() const { return colliders_; }

 private:
  std::deque<SharedShape> shapes_;
  std::deque<std::vector<Vec3>> vertices_, still_;
  std::vector<Collider> colliders_;
};

/// A random pose with its centre within `reach` of the origin on each axis.
Pose random_pose(Random& random, double reach);

}  // namespace impinge::test
