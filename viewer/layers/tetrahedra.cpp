// The tetrahedra of deformable bodies: their edges, or small solids with gaps between them. Those turned inside out are
// red. Where the view is cut, whole tetrahedra are left out.
#include <algorithm>

#include "viewer/layers/body_style.hpp"
#include "viewer/layers/heat_map.hpp"
#include "viewer/layers/layer.hpp"

namespace impinge {
namespace {

struct TetrahedraSettings {
  enum class Style { wire, shrunk } style = Style::wire;
  double shrink = 0.75;

  void declare(const Rows& rows) {
    rows.add("style", style, {{Style::wire, "wire"}, {Style::shrunk, "shrunk"}},
             "Tetrahedra as edges, or as solids with gaps between them inside a see-through surface.");
    rows.add("shrink", shrink, {0.05, 1.0}, "", "Size of a solid tetrahedron as a share of its true size.");
  }
};

Vec3 node(const DeformableBody& body, int i) { return body.position.segment<3>(3 * i); }

Vec3 center(const DeformableBody& body, const Tet& tet) {
  return 0.25 * (node(body, tet[0]) + node(body, tet[1]) + node(body, tet[2]) + node(body, tet[3]));
}

bool is_everted(const DeformableBody& body, const Tet& tet) {
  return tet_volume(node(body, tet[0]), node(body, tet[1]), node(body, tet[2]), node(body, tet[3])) <= 0.0;
}

void draw_edges(const LayerContext& context, DrawList& list, std::size_t index, Color color) {
  const DeformableBody& body = *context.record.bodies[index].deformable;
  const ClipPlane& clip = context.settings.clip;
  const float width = 0.8f * static_cast<float>(context.settings.line_width);
  const PickId pick = body_pick(index);
  const auto draw = [&](const std::array<int, 2>& edge, Color ink, float scale) {
    const Vec3 a = node(body, edge[0]), b = node(body, edge[1]);
    if (!clip.removes(a) && !clip.removes(b)) list.lines.push_back({a, b, ink, scale * width, Depth::tested, pick});
  };
  const TetEdges& edges = context.surfaces.edges_of(body.fem);
  for (const auto& edge : edges.inner) draw(edge, with_alpha(color, 0.35f), 0.8f);
  for (const auto& edge : edges.outer) draw(edge, with_alpha(color, 0.9f), 1.0f);
  for (const Tet& tet : body.fem.rest().tets)
    if (is_everted(body, tet))
      for (const auto& [a, b] : kTetEdges)
        list.lines.push_back({node(body, tet[a]), node(body, tet[b]), role::kOverlap, 1.6f * width, Depth::both, pick});
}

/// By the heat layer: a colour for each tetrahedron, at its centre.
SurfaceHeat heat_of_solids(const LayerContext& context, DrawList& list, std::size_t index,
                           const std::vector<int>& which) {
  const DeformableBody& body = *context.record.bodies[index].deformable;
  std::vector<Vec3> centers, velocities;
  for (const int t : which) {
    const Tet& tet = body.fem.rest().tets[static_cast<std::size_t>(t)];
    centers.push_back(center(body, tet));
    Vec3& v = velocities.emplace_back(Vec3::Zero());
    for (int k = 0; k < 4; ++k) v += 0.25 * body.velocity.segment<3>(3 * tet[k]);
  }
  const std::vector<float> values = heat_at(context, list, index, centers, velocities);
  if (values.empty()) return nullptr;
  auto heat = std::make_shared<std::vector<float>>();
  for (const float v : values) heat->insert(heat->end(), 12, v);
  return heat;
}

void draw_solids(const LayerContext& context, DrawList& list, std::size_t index, Color color) {
  const BodyRecord& record = context.record.bodies[index];
  const DeformableBody& body = *record.deformable;
  const TetMesh& mesh = body.fem.rest();
  std::vector<int> upright, everted;
  for (int t = 0; t < static_cast<int>(mesh.tets.size()); ++t) {
    const Tet& tet = mesh.tets[static_cast<std::size_t>(t)];
    if (context.settings.clip.removes(center(body, tet))) continue;
    (is_everted(body, tet) ? everted : upright).push_back(t);
  }
  for (DrawSurface& item : list.surfaces)
    if (item.pick == body_pick(index)) item.see_through = true, item.heat = nullptr;
  const Vec3 origin = record.bounds.is_empty() ? body.center_of_mass() : record.bounds.center();
  const auto add = [&](const std::vector<int>& which, Color ink) -> DrawSurface& {
    auto solids = std::make_shared<ShadedSurface>(
        shrunk_tets(mesh, body.position, which, context.own<TetrahedraSettings>().shrink, origin));
    DrawSurface item{std::move(solids), {Mat3::Identity(), origin}, ink, false, false, body_pick(index)};
    item.clipped = false;
    list.surfaces.push_back(std::move(item));
    return list.surfaces.back();
  };
  if (!everted.empty()) add(everted, role::kOverlap);
  DrawSurface& solids = add(upright, color);
  if (context.settings.is_on("heat")) {
    grey_out(context, solids);
    solids.heat = heat_of_solids(context, list, index, upright);
    return;
  }
  if (const auto quantity = heat_shown(context.settings)) {
    ColorBar bar = heat_bar(*quantity, heat_scale(context.record, context.settings, *quantity), ColorMap::dusk);
    const std::vector<double> values = heat_of_elements(body, *quantity);
    auto heat = std::make_shared<std::vector<float>>();
    for (const int t : upright) heat->insert(heat->end(), 12, bar.place(values[static_cast<std::size_t>(t)]));
    if (!list.color_bars.empty()) {
      list.color_bars.front().exceeded |= bar.exceeded;
      list.color_bars.front().below |= bar.below;
    }
    solids.heat = std::move(heat);
  }
}

void draw_tetrahedra(const LayerContext& context, DrawList& list) {
  const std::vector<Color> colors = body_colors(context.record, context.settings.colors);
  const bool wire = context.own<TetrahedraSettings>().style == TetrahedraSettings::Style::wire;
  const bool over_surfaces = context.settings.is_on("meshes");
  for (std::size_t i = 0; i < context.record.bodies.size(); ++i) {
    if (context.record.bodies[i].deformable == nullptr) continue;
    if (wire)
      draw_edges(context, list, i, over_surfaces ? mix(colors[i], role::kTetrahedron, 0.55f) : colors[i]);
    else
      draw_solids(context, list, i, colors[i]);
  }
}

}  // namespace

Layer tetrahedra_layer() {
  return {"tetrahedra",
          "The tetrahedra of deformable bodies, as edges or as solids with gaps (view.tetrahedra.style).",
          false,
          draw_tetrahedra,
          {{LegendRow::line, role::kTetrahedron, "tetrahedra", has_deformable},
           {LegendRow::line, role::kOverlap, "tetrahedron, inside out", has_everted}},
          TetrahedraSettings{}};
}

}  // namespace impinge
