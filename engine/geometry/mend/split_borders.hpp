// Borders that run along each other with different vertices, as where a finely cut face stands on a coarse one.
#pragma once

#include "engine/geometry/triangle_mesh.hpp"

namespace impinge {

struct SplitBorders {
  int edges = 0;              ///< that were split
  double largest_move = 0.0;  ///< metres, of a point of such an edge
};

/// Border edges along which another border runs, no farther away than `tolerance`, metres, are split at its vertices,
/// which stay where they are. Then both have the same edges.
SplitBorders split_borders(TriangleMesh& mesh, double tolerance);

}  // namespace impinge
