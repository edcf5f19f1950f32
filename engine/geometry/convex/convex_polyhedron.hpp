// A convex polyhedron ready for contact: corners, edges and faces with their neighbours, and the farthest corner in any
// direction in little time.
#pragma once

#include <span>

#include "engine/geometry/convex/convex_set.hpp"
#include "engine/geometry/triangle_mesh.hpp"

namespace impinge {

class ConvexPolyhedron {
 public:
  struct Face {
    Vec3 normal = Vec3::Zero();  ///< unit, outward
    double offset = 0.0;         ///< normal·x of its outermost corner
  };
  struct Edge {
    int vertex0 = -1, vertex1 = -1;
    /// Two different ones: where triangles lie in a plane there is no edge. Seen from outside, face0 is on the left of
    /// the way from vertex0 to vertex1.
    int face0 = -1, face1 = -1;
  };

  /// Of a closed convex surface, outward. Triangles in one plane (to 1e-12 of the size) are one face.
  explicit ConvexPolyhedron(TriangleMesh surface);

  const MeshPointer& surface() const { return surface_; }
  const std::vector<Vec3>& vertices() const { return mesh_.vertices; }
  const std::vector<Face>& faces() const { return faces_; }
  const std::vector<Edge>& edges() const { return edges_; }
  std::span<const int> faces_round(int vertex) const { return row(vertex_faces_, vertex); }
  std::span<const int> edges_round(int vertex) const { return row(vertex_edges_, vertex); }
  int face_of_triangle(int triangle) const { return face_of_triangle_[triangle]; }
  double size() const { return size_; }  ///< diagonal of the bounding box, metres

  /// The corner farthest along a direction.
  int support_vertex(const Vec3& direction) const;
  /// The face whose normal is nearest to a direction, with neighbours that lie in its plane to 1e-7 of the size (files
  /// of single precision): what a body rests on does not depend on how a flat side was cut into triangles. At most 16
  /// corners: of more, those farthest out in 16 directions.
  ContactFace facing(const Vec3& direction) const;
  /// The number of that face alone.
  int face_facing(const Vec3& direction) const;

 private:
  struct Rows {
    std::vector<int> begin, item;
  };
  static std::span<const int> row(const Rows& rows, int i) {
    return std::span(rows.item).subspan(rows.begin[i], rows.begin[i + 1] - rows.begin[i]);
  }
  static Rows make_rows(int count, const std::vector<std::pair<int, int>>& entries);
  void find_faces();
  void find_neighbours();
  void find_resting_rings();

  MeshPointer surface_;
  const TriangleMesh& mesh_;      ///< the surface's
  const MeshTopology& topology_;  ///< likewise
  double size_ = 0.0;
  std::vector<Face> faces_;
  std::vector<Edge> edges_;
  std::vector<int> face_of_triangle_;
  Rows vertex_faces_, vertex_edges_, vertex_vertices_;
  Rows rings_;                    ///< of each face: the corners of what a body on it rests on
  std::vector<int> ring_sides_;   ///< parallel to rings_.item: numbers of the sides
  std::array<int, 6> extreme_{};  ///< farthest corners along ±x, ±y, ±z: where climbing starts
};

}  // namespace impinge
