#include "engine/geometry/convex/convex_polyhedron.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "engine/geometry/convex/orientation.hpp"

namespace impinge {
namespace {

constexpr double kCoplanar = 1e-12, kRestingPlane = 1e-7;  // of the size
constexpr int kMostRing = 16;
constexpr std::size_t kFewVertices = 32;  // up to here looking at all is quicker than climbing

Vec3 triangle_cross(const TriangleMesh& mesh, const Triangle& t) {
  return accurate_cross(mesh.vertices[t[1]] - mesh.vertices[t[0]], mesh.vertices[t[2]] - mesh.vertices[t[0]]);
}

/// The corners of the convex hull of points in a plane, counter-clockwise, as indices into `points`; corners that
/// stand out by less than `flat` metres are left out.
std::vector<int> hull_in_plane(const std::vector<Vec2>& points, double flat) {
  std::vector<int> order(points.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  std::sort(order.begin(), order.end(), [&](int l, int r) {
    return std::tuple(points[l].x(), points[l].y(), l) < std::tuple(points[r].x(), points[r].y(), r);
  });
  const auto stands_out = [&](int a, int b, int c) {  // b beyond the line from a to c, seen on its right
    const Vec2 along = points[c] - points[a], r = points[b] - points[a];
    return along.x() * r.y() - along.y() * r.x() < -flat * along.norm();
  };
  std::vector<int> ring;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t begin = ring.size();
    for (int p : order) {
      while (ring.size() >= begin + 2 && !stands_out(ring[ring.size() - 2], ring.back(), p)) ring.pop_back();
      ring.push_back(p);
    }
    ring.pop_back();
    std::reverse(order.begin(), order.end());
  }
  return ring;
}

/// Of a ring with too many corners those farthest out in so many directions.
std::vector<int> thinned(const std::vector<Vec2>& points, const std::vector<int>& ring) {
  if (ring.size() <= kMostRing) return ring;
  std::vector<char> kept(ring.size(), 0);
  for (int k = 0; k < kMostRing; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / kMostRing;
    const Vec2 direction(std::cos(angle), std::sin(angle));
    std::size_t best = 0;
    for (std::size_t i = 1; i < ring.size(); ++i)
      if (direction.dot(points[ring[i]]) > direction.dot(points[ring[best]])) best = i;
    kept[best] = 1;
  }
  std::vector<int> result;
  for (std::size_t i = 0; i < ring.size(); ++i)
    if (kept[i] != 0) result.push_back(ring[i]);
  return result;
}

}  // namespace

ConvexPolyhedron::ConvexPolyhedron(TriangleMesh surface)
    : surface_(make_surface(std::move(surface))), mesh_(surface_->mesh), topology_(surface_->topology) {
  Vec3 low = mesh_.vertices[0], high = mesh_.vertices[0];
  for (const Vec3& v : mesh_.vertices) low = low.cwiseMin(v), high = high.cwiseMax(v);
  size_ = (high - low).norm();
  find_faces();
  find_neighbours();
  find_resting_rings();
  for (int k = 0; k < 6; ++k) {
    const double sign = k % 2 == 0 ? 1.0 : -1.0;
    for (std::size_t v = 1; v < mesh_.vertices.size(); ++v)
      if (sign * mesh_.vertices[v][k / 2] > sign * mesh_.vertices[extreme_[k]][k / 2])
        extreme_[k] = static_cast<int>(v);
  }
}

ConvexPolyhedron::Rows ConvexPolyhedron::make_rows(int count, const std::vector<std::pair<int, int>>& entries) {
  Rows rows;
  rows.begin.assign(count + 1, 0);
  for (const auto& [r, item] : entries) ++rows.begin[r + 1];
  for (int i = 0; i < count; ++i) rows.begin[i + 1] += rows.begin[i];
  rows.item.resize(entries.size());
  std::vector<int> next = rows.begin;
  for (const auto& [r, item] : entries) rows.item[next[r]++] = item;
  return rows;
}

void ConvexPolyhedron::find_faces() {
  const int count = static_cast<int>(mesh_.triangles.size());
  std::vector<double> area(count);
  std::vector<int> order(count);
  for (int t = 0; t < count; ++t) area[t] = triangle_cross(mesh_, mesh_.triangles[t]).norm(), order[t] = t;
  // the largest triangle gives the plane: slivers beside it have none of their own
  std::stable_sort(order.begin(), order.end(), [&](int l, int r) { return area[l] > area[r]; });
  face_of_triangle_.assign(count, -1);
  for (int start : order) {
    if (face_of_triangle_[start] >= 0) continue;
    const int number = static_cast<int>(faces_.size());
    Face face;
    face.normal = triangle_cross(mesh_, mesh_.triangles[start]).normalized();
    face.offset = face.normal.dot(mesh_.vertices[mesh_.triangles[start][0]]);
    const double plane = face.offset;
    std::vector<int> members{start};
    face_of_triangle_[start] = number;
    for (std::size_t i = 0; i < members.size(); ++i) {
      for (int v : mesh_.triangles[members[i]]) face.offset = std::max(face.offset, face.normal.dot(mesh_.vertices[v]));
      for (int e : topology_.triangle_edges[members[i]]) {
        const MeshTopology::Edge& edge = topology_.edges[e];
        const int next = edge.triangle0 == members[i] ? edge.triangle1 : edge.triangle0;
        if (next < 0 || face_of_triangle_[next] >= 0) continue;
        const Triangle& corners = mesh_.triangles[next];
        if (std::any_of(corners.begin(), corners.end(), [&](int v) {
              return std::abs(face.normal.dot(mesh_.vertices[v]) - plane) > kCoplanar * size_;
            }))
          continue;
        face_of_triangle_[next] = number;
        members.push_back(next);
      }
    }
    faces_.push_back(face);
  }
}

void ConvexPolyhedron::find_neighbours() {
  const int count = static_cast<int>(mesh_.vertices.size());
  std::vector<std::pair<int, int>> faces, edges, vertices;
  for (const MeshTopology::Edge& e : topology_.edges) {
    vertices.emplace_back(e.v0, e.v1);
    vertices.emplace_back(e.v1, e.v0);
    int face0 = face_of_triangle_[e.triangle0], face1 = face_of_triangle_[e.triangle1];
    if (face0 == face1) continue;
    const Triangle& t = mesh_.triangles[e.triangle0];
    const int place = static_cast<int>(std::find(t.begin(), t.end(), e.v0) - t.begin());
    if (t[(place + 1) % 3] != e.v1) std::swap(face0, face1);
    edges.emplace_back(e.v0, static_cast<int>(edges_.size()));
    edges.emplace_back(e.v1, static_cast<int>(edges_.size()));
    edges_.push_back({e.v0, e.v1, face0, face1});
  }
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
    for (int v : mesh_.triangles[t]) faces.emplace_back(v, face_of_triangle_[t]);
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  vertex_faces_ = make_rows(count, faces);
  vertex_edges_ = make_rows(count, edges);
  vertex_vertices_ = make_rows(count, vertices);
}

void ConvexPolyhedron::find_resting_rings() {
  std::map<std::pair<int, int>, int> sides;
  rings_.begin = {0};
  std::vector<int> seen(mesh_.triangles.size(), -1);
  std::vector<int> start(faces_.size(), -1);
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
    if (start[face_of_triangle_[t]] < 0) start[face_of_triangle_[t]] = static_cast<int>(t);
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    const Face& face = faces_[f];
    const auto lies_in = [&](int v) {
      return face.normal.dot(mesh_.vertices[v]) >= face.offset - kRestingPlane * size_;
    };
    std::vector<int> members{start[f]}, corners;
    seen[start[f]] = static_cast<int>(f);
    for (std::size_t i = 0; i < members.size(); ++i) {
      const Triangle& triangle = mesh_.triangles[members[i]];
      corners.insert(corners.end(), triangle.begin(), triangle.end());
      for (int e : topology_.triangle_edges[members[i]]) {
        const MeshTopology::Edge& edge = topology_.edges[e];
        const int next = edge.triangle0 == members[i] ? edge.triangle1 : edge.triangle0;
        const Triangle& others = mesh_.triangles[next];
        if (seen[next] == static_cast<int>(f) || !std::all_of(others.begin(), others.end(), lies_in)) continue;
        seen[next] = static_cast<int>(f);
        members.push_back(next);
      }
    }
    std::sort(corners.begin(), corners.end());
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    const Vec3 u = face.normal.unitOrthogonal(), v = face.normal.cross(u);
    std::vector<Vec2> flat;
    flat.reserve(corners.size());
    for (int c : corners) flat.emplace_back(u.dot(mesh_.vertices[c]), v.dot(mesh_.vertices[c]));
    const std::vector<int> ring = thinned(flat, hull_in_plane(flat, kCoplanar * size_));
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const int a = corners[ring[i]], b = corners[ring[(i + 1) % ring.size()]];
      rings_.item.push_back(a);
      ring_sides_.push_back(sides.try_emplace(std::minmax(a, b), static_cast<int>(sides.size())).first->second);
    }
    rings_.begin.push_back(static_cast<int>(rings_.item.size()));
  }
}

