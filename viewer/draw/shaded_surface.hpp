// A triangle surface made ready for drawing: single precision, a normal at every corner, split where it creases.
#pragma once

#include <memory>

#include "engine/shapes/shape.hpp"

namespace impinge {

struct ShadedSurface {
  std::vector<Eigen::Vector3f> positions, normals;      ///< as many of each
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< in the source's order
  std::vector<std::array<std::uint32_t, 2>> edges;      ///< each once, as two of the positions
  std::vector<std::uint32_t> source;                    ///< of each position: the source's vertex
  Eigen::AlignedBox3f bounds;
  bool solid = false;  ///< closed and facing outwards: from outside, no triangle is seen from its back
};
using ShadedSurfacePointer = std::shared_ptr<const ShadedSurface>;

/// Corners are smoothed over the neighbours whose normals differ by less than the crease angle.
ShadedSurface make_shaded_surface(const TriangleMesh& mesh, const MeshTopology& topology, double crease_deg);

}  // namespace impinge
