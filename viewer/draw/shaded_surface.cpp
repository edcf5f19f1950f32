#include "viewer/draw/shaded_surface.hpp"

#include <cmath>

#include "engine/geometry/mass_properties.hpp"

namespace impinge {

ShadedSurface make_shaded_surface(const TriangleMesh& mesh, const MeshTopology& topology, double crease_deg) {
  const double cosine = std::cos(crease_deg * M_PI / 180.0);
  std::vector<Vec3> areas, units;  // of every triangle: area-weighted and unit normal
  for (const Triangle& t : mesh.triangles) {
    const Vec3 n = (mesh.vertices[t[1]] - mesh.vertices[t[0]]).cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]);
    areas.push_back(n);
    units.push_back(n.norm() > 0.0 ? Vec3(n.normalized()) : Vec3::Zero());
  }
  ShadedSurface out;
  out.triangles.resize(mesh.triangles.size());
  std::vector<std::uint32_t> first_of(mesh.vertices.size(), 0);  // of the positions that a source vertex became
  for (std::size_t v = 0; v + 1 < topology.vertex_triangle_begin.size(); ++v) {
    const int begin = topology.vertex_triangle_begin[v], end = topology.vertex_triangle_begin[v + 1];
    const std::size_t first = out.positions.size();
    first_of[v] = static_cast<std::uint32_t>(first);
    for (int i = begin; i < end; ++i) {
      const int own = topology.vertex_triangles[i];
      Vec3 sum = Vec3::Zero();
      for (int k = begin; k < end; ++k) {
        const int other = topology.vertex_triangles[k];
        if (other == own || units[own].dot(units[other]) > cosine) sum += areas[other];
      }
      const Eigen::Vector3f normal = (sum.norm() > 0.0 ? Vec3(sum.normalized()) : Vec3::UnitY()).cast<float>();
      // the sums run in one order, so corners that share their neighbours get the same bits and become one vertex
      std::size_t index = first;
      while (index < out.positions.size() && out.normals[index] != normal) ++index;
      if (index == out.positions.size()) {
        out.positions.push_back(mesh.vertices[v].cast<float>());
        out.normals.push_back(normal);
        out.source.push_back(static_cast<std::uint32_t>(v));
      }
      for (int corner = 0; corner < 3; ++corner)
        if (mesh.triangles[own][corner] == static_cast<int>(v))
          out.triangles[own][corner] = static_cast<std::uint32_t>(index);
    }
  }
  for (const MeshTopology::Edge& edge : topology.edges) out.edges.push_back({first_of[edge.v0], first_of[edge.v1]});
  for (const Eigen::Vector3f& p : out.positions) out.bounds.extend(p);
  out.solid = topology.is_closed() && signed_volume(mesh) > 0.0;
  return out;
}

}  // namespace impinge