int ConvexPolyhedron::support_vertex(const Vec3& direction) const {
  const std::vector<Vec3>& vertex = mesh_.vertices;
  if (vertex.size() <= kFewVertices) {
    int best = 0;
    double most = direction.dot(vertex[0]);
    for (std::size_t v = 1; v < vertex.size(); ++v)
      if (const double along = direction.dot(vertex[v]); along > most) most = along, best = static_cast<int>(v);
    return best;
  }
  int best = extreme_[0];
  double most = direction.dot(vertex[best]);
  for (int v : extreme_)
    if (const double along = direction.dot(vertex[v]); along > most) most = along, best = v;
  // on a convex surface a corner that no neighbour exceeds is the farthest of all
  for (int from = -1; from != best;) {
    from = best;
    for (int v : row(vertex_vertices_, from))
      if (const double along = direction.dot(vertex[v]); along > most) most = along, best = v;
  }
  return best;
}

int ConvexPolyhedron::face_facing(const Vec3& direction) const {
  int best = 0;
  double most = -2.0;
  for (std::size_t f = 0; f < faces_.size(); ++f)
    // strictly better by more than rounding: of equal faces the first, in every step
    if (const double along = faces_[f].normal.dot(direction); along > most + 1e-9)
      most = along, best = static_cast<int>(f);
  return best;
}

ContactFace ConvexPolyhedron::facing(const Vec3& direction) const {
  const int best = face_facing(direction);
  ContactFace face;
  face.face = best;
  face.normal = faces_[best].normal;
  for (int i = rings_.begin[best]; i < rings_.begin[best + 1]; ++i)
    face.add(mesh_.vertices[rings_.item[i]], rings_.item[i], ring_sides_[i]);
  return face;
}

}  // namespace impinge
