// A surface where its vertices stand, asked for what engine/geometry/inside.hpp finds by going through all its triangles: the
// same answers, from the triangles that matter. For judges, so that only the tree's order is shared with detection, which no
// answer depends on; boxes are made anew.
#pragma once

#include <span>
#include <vector>

#include "engine/geometry/surface/node_rims.hpp"
#include "engine/geometry/triangle_intersection.hpp"
#include "engine/geometry/triangle_mesh.hpp"

namespace impinge {

class SearchedMesh {
 public:
  /// All must outlive this, and not move. Without the rims of the surface's tree winding() looks at all triangles.
  SearchedMesh(const SurfaceMesh& surface, std::span<const Vec3> vertices, const NodeRims* rims = nullptr);

  const SurfaceMesh& surface() const { return *surface_; }
  std::span<const Triangle> triangles() const { return surface_->mesh.triangles; }
  std::span<const Vec3> vertices() const { return vertices_; }
  TriangleCorners corners(int triangle) const;
  const Aabb& box(int triangle) const { return boxes_[static_cast<std::size_t>(triangle)]; }

  /// winding_number(x) but for rounding, and to the bit where it is within 1e-6 of 1/2: on the same side of that always.
  double winding(const Vec3& x) const;
  /// distance_to_surface(x), to the bit.
  double distance(const Vec3& x) const;
  /// Of the triangles except one, how far along a unit direction from x the first is that intersect_line finds, metres;
  /// infinite: none.
  double way_along(const Vec3& x, const Vec3& direction, double slack, int except) const;
  /// Triangles whose boxes meet the box, in no order but always the same.
  std::vector<int> triangles_near(const Aabb& box) const;
  /// Vertices in the box, ascending; of those triangles all that they have.
  std::vector<int> vertices_near(const Aabb& box) const;

 private:
  const Aabb& node_box(int n) const { return fitted_[static_cast<std::size_t>(n)]; }
  double solid_angle_of_rim(int node, const Vec3& x) const;

  const SurfaceMesh* surface_;
  std::span<const Vec3> vertices_;
  const BoxTree* tree_;
  const NodeRims* rims_;
  std::vector<Aabb> boxes_, fitted_;  // fitted_ with room for what rounding adds to a distance
  std::vector<int> loose_;            // vertices of no triangle
};

}  // namespace impinge
