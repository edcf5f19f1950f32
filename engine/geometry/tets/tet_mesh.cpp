#include "engine/geometry/tets/tet_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/geometry/disjoint_sets.hpp"

namespace impinge {
namespace {

struct Face {
  std::array<int, 3> key;  // sorted corners: what two faces have in common
  int tet, side;
};

/// All faces, sorted so that equal ones are neighbours and, among them, in order of tetrahedra.
std::vector<Face> sorted_faces(const TetMesh& mesh) {
  std::vector<Face> faces;
  faces.reserve(4 * mesh.tets.size());
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (int k = 0; k < 4; ++k) {
      Face face{{}, static_cast<int>(t), k};
      for (int i = 0; i < 3; ++i) face.key[i] = mesh.tets[t][kTetFaces[k][i]];
      std::sort(face.key.begin(), face.key.end());
      faces.push_back(face);
    }
  std::sort(faces.begin(), faces.end(),
            [](const Face& a, const Face& b) { return std::tie(a.key, a.tet) < std::tie(b.key, b.tet); });
  return faces;
}

std::vector<Vec3> grid_points(const Vec3& size, int nx, int ny, int nz) {
  std::vector<Vec3> points;
  for (int k = 0; k <= nz; ++k)
    for (int j = 0; j <= ny; ++j)
      for (int i = 0; i <= nx; ++i) points.emplace_back(size.x() * i / nx, size.y() * j / ny, size.z() * k / nz);
  return points;
}

}  // namespace

double tet_volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return (b - a).dot((c - a).cross(d - a)) / 6.0;
}

double tet_volume(const TetMesh& mesh, const Tet& tet) {
  return tet_volume(mesh.vertices[tet[0]], mesh.vertices[tet[1]], mesh.vertices[tet[2]], mesh.vertices[tet[3]]);
}

double total_volume(const TetMesh& mesh) {
  double sum = 0.0;
  for (const Tet& tet : mesh.tets) sum += tet_volume(mesh, tet);
  return sum;
}

std::vector<Triangle> boundary_triangles(const TetMesh& mesh) {
  const std::vector<Face> faces = sorted_faces(mesh);
  std::vector<Face> single;
  for (std::size_t i = 0; i < faces.size();) {
    std::size_t end = i + 1;
    while (end < faces.size() && faces[end].key == faces[i].key) ++end;
    if (end == i + 1) single.push_back(faces[i]);
    i = end;
  }
  std::sort(single.begin(), single.end(),
            [](const Face& a, const Face& b) { return std::tie(a.tet, a.side) < std::tie(b.tet, b.side); });
  std::vector<Triangle> triangles;
  triangles.reserve(single.size());
  for (const Face& face : single) {
    const Tet& tet = mesh.tets[face.tet];
    const std::array<int, 3>& corner = kTetFaces[face.side];
    triangles.push_back({tet[corner[0]], tet[corner[1]], tet[corner[2]]});
  }
  return triangles;
}

std::optional<std::string> check_tet_mesh(const TetMesh& mesh, int tet_base) {
  if (mesh.tets.empty()) return "has no tetrahedra; at least one is needed; export the volume mesh again";
  const int vertices = static_cast<int>(mesh.vertices.size());
  for (int i = 0; i < vertices; ++i)
    if (!mesh.vertices[i].allFinite())
      return fmt::format("has a coordinate that is not finite at vertex {}; finite numbers are wanted; export it again",
                         i + tet_base);
  std::vector<char> used(mesh.vertices.size(), 0);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const Tet& tet = mesh.tets[t];
    for (int k = 0; k < 4; ++k) {
      if (tet[k] < 0 || tet[k] >= vertices)
        return fmt::format("names vertex {} in tetrahedron {}; there are vertices {} to {}; export it again",
                           tet[k] + tet_base, t + tet_base, tet_base, vertices - 1 + tet_base);
      for (int l = 0; l < k; ++l)
        if (tet[k] == tet[l])
          return fmt::format(
              "names vertex {} twice in tetrahedron {}; four different ones are wanted; remove the tetrahedron",
              tet[k] + tet_base, t + tet_base);
      used[tet[k]] = 1;
    }
    const double volume = tet_volume(mesh, tet);
    double longest_sq = 0.0;
    for (const auto& [a, b] : kTetEdges)
      longest_sq = std::max(longest_sq, (mesh.vertices[tet[a]] - mesh.vertices[tet[b]]).squaredNorm());
    // a sliver this flat has a height of a millionth of a millionth of its longest edge: the inverse of its edges means
    // nothing
    if (!(volume > 1e-13 * longest_sq * std::sqrt(longest_sq)))
      return fmt::format("has {} tetrahedron {} (volume {} m³); positive volumes are wanted; mesh it again",
                         volume < 0.0 ? "the inverted" : "the flat", t + tet_base, volume);
  }
  const std::vector<Face> faces = sorted_faces(mesh);
  for (std::size_t i = 2; i < faces.size(); ++i)
    if (faces[i].key == faces[i - 2].key)
      return fmt::format("has a face shared by tetrahedra {}, {} and {}; at most two may meet there; mesh it again",
                         faces[i - 2].tet + tet_base, faces[i - 1].tet + tet_base, faces[i].tet + tet_base);
  for (int i = 0; i < vertices; ++i)
    if (!used[i])
      return fmt::format("has vertex {} in no tetrahedron; every vertex must be used; remove it", i + tet_base);
  return std::nullopt;
}

