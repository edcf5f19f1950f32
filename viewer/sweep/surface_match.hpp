// Which points of two surfaces of one body are the same material, however either is divided into triangles.
#pragma once

#include <vector>

#include "engine/geometry/triangle_mesh.hpp"

namespace impinge {

/// Made where both surfaces stand as they begin: each vertex of the one belongs to the nearest point of the other, or,
/// where both have the same triangles, to the vertex of its number, wherever that begins.
class SurfaceMatch {
 public:
  SurfaceMatch(const TriangleMesh& own, const TriangleMesh& other);
  bool is_by_number() const { return places_.empty(); }
  /// Where the points of the other surface are that belong to the vertices, once that surface's own are at `vertices`.
  std::vector<Vec3> points(const std::vector<Vec3>& vertices) const;
  double apart() const { return apart_; }  ///< m: the largest distance at the start; 0 by number

 private:
  struct Place {
    Triangle corners;
    Vec3 weights;
  };
  std::vector<Place> places_;
  double apart_ = 0.0;
};

}  // namespace impinge
