#include "engine/geometry/mend/skin_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/geometry/aabb.hpp"
#include "engine/geometry/mass_properties.hpp"
#include "engine/geometry/mend/mesh_facts.hpp"
#include "engine/geometry/mend/sheets.hpp"

namespace impinge {
namespace {

constexpr double kMuchVolume = 0.05;  // of it
constexpr int kMostSkinCells = 400;   // that can be asked for

struct Form {
  int parts = 0, genus = 0;
  bool operator==(const Form& other) const = default;
};

/// Of a closed surface: vertices - edges + triangles = 2 parts - 2 handles.
Form form_of(const TriangleMesh& mesh) {
  const MeshTopology topology = make_topology(mesh);
  Form form;
  label_parts(mesh, topology, form.parts);
  long used = 0;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    used += topology.vertex_triangle_begin[v] < topology.vertex_triangle_begin[v + 1] ? 1 : 0;
  const long euler = used - static_cast<long>(topology.edges.size()) + static_cast<long>(mesh.triangles.size());
  form.genus = static_cast<int>((2L * form.parts - euler) / 2);
  return form;
}

/// A cell no wider than half the thinnest wall has the skin's two sides in different ones.
std::string enough_cells(const MeshFacts& facts) {
  if (!facts.thinnest || !(*facts.thinnest > 0.0)) return "take more cells, or none: mend without remesh";
  const double cells = std::ceil(facts.box.extent().maxCoeff() / (0.5 * *facts.thinnest));
  const std::string wall = fmt::format("its thinnest wall of {:.3g} m wants cells half as wide", *facts.thinnest);
  return cells <= kMostSkinCells
             ? fmt::format("{}: remesh {:.0f}", wall, cells)
             : fmt::format("{}, more than the {} along a side that there can be: mend without remesh", wall,
                           kMostSkinCells);
}

}  // namespace

std::optional<SkinFault> skin_fault(const TriangleMesh& surface, const TriangleMesh& skin, int cells) {
  const Form before = form_of(surface), after = form_of(skin);
  double volume = signed_volume(surface);
  const double now = signed_volume(skin);
  const auto much = [&] { return !(std::abs(now - volume) <= kMuchVolume * std::abs(volume)); };
  if (before == after && !much()) return std::nullopt;
  const MeshFacts facts = measure(surface);
  const bool crosses = facts.crossings > 0;
  if (crosses) volume = enclosed_volume(surface).value_or(volume);
  if (crosses && !much()) return std::nullopt;
  std::vector<std::string> changes;
  if (!crosses && after.parts != before.parts)
    changes.push_back(fmt::format("{} part{} instead of {}", after.parts, after.parts == 1 ? "" : "s", before.parts));
  if (!crosses && after.genus != before.genus)
    changes.push_back(fmt::format("genus {} instead of {}", after.genus, before.genus));
  if (much()) changes.push_back(fmt::format("{:+.3g} % of the volume", 100.0 * (now - volume) / volume));
  std::string text = fmt::format("the skin of {} cells is another solid: it has ", cells);
  for (const std::string& change : changes) text += (&change == changes.data() ? "" : ", ") + change;
  return SkinFault{text, enough_cells(facts)};
}

}  // namespace impinge