int component_count(const TetMesh& mesh) {
  DisjointSets components(mesh.vertices.size());
  std::vector<char> used(mesh.vertices.size(), 0);
  for (const Tet& tet : mesh.tets)
    for (const int v : tet) {
      used[v] = 1;
      components.join(v, tet[0]);
    }
  int count = 0;
  for (int i = 0; i < static_cast<int>(used.size()); ++i) count += used[i] && components.root(i) == i;
  return count;
}

TetMesh make_tet_box(const Vec3& size, int nx, int ny, int nz) {
  // the six orders in which a path from corner to corner can take the axes, with the parity that decides the
  // orientation
  static constexpr std::array<std::array<int, 3>, 6> kPaths = {
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
  TetMesh mesh;
  const auto index = [&](const std::array<int, 3>& p) { return (p[2] * (ny + 1) + p[1]) * (nx + 1) + p[0]; };
  mesh.vertices = grid_points(size, nx, ny, nz);
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i)
        for (int path = 0; path < 6; ++path) {
          std::array<int, 3> p = {i, j, k};
          Tet tet;
          tet[0] = index(p);
          for (int step = 0; step < 3; ++step) {
            ++p[kPaths[path][step]];
            tet[step + 1] = index(p);
          }
          if (path >= 3) std::swap(tet[1], tet[2]);
          mesh.tets.push_back(tet);
        }
  return mesh;
}

TetMesh make_alternating_box(const Vec3& size, int nx, int ny, int nz) {
  TetMesh mesh;
  mesh.vertices = grid_points(size, nx, ny, nz);
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        const auto corner = [&](int x, int y, int z) { return ((k + z) * (ny + 1) + j + y) * (nx + 1) + i + x; };
        const auto add = [&](Tet tet) {
          if (tet_volume(mesh, tet) < 0.0) std::swap(tet[2], tet[3]);
          mesh.tets.push_back(tet);
        };
        // the middle one has the corners of even index sum, so that cells agree on the diagonals of their faces
        const int odd = (i + j + k) % 2;
        const auto flip = [&](int x, int y, int z) { return odd == 0 ? corner(x, y, z) : corner(1 - x, y, z); };
        const int a = flip(0, 0, 0), b = flip(1, 1, 0), c = flip(1, 0, 1), d = flip(0, 1, 1);
        add({a, b, c, d});
        add({flip(1, 0, 0), a, b, c});
        add({flip(0, 1, 0), a, b, d});
        add({flip(0, 0, 1), a, c, d});
        add({flip(1, 1, 1), b, c, d});
      }
  return mesh;
}

double smallest_dihedral_angle(const TetMesh& mesh, const Tet& tet) {
  double largest_cosine = -1.0;
  std::array<Vec3, 4> normal;  // outward, of the face opposite corner k
  for (int k = 0; k < 4; ++k) {
    const Vec3& p = mesh.vertices[tet[kTetFaces[k][0]]];
    normal[k] = (mesh.vertices[tet[kTetFaces[k][1]]] - p).cross(mesh.vertices[tet[kTetFaces[k][2]]] - p).normalized();
  }
  for (const auto& [a, b] : kTetEdges) largest_cosine = std::max(largest_cosine, -normal[a].dot(normal[b]));
  return std::acos(std::min(1.0, largest_cosine)) * 180.0 / std::numbers::pi;
}

double smallest_dihedral_angle(const TetMesh& mesh) {
  double smallest = 180.0;
  for (const Tet& tet : mesh.tets) smallest = std::min(smallest, smallest_dihedral_angle(mesh, tet));
  return smallest;
}

}  // namespace impinge
