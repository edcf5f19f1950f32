// What a triangle surface is: its size, what it encloses, and what keeps it from being the boundary of a solid.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/geometry/aabb.hpp"
#include "engine/geometry/triangle_mesh.hpp"

namespace impinge {

struct MeshFacts {
  std::size_t vertices = 0, triangles = 0;  ///< coinciding vertices taken for one
  int coinciding = 0;                       ///< vertices that stand exactly where an earlier one does
  int unused = 0;                           ///< vertices that no triangle has
  Aabb box;                                 ///< of the triangles
  double area = 0.0;                        ///< m²
  double volume = 0.0;                      ///< m³, signed; of an open surface what its triangles span: a guess
  bool is_closed = false;
  int components = 0;               ///< parts that are connected by edges
  std::optional<int> genus;         ///< handles of all parts together; none where sheets meet
  int border_edges = 0, holes = 0;  ///< a hole: borders that are connected
  int nonmanifold_edges = 0;        ///< with three triangles or more
  int nonmanifold_vertices = 0;     ///< where sheets touch in a point
  int misoriented_edges = 0;        ///< whose two triangles face opposite ways
  int degenerate = 0;               ///< triangles without area
  int duplicates = 0;               ///< triangles with the corners of an earlier one
  std::size_t crossings = 0;        ///< pairs of triangles without a common vertex that cross or touch
  bool more_crossings = false;      ///< at least so many
  std::optional<double> thinnest;   ///< metres through the solid, from the middle of a triangle inwards
  int thin = 0;                     ///< triangles behind which it is thinner than a thousandth of its size
  double shortest_edge = 0.0, median_edge = 0.0, longest_edge = 0.0;  ///< m
  std::optional<std::string> problem;  ///< what keeps it from bounding a solid (check_mesh)
};

/// Where the faults are, for pictures: pairs of vertices, and triangles.
struct MeshMarks {
  TriangleMesh mesh;  ///< coinciding vertices taken for one
  std::vector<std::pair<int, int>> border, nonmanifold, misoriented;
  std::vector<int> crossing, degenerate, thin;
};

/// Indices must be in range and coordinates finite; all else may be wrong. Throws Interrupted.
MeshFacts measure(const TriangleMesh& mesh, MeshMarks* marks = nullptr);

/// Round the vertex, how many sets of triangles that are connected by edges: 1 on a surface, more where sheets touch.
int fans_round(int vertex, const TriangleMesh& mesh, const MeshTopology& topology);

/// Pairs of triangles that share no vertex and cross or touch, the lower index first, in order; of each triangle no
/// more than a few, and `more` says whether some were left out.
std::vector<std::pair<int, int>> find_crossings(const TriangleMesh& mesh, bool& more);

/// m³ of space that it encloses, once where it overlaps itself, by 200 rays along its longest side each way: to some
/// 1e-3. None: it isn't closed, even welded.
std::optional<double> enclosed_volume(const TriangleMesh& mesh);

}  // namespace impinge
