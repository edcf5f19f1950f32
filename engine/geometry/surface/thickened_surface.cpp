#include "engine/geometry/surface/thickened_surface.hpp"

#include <algorithm>
#include <cmath>

#include "engine/geometry/disjoint_sets.hpp"

namespace impinge {
namespace {

constexpr double kBothOfEdge = 1e-3, kFrontOfEdge = 0.5;
// cosine between a vertex's normal and a face's below which the fold is too sharp to keep the distance from the face
constexpr double kSharp = 0.5;

/// Whether the triangle runs along the edge from its smaller vertex to its larger.
bool runs_up(const Triangle& t, const MeshTopology::Edge& edge) { return runs_along(t, edge.v0, edge.v1); }

/// Edges that two triangles and no third share.
std::vector<char> inner_edges(const MeshTopology& topology) {
  std::vector<char> inner;
  for (const int uses : edge_uses(topology)) inner.push_back(uses == 2 ? 1 : 0);
  return inner;
}

/// Turns neighbours alike from one triangle to the next; an edge whose triangles can't be is no inner one any more.
void orient(std::vector<Triangle>& triangles, const MeshTopology& topology, std::vector<char>& inner) {
  std::vector<char> known(triangles.size(), 0);
  std::vector<int> waiting;
  for (std::size_t first = 0; first < triangles.size(); ++first) {
    if (known[first] != 0) continue;
    known[first] = 1;
    waiting.push_back(static_cast<int>(first));
    while (!waiting.empty()) {
      const int t = waiting.back();
      waiting.pop_back();
      for (const int e : topology.triangle_edges[t]) {
        const MeshTopology::Edge& edge = topology.edges[e];
        if (inner[e] == 0) continue;
        const int other = edge.triangle0 == t ? edge.triangle1 : edge.triangle0;
        const bool alike = runs_up(triangles[t], edge) != runs_up(triangles[other], edge);
        if (known[other] != 0) {
          if (!alike) inner[e] = 0;
          continue;
        }
        if (!alike) std::swap(triangles[other][1], triangles[other][2]);
        known[other] = 1;
        waiting.push_back(other);
      }
    }
  }
}

int corner_at(const std::vector<Triangle>& triangles, int t, int vertex) {
  for (int k = 0; k < 3; ++k)
    if (triangles[t][k] == vertex) return 3 * t + k;
  return 3 * t;
}

/// The surface cut where it is no sheet: vertices of its own for each fan of triangles.
TriangleMesh sheets_of(const TriangleMesh& mesh, bool may_turn) {
  const MeshTopology topology = make_topology(mesh);
  std::vector<char> inner = inner_edges(topology);
  std::vector<Triangle> triangles = mesh.triangles;
  if (may_turn) orient(triangles, topology, inner);
  DisjointSets corners(3 * triangles.size());  // joined where they are one vertex of one sheet
  for (std::size_t e = 0; e < inner.size(); ++e) {
    if (inner[e] == 0) continue;
    const MeshTopology::Edge& edge = topology.edges[e];
    for (const int v : {edge.v0, edge.v1})
      corners.join(corner_at(triangles, edge.triangle0, v), corner_at(triangles, edge.triangle1, v));
  }
  TriangleMesh sheets;
  sheets.triangles = triangles;
  std::vector<int> vertex_of(3 * triangles.size(), -1);
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      int& vertex = vertex_of[corners.root(static_cast<int>(3 * t) + k)];
      if (vertex < 0) {
        vertex = static_cast<int>(sheets.vertices.size());
        sheets.vertices.push_back(mesh.vertices[triangles[t][k]]);
      }
      sheets.triangles[t][k] = vertex;
    }
  return sheets;
}

/// By vertex, how it moves for a unit of thickness.
std::vector<Vec3> outward_moves(const TriangleMesh& mesh) {
  std::vector<Vec3> moves(mesh.vertices.size(), Vec3::Zero());
  std::vector<Vec3> face_normals;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 n = (mesh.vertices[t[1]] - mesh.vertices[t[0]]).cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]);
    const double area = n.norm();
    face_normals.push_back(area > 0.0 ? Vec3(n / area) : Vec3(Vec3::Zero()));
    for (int k = 0; k < 3; ++k) {
      const Vec3 e1 = mesh.vertices[t[(k + 1) % 3]] - mesh.vertices[t[k]],
                 e2 = mesh.vertices[t[(k + 2) % 3]] - mesh.vertices[t[k]];
      moves[t[k]] += std::atan2(e1.cross(e2).norm(), e1.dot(e2)) * face_normals.back();  // by angle [Baerentzen05]
    }
  }
  for (Vec3& m : moves) {
    const double length = m.norm();
    m = length > 0.0 ? Vec3(m / length) : Vec3(Vec3::UnitY());
  }
  std::vector<double> cosine(moves.size(), 1.0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const int v : mesh.triangles[t])
      if (!face_normals[t].isZero(0.0)) cosine[v] = std::min(cosine[v], moves[v].dot(face_normals[t]));
  for (std::size_t v = 0; v < moves.size(); ++v) moves[v] /= std::max(cosine[v], kSharp);
  return moves;
}

}  // namespace

double ThinSurface::thickness_of(const TriangleMesh& mesh) const {
  return thickness.value_or((sides == SurfaceSides::both ? kBothOfEdge : kFrontOfEdge) * mean_edge_length(mesh));
}

TriangleMesh thickened(const TriangleMesh& mesh, const ThinSurface& how) {
  const double thickness = how.thickness_of(mesh);
  const double to_front = how.sides == SurfaceSides::both ? 0.5 * thickness : 0.0;
  const TriangleMesh sheets = sheets_of(mesh, how.sides == SurfaceSides::both);
  const std::vector<Vec3> moves = outward_moves(sheets);
  const int count = static_cast<int>(sheets.vertices.size());
  TriangleMesh solid;
  for (int v = 0; v < count; ++v) solid.vertices.emplace_back(sheets.vertices[v] + to_front * moves[v]);
  for (int v = 0; v < count; ++v) solid.vertices.emplace_back(sheets.vertices[v] - (thickness - to_front) * moves[v]);
  solid.triangles = sheets.triangles;
  for (const Triangle& t : sheets.triangles) solid.triangles.push_back({count + t[0], count + t[2], count + t[1]});
  const MeshTopology topology = make_topology(sheets);
  for (const MeshTopology::Edge& edge : topology.edges) {
    if (edge.triangle1 >= 0) continue;
    const bool up = runs_up(sheets.triangles[edge.triangle0], edge);
    const int from = up ? edge.v0 : edge.v1, to = up ? edge.v1 : edge.v0;
    solid.triangles.push_back({to, from, count + from});
    solid.triangles.push_back({to, count + from, count + to});
  }
  return solid;
}

}  // namespace impinge
