// A triangle surface and its connectivity.
#pragma once

#include <memory>

#include "engine/core/lazily.hpp"
#include "engine/core/types.hpp"

namespace impinge {

/// Vertices in source order (metres, the file's own axes) and triangles, counter-clockwise seen from outside.
struct TriangleMesh {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
};

/// Which edges and triangles meet where. Built once a mesh, valid for every pose and deformation of it.
struct MeshTopology {
  struct Edge {
    int v0 = -1, v1 = -1;                ///< v0 < v1
    int triangle0 = -1, triangle1 = -1;  ///< the two triangles that share it; triangle1 = -1 on a border
  };
  std::vector<Edge> edges;                         ///< sorted by (v0, v1)
  std::vector<std::array<int, 3>> triangle_edges;  ///< edge k of a triangle joins its corners k and (k+1)%3
  std::vector<int> vertex_triangle_begin;          ///< CSR rows: vertices + 1 entries
  std::vector<int> vertex_triangles;               ///< triangles round each vertex, ascending
  int nonmanifold_edges = 0;                       ///< edges with three or more triangles (only the first two are kept)
  int border_edges = 0;                            ///< edges with one triangle
  int misoriented_edges = 0;                       ///< edges that both their triangles traverse in the same direction
  bool is_closed() const { return nonmanifold_edges == 0 && border_edges == 0 && misoriented_edges == 0; }
};

MeshTopology make_topology(const TriangleMesh& mesh);

/// By edge, how many triangles have it: an Edge names two of them at most.
std::vector<int> edge_uses(const MeshTopology& topology);

/// Whether a corner `from` of the triangle is followed by `to`.
bool runs_along(const Triangle& triangle, int from, int to);

class BoxTree;
class DiscTree;
class DistanceField;

/// A surface ready for contact, shared by all that are made from the same source.
struct SurfaceMesh {
  TriangleMesh mesh;
  MeshTopology topology;
  Lazily<BoxTree> lazy_tree = {};
  Lazily<DiscTree> lazy_discs = {};
  Lazily<double> lazy_size = {};  ///< size_of (shapes/shape_size.hpp)
  LazilyAnew<DistanceField> lazy_field = {};
  /// The surface that this one stands for in contact, with fewer triangles (mend/decimate.hpp): it is drawn, exported
  /// and weighed. Null: itself.
  std::shared_ptr<const SurfaceMesh> full = nullptr;
  const SurfaceMesh& shown() const { return full == nullptr ? *this : *full; }
  /// Boxes over the triangles where `mesh` has them, made when they are asked for first.
  const BoxTree& tree() const;
  /// Flat discs over them, likewise.
  const DiscTree& discs() const;
  /// Distances round it (distance_field.hpp), of so many voxels at most; made when they are asked for first. Only where
  /// the program is built with OpenVDB. Throws Interrupted.
  std::shared_ptr<const DistanceField> field(std::size_t most_voxels) const;
};
using MeshPointer = std::shared_ptr<const SurfaceMesh>;

/// The mesh with its topology.
MeshPointer make_surface(TriangleMesh mesh);

/// Mean edge length over all triangles' edges, metres; 0 for no triangles.
double mean_edge_length(const TriangleMesh& mesh);

}  // namespace impinge
