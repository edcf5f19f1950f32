#include "engine/detection/contacts/surface_view.hpp"

#include <cmath>

#include "engine/geometry/inside.hpp"

namespace impinge {
namespace {

Vec3 unit_or_zero(const Vec3& v) {
  const double length = v.norm();
  return length > 0.0 ? Vec3(v / length) : Vec3(Vec3::Zero());
}

}  // namespace

Vec3 SurfaceView::velocity_at(int t, const Vec3& point) const {
  if (collider_->vertex_velocities.empty()) return collider_->velocity_at(point);
  const TriangleCorners c = corners(t);
  const Vec3 normal = normal_of(c);
  const double area2 = normal.squaredNorm();
  const Triangle& v = triangle(t);
  if (!(area2 > 0.0)) return vertex_velocity(v[0]);
  const double w1 = (point - c[0]).cross(c[2] - c[0]).dot(normal) / area2;
  const double w2 = (c[1] - c[0]).cross(point - c[0]).dot(normal) / area2;
  return (1.0 - w1 - w2) * vertex_velocity(v[0]) + w1 * vertex_velocity(v[1]) + w2 * vertex_velocity(v[2]);
}

SurfaceFeature SurfaceView::feature(int t, TriangleFeature f) const {
  if (is_corner(f)) return {Feature::vertex, triangle(t)[feature_number(f)]};
  if (is_edge(f)) return {Feature::edge, triangle_edges(t)[feature_number(f)]};
  return {Feature::face, t};
}

int SurfaceView::triangle_of(const SurfaceFeature& f) const {
  if (f.kind == Feature::vertex) return triangles_round(f.index)[0];
  return f.kind == Feature::edge ? edge(f.index).triangle0 : f.index;
}

Vec3 SurfaceView::face_normal(int t) const { return unit_or_zero(normal_of(corners(t))); }

bool SurfaceView::winds_round(const Vec3& x) const {
  return !is_deforming() || winding_number(x, collider_->vertices, mesh_->triangles) > 0.5;
}

Vec3 SurfaceView::normal(const SurfaceFeature& f) const {
  if (f.kind == Feature::face) return face_normal(f.index);
  Vec3 sum = Vec3::Zero();
  if (f.kind == Feature::edge) {
    const MeshTopology::Edge& e = edge(f.index);
    sum = face_normal(e.triangle0);
    if (e.triangle1 >= 0) sum += face_normal(e.triangle1);
  } else {
    for (int t : triangles_round(f.index)) {
      const Triangle& c = triangle(t);
      const int k = c[0] == f.index ? 0 : c[1] == f.index ? 1 : 2;
      const Vec3 e1 = vertex(c[(k + 1) % 3]) - vertex(f.index), e2 = vertex(c[(k + 2) % 3]) - vertex(f.index);
      const Vec3 cross = e1.cross(e2);
      sum += std::atan2(cross.norm(), e1.dot(e2)) * unit_or_zero(cross);
    }
  }
  return unit_or_zero(sum);
}

void SurfaceView::adjacent_normals(const SurfaceFeature& f, std::vector<Vec3>& normals) const {
  normals.clear();
  if (f.kind == Feature::face) {
    normals.push_back(face_normal(f.index));
  } else if (f.kind == Feature::edge) {
    normals.push_back(face_normal(edge(f.index).triangle0));
    if (edge(f.index).triangle1 >= 0) normals.push_back(face_normal(edge(f.index).triangle1));
  } else {
    for (int t : triangles_round(f.index)) normals.push_back(face_normal(t));
  }
}

Vec3 SurfaceView::into_face(int t, int e) const {
  const MeshTopology::Edge& ends = edge(e);
  const Vec3 along = vertex(ends.v1) - vertex(ends.v0);
  for (int v : triangle(t))
    if (v != ends.v0 && v != ends.v1) {
      const Vec3 r = vertex(v) - vertex(ends.v0);
      const double length2 = along.squaredNorm();
      return unit_or_zero(length2 > 0.0 ? Vec3(r - (r.dot(along) / length2) * along) : r);
    }
  return Vec3::Zero();
}

void SurfaceView::star(const SurfaceFeature& f, std::vector<Vec3>& directions) const {
  directions.clear();
  if (f.kind == Feature::vertex) {
    for (int t : triangles_round(f.index))
      for (int v : triangle(t))
        if (v != f.index) directions.push_back(unit_or_zero(vertex(v) - vertex(f.index)));
  } else if (f.kind == Feature::edge) {
    const MeshTopology::Edge& e = edge(f.index);
    const Vec3 along = unit_or_zero(vertex(e.v1) - vertex(e.v0));
    directions.push_back(along);
    directions.push_back(-along);
    directions.push_back(into_face(e.triangle0, f.index));
    if (e.triangle1 >= 0) directions.push_back(into_face(e.triangle1, f.index));
  }
}

}  // namespace impinge
