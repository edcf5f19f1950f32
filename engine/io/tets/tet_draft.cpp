#include "engine/io/tets/tet_draft.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/core/error.hpp"

namespace impinge {
namespace {

void check_shapes(const TetDraft& draft) {
  const TetMesh& mesh = draft.result.mesh;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const Tet& tet = mesh.tets[t];
    for (int k = 0; k < 4; ++k)
      for (int l = 0; l < k; ++l)
        if (tet[k] == tet[l])
          draft.fail(
              draft.tet_place[t],
              fmt::format("tetrahedron {} names vertex {} twice", draft.tet_label[t], draft.vertex_label[tet[k]]),
              "four different vertices are wanted", "remove it or mesh again");
    const double volume = tet_volume(mesh, tet);
    double longest_sq = 0.0;
    for (const auto& [a, b] : kTetEdges)
      longest_sq = std::max(longest_sq, (mesh.vertices[tet[a]] - mesh.vertices[tet[b]]).squaredNorm());
    // the same bound as check_tet_mesh: below it the inverse of the edges is rounding
    if (volume > 1e-13 * longest_sq * std::sqrt(longest_sq)) continue;
    const bool inverted = volume < -1e-13 * longest_sq * std::sqrt(longest_sq);
    draft.fail(
        draft.tet_place[t],
        fmt::format("tetrahedron {} is {} (volume {:.3g})", draft.tet_label[t], inverted ? "inverted" : "flat", volume),
        "the vertices a, b, c, d need (b - a).((c - a) x (d - a)) > 0",
        inverted ? "exchange two of its vertices or mesh again" : "remove it or mesh again");
  }
}

void check_faces(const TetDraft& draft) {
  struct Face {
    std::array<int, 3> key;
    int tet;
  };
  const TetMesh& mesh = draft.result.mesh;
  std::vector<Face> faces;
  faces.reserve(4 * mesh.tets.size());
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (const auto& side : kTetFaces) {
      Face face{{mesh.tets[t][side[0]], mesh.tets[t][side[1]], mesh.tets[t][side[2]]}, static_cast<int>(t)};
      std::sort(face.key.begin(), face.key.end());
      faces.push_back(face);
    }
  std::sort(faces.begin(), faces.end(),
            [](const Face& a, const Face& b) { return std::tie(a.key, a.tet) < std::tie(b.key, b.tet); });
  // report the one whose third tetrahedron stands first in the file
  int worst = -1;
  for (std::size_t i = 2; i < faces.size(); ++i)
    if (faces[i].key == faces[i - 2].key && (worst < 0 || faces[i].tet < faces[worst].tet)) worst = static_cast<int>(i);
  if (worst < 0) return;
  draft.fail(
      draft.tet_place[faces[worst].tet],
      fmt::format("tetrahedron {} is the third at a face of tetrahedra {} and {}", draft.tet_label[faces[worst].tet],
                  draft.tet_label[faces[worst - 2].tet], draft.tet_label[faces[worst - 1].tet]),
      "at most two may share a face", "remove doubled elements or mesh again");
}

void handle_unused(TetDraft& draft, bool drop) {
  TetMesh& mesh = draft.result.mesh;
  std::vector<int> new_index(mesh.vertices.size(), -1);
  for (const Tet& tet : mesh.tets)
    for (const int v : tet) new_index[v] = 0;
  const auto unused = std::count(new_index.begin(), new_index.end(), -1);
  if (unused == 0) return;
  if (!drop) {
    const auto first = std::find(new_index.begin(), new_index.end(), -1) - new_index.begin();
    draft.fail(draft.vertex_place[first], fmt::format("vertex {} is in no tetrahedron", draft.vertex_label[first]),
               "every vertex must be used", "remove it from the file");
  }
  int next = 0;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (new_index[i] < 0) continue;
    mesh.vertices[next] = mesh.vertices[i];
    new_index[i] = next++;
  }
  mesh.vertices.resize(next);
  for (Tet& tet : mesh.tets)
    for (int& v : tet) v = new_index[v];
  draft.result.notes.push_back(fmt::format("{} vertices in no tetrahedron were dropped", unused));
}

}  // namespace

void TetDraft::fail(const FilePlace& at, const std::string& found, const std::string& allowed,
                    const std::string& remedy) const {
  throw InputError(fmt::format("{}:{}:{}: {}; {}; {}", files.at(at.file), at.line, at.column, found, allowed, remedy));
}

TetFile finish_tets(TetDraft draft, bool drop_unused) {
  check_shapes(draft);
  check_faces(draft);
  handle_unused(draft, drop_unused);
  const int parts = component_count(draft.result.mesh);
  if (parts > 1) draft.result.notes.push_back(fmt::format("the mesh has {} parts that share no vertex", parts));
  draft.result.files = draft.files;
  return std::move(draft.result);
}

}  // namespace impinge
