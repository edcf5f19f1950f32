// The convex hull of a mesh, in its own frame, without making it: its tree of boxes tells how far it reaches.
#pragma once

#include "engine/geometry/convex/convex_set.hpp"
#include "engine/geometry/triangle_mesh.hpp"

namespace impinge {

class MeshHull final : public ConvexSet {
 public:
  /// Of a surface that lives longer.
  explicit MeshHull(const SurfaceMesh& surface) : surface_(&surface) {}
  Vec3 support(const Vec3& direction) const override;

 private:
  struct Search;
  void visit(int node, Search& search) const;
  const SurfaceMesh* surface_;
};

}  // namespace impinge
