// Bodies' shapes made ready for drawing, once for all bodies and frames that share a shape; of deformable bodies the
// triangles are kept and the positions made anew for each record.
#pragma once

#include <map>

#include "engine/world/step_record.hpp"
#include "viewer/draw/moved_surface.hpp"
#include "viewer/draw/tet_shapes.hpp"

namespace impinge {

class SurfaceCache {
 public:
  /// The surface of a shape that has bounds, in the body's frame. What it returns depends on the shape alone.
  ShadedSurfacePointer surface_of(const Shape& shape);
  /// The same of the triangles that take part in contact, where those are others (SurfaceMesh::full).
  ShadedSurfacePointer touched_surface_of(const Shape& shape);
  /// Where a deformable body's surface is now, made once between two calls of forget_unused; null for other bodies.
  MovedSurfacePointer moved_of(const BodyRecord& body);
  /// The edges of a body's tetrahedra.
  const TetEdges& edges_of(const FemAssembly& fem);
  /// Call it after each record. Forgets what was not asked for since the last call, and all that moves.
  void forget_unused();

 private:
  struct Kept {
    std::shared_ptr<const Shape> source;  // kept, so that its address stays its own
    ShadedSurfacePointer surface;
    bool used = true;
  };
  struct KeptEdges {
    std::shared_ptr<const BlockPattern> pattern;  // likewise
    TetEdges edges;
    bool used = true;
  };
  using Key = std::tuple<int, const Shape*, std::vector<double>, bool>;  // type, itself or null, dimensions, touched

  ShadedSurfacePointer kept(const Shape& shape, bool is_touched);

  std::map<Key, Kept> kept_;
  std::map<const BlockPattern*, KeptEdges> edges_;
  std::map<const DeformableBody*, MovedSurfacePointer> moved_;  // of this record
};

}  // namespace impinge
