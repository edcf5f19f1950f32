// Which way a surface faces near each disc of its tree: a cone round the normals of the disc's triangles and of all others
// that share a vertex with them. A place on the surface from which nothing round it is nearer to a solid sees the solid in
// a direction of its own cone of normals; so parts that see it in no such direction hold no such place, however near they
// are.
//
// Cones are made for a surface as its mesh has it: rigid ones'.
#pragma once

#include "engine/geometry/surface/disc_tree.hpp"
#include "engine/geometry/triangle_mesh.hpp"

namespace impinge {

class NormalCones {
 public:
  /// Of the discs of a node of the tree, side by side.
  struct Node {
    float axis[4][3];          ///< unit; of the disc, in the mesh's own axes
    float cosine[4], sine[4];  ///< of the angle round it; cosine -2: any direction
    float chord[4];            ///< largest difference of a face's normal from the axis
    bool is_any(int k) const { return cosine[k] < -1.5f; }
    /// Whether all faces there lie in one plane, and all that share a vertex with them.
    bool is_flat(int k) const { return !is_any(k) && chord[k] <= kFlat; }
    /// What rounding makes of a chord of nothing, in double precision and as floats.
    static constexpr float kFlat = 3e-7f;
  };

  /// Round the normals of the faces at a vertex, and nothing more.
  struct OfVertex {
    float axis[3];
    float chord;  ///< the largest difference of a normal from the axis; negative: any direction
  };

  NormalCones(const DiscTree& discs, const SurfaceMesh& surface);
  const OfVertex& of_vertex(int v) const { return vertices_[static_cast<std::size_t>(v)]; }
  const Node& node(int level, int j) const { return nodes_[static_cast<std::size_t>(begin_[level] + j)]; }

  /// Whether the disc may hold a place that sees `away` (from its centre to the nearest point of a solid, metres) outside
  /// (or inside, if `or_inside`) of the surface, when the disc's places lie within `radius` of its centre.
  bool may_see(int level, int j, int k, const Vec3& away, double radius, bool or_inside) const;

 private:
  std::vector<OfVertex> vertices_;
  std::vector<Node> nodes_;
  std::vector<int> begin_;  // by level
};

/// Those of the surface's discs (SurfaceMesh::discs), made when they are asked for first.
const NormalCones& normal_cones(const SurfaceMesh& surface);

}  // namespace impinge
