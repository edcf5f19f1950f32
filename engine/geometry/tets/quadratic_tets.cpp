#include "engine/geometry/tets/quadratic_tets.hpp"

#include <algorithm>
#include <unordered_map>
#include <utility>

namespace impinge {
namespace {

// the part at each corner, in local numbers of the ten nodes: a copy of the whole at half its size
constexpr std::array<std::array<int, 4>, 4> kCornerParts = {{{0, 4, 5, 6}, {4, 1, 7, 8}, {5, 7, 2, 9}, {6, 8, 9, 3}}};
// a diagonal of the octahedron of midpoints, and the four other midpoints in order round it
constexpr std::array<std::array<int, 6>, 3> kDiagonals = {{{4, 9, 5, 6, 8, 7}, {5, 8, 4, 6, 9, 7}, {6, 7, 4, 5, 9, 8}}};

}  // namespace

TetMesh cut_at_midpoints(const TetMesh& mesh) {
  TetMesh cut;
  cut.vertices = mesh.vertices;
  cut.tets.reserve(mesh.tets.size() * kTetParts);
  std::unordered_map<std::uint64_t, int> middle;
  for (const Tet& tet : mesh.tets) {
    QuadraticTet node;
    for (int k = 0; k < 4; ++k) node[k] = tet[k];
    for (int e = 0; e < 6; ++e) {
      const auto [a, b] = std::minmax(tet[kTetEdges[e][0]], tet[kTetEdges[e][1]]);
      const std::uint64_t key = static_cast<std::uint64_t>(a) << 32 | static_cast<std::uint64_t>(b);
      const auto [at, is_new] = middle.try_emplace(key, static_cast<int>(cut.vertices.size()));
      if (is_new) cut.vertices.push_back(0.5 * (mesh.vertices[a] + mesh.vertices[b]));
      node[4 + e] = at->second;
    }
    const auto length = [&](const std::array<int, 6>& d) {
      return (cut.vertices[node[d[0]]] - cut.vertices[node[d[1]]]).squaredNorm();
    };
    const auto add = [&](Tet part) {
      if (tet_volume(cut, part) < 0.0) std::swap(part[2], part[3]);
      cut.tets.push_back(part);
    };
    for (const auto& part : kCornerParts) add({node[part[0]], node[part[1]], node[part[2]], node[part[3]]});
    const auto& inner = *std::min_element(kDiagonals.begin(), kDiagonals.end(),
                                          [&](const auto& l, const auto& r) { return length(l) < length(r); });
    for (int i = 0; i < 4; ++i) add({node[inner[0]], node[inner[1]], node[inner[2 + i]], node[inner[2 + (i + 1) % 4]]});
  }
  return cut;
}

QuadraticTet quadratic_tet(const TetMesh& cut, int tet) {
  const Tet* part = &cut.tets[static_cast<std::size_t>(tet) * kTetParts];
  return {part[0][0], part[1][1], part[2][2], part[3][3], part[0][1],
          part[0][2], part[0][3], part[1][2], part[1][3], part[2][3]};
}

Vec4 quadratic_node_weights(int k) {
  if (k < 4) return Vec4::Unit(k);
  return 0.5 * (Vec4::Unit(kTetEdges[k - 4][0]) + Vec4::Unit(kTetEdges[k - 4][1]));
}

void add_midpoints(const TetMesh& cut, std::vector<int>& nodes) {
  std::vector<char> named(cut.vertices.size(), 0), added(cut.vertices.size(), 0);
  for (const int i : nodes) named[i] = 1;
  const int count = static_cast<int>(cut.tets.size()) / kTetParts;
  for (int t = 0; t < count; ++t) {
    const QuadraticTet node = quadratic_tet(cut, t);
    for (int e = 0; e < 6; ++e)
      if (named[node[kTetEdges[e][0]]] && named[node[kTetEdges[e][1]]]) added[node[4 + e]] = 1;
  }
  for (const int i : nodes) added[i] = 0;
  for (int i = 0; i < static_cast<int>(added.size()); ++i)
    if (added[i]) nodes.push_back(i);
}

}  // namespace impinge
