// A surface with fewer triangles: edges are drawn together into a vertex, one after another, where that costs least.
#pragma once

#include <string>

#include "engine/geometry/triangle_mesh.hpp"

namespace impinge {

struct DecimateReport {
  int triangles_before = 0, triangles_after = 0;
  double volume_before = 0.0, volume_after = 0.0;  ///< m³, signed; of open surfaces what their triangles span
  double farthest = 0.0;                           ///< metres: of a vertex of the one from the other surface

  /// "1000 of 3674 triangles, up to 0.57 mm apart, volume unchanged".
  std::string text() const;
};

struct DecimatedMesh {
  TriangleMesh mesh;
  DecimateReport report;
};

/// At most `most` triangles, or as few as can be had: no hole is closed and no handle, no part vanishes, and borders keep
/// their place; what was closed and oriented stays so. Triangles neither turn over nor come to cross or touch others that
/// they had nothing in common with: where none crossed, none does afterwards. An edge costs the squared distances of its
/// new vertex from the planes of all triangles that it stands for [Garland97]; that vertex keeps the volume [Lindstrom98].
/// Vertices that stay keep their coordinates. The same mesh gives the same triangles. Indices must be in range,
/// coordinates finite, no triangle may name a vertex twice. Throws Interrupted.
DecimatedMesh decimate(const TriangleMesh& mesh, int most);

/// Bytes that takes at most.
double decimate_memory(const TriangleMesh& mesh);

}  // namespace impinge
