// A mesh body at one instant as contact generation sees it: features of its surface, their normals and what surrounds
// them.
#pragma once

#include "engine/detection/collider.hpp"
#include "engine/detection/collision.hpp"
#include "engine/geometry/distance.hpp"

namespace impinge {

/// A vertex, edge or face of a mesh by its index there.
struct SurfaceFeature {
  Feature kind = Feature::face;
  int index = -1;
  friend bool operator==(const SurfaceFeature& l, const SurfaceFeature& r) {
    return l.kind == r.kind && l.index == r.index;
  }
};

class SurfaceView {
 public:
  SurfaceView(const Collider& collider, int body)
      : collider_(&collider), mesh_(&collider.mesh().mesh), topology_(&collider.mesh().topology), body_(body) {}

  int body() const { return body_; }
  bool is_deforming() const { return !collider_->vertex_velocities.empty(); }
  double mean_edge() const { return collider_->mean_edge; }
  const Vec3& vertex(int v) const { return collider_->vertices[v]; }
  const Triangle& triangle(int t) const { return mesh_->triangles[t]; }
  const MeshTopology::Edge& edge(int e) const { return topology_->edges[e]; }
  const std::array<int, 3>& triangle_edges(int t) const { return topology_->triangle_edges[t]; }
  std::span<const int> triangles_round(int v) const {
    return std::span(topology_->vertex_triangles)
        .subspan(topology_->vertex_triangle_begin[v],
                 topology_->vertex_triangle_begin[v + 1] - topology_->vertex_triangle_begin[v]);
  }
  TriangleCorners corners(int t) const {
    return {vertex(triangle(t)[0]), vertex(triangle(t)[1]), vertex(triangle(t)[2])};
  }

  Vec3 vertex_velocity(int v) const { return collider_->vertex_velocity(v); }
  /// Velocity of the material point of triangle t that is at `point`, m/s.
  Vec3 velocity_at(int t, const Vec3& point) const;

  /// Which feature of the mesh a feature of triangle t is.
  SurfaceFeature feature(int t, TriangleFeature f) const;
  /// A triangle that contains the feature, always the same one.
  int triangle_of(const SurfaceFeature& f) const;

  /// Outward unit normal; zero for a triangle of no area.
  Vec3 face_normal(int t) const;
  /// Outward unit normal of a feature: of the face; the mean of an edge's two faces; of a vertex the angle-weighted
  /// mean of its faces [Baerentzen05], whose sign tells inside from outside for every point that is closest to the
  /// feature.
  Vec3 normal(const SurfaceFeature& f) const;
  /// Whether x is inside, of what is by the normal of the feature nearest to it: where a surface that bends has folded
  /// over, that doesn't tell, but how often it winds round x does. True of a rigid one; slow of one that deforms.
  bool winds_round(const Vec3& x) const;
  /// Outward normals of the faces that meet in the feature.
  void adjacent_normals(const SurfaceFeature& f, std::vector<Vec3>& normals) const;
  /// Unit directions along the surface away from a point of the feature: a vertex's edges; both ways along an edge and
  /// into its two faces at right angles to it; none for a face.
  void star(const SurfaceFeature& f, std::vector<Vec3>& directions) const;
  /// Unit direction in face t, at right angles to its edge e, into the face.
  Vec3 into_face(int t, int e) const;

 private:
  const Collider* collider_;
  const TriangleMesh* mesh_;
  const MeshTopology* topology_;
  int body_;
};

}  // namespace impinge
