// Bodies' shapes made ready for drawing, once for all bodies and frames that share a shape.
#pragma once

#include <map>

#include "viewer/draw/shaded_surface.hpp"

namespace impinge {

class SurfaceCache {
 public:
  /// The surface of a sphere, box, capsule or mesh in the body's frame. What it returns depends on the shape alone.
  ShadedSurfacePointer surface_of(const Shape& shape);
  /// Forgets what was not asked for since the last call.
  void forget_unused();

 private:
  struct Kept {
    MeshPointer source;  // of a mesh: kept, so that its address stays its own
    ShadedSurfacePointer surface;
    bool used = true;
  };
  using Key = std::tuple<int, const SurfaceMesh*, double, double, double>;  // kind, mesh, dimensions

  std::map<Key, Kept> kept_;
};

}  // namespace impinge
