#include "viewer/draw/tet_shapes.hpp"

#include <algorithm>

namespace impinge {
namespace {

using Edge = std::array<int, 2>;

Edge sorted(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

void keep_each_once(std::vector<Edge>& edges) {
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
}

}  // namespace

TetEdges make_tet_edges(const TetMesh& mesh) {
  TetEdges out;
  std::vector<Edge> all;
  for (const Tet& tet : mesh.tets)
    for (const auto& [a, b] : kTetEdges) all.push_back(sorted(tet[a], tet[b]));
  for (const Triangle& t : boundary_triangles(mesh))
    for (int k = 0; k < 3; ++k) out.outer.push_back(sorted(t[k], t[(k + 1) % 3]));
  keep_each_once(all);
  keep_each_once(out.outer);
  std::set_difference(all.begin(), all.end(), out.outer.begin(), out.outer.end(), std::back_inserter(out.inner));
  return out;
}

ShadedSurface shrunk_tets(const TetMesh& mesh, const VecX& positions, std::span<const int> which, double factor,
                          const Vec3& origin) {
  ShadedSurface out;
  out.positions.reserve(12 * which.size());
  out.normals.reserve(12 * which.size());
  out.triangles.reserve(4 * which.size());
  for (const int t : which) {
    std::array<Vec3, 4> corner;
    Vec3 center = Vec3::Zero();
    for (int k = 0; k < 4; ++k) {
      corner[k] = positions.segment<3>(3 * mesh.tets[t][k]) - origin;
      center += 0.25 * corner[k];
    }
    const bool everted = tet_volume(corner[0], corner[1], corner[2], corner[3]) < 0.0;
    for (Vec3& c : corner) c = center + factor * (c - center);
    for (const auto& face : kTetFaces) {
      const Vec3 &a = corner[face[0]], &b = corner[face[everted ? 2 : 1]], &c = corner[face[everted ? 1 : 2]];
      const Vec3 area = (b - a).cross(c - a);
      const Eigen::Vector3f normal = (area.norm() > 0.0 ? Vec3(area.normalized()) : Vec3::UnitY()).cast<float>();
      const auto first = static_cast<std::uint32_t>(out.positions.size());
      for (const Vec3& p : {a, b, c}) {
        out.positions.push_back(p.cast<float>());
        out.normals.push_back(normal);
        out.bounds.extend(out.positions.back());
      }
      out.triangles.push_back({first, first + 1, first + 2});
    }
  }
  out.solid = true;
  return out;
}

}  // namespace impinge
