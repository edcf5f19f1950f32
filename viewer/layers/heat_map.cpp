#include "viewer/layers/heat_map.hpp"

#include <algorithm>
#include <cmath>

#include "engine/bodies/element_stress.hpp"
#include "viewer/draw/body_color.hpp"
#include "viewer/layers/body_style.hpp"

namespace impinge {

void StressSettings::declare(const Rows& rows) {
  rows.add("of", of, {{HeatQuantity::von_mises, "von_mises"}, {HeatQuantity::mean_stress, "mean"}},
           "The von Mises stress, which distortion makes; or the mean of the principal stresses, whose sign tells "
           "tension (+) from pressure (-).");
  colors.declare(rows, 1e15, "Pa");
}

void StrainSettings::declare(const Rows& rows) {
  rows.add("of", of, {{HeatQuantity::equivalent_strain, "equivalent"}, {HeatQuantity::volume_change, "volume"}},
           "The equivalent strain, of distortion alone; or by how much the volume has grown (+) or shrunk (-).");
  colors.declare(rows, 1e6, "");
}

std::optional<HeatQuantity> heat_shown(const ViewSettings& settings) {
  if (settings.is_on("strain")) return settings.of_layer<StrainSettings>("strain").of;
  if (settings.is_on("stress")) return settings.of_layer<StressSettings>("stress").of;
  return std::nullopt;
}

std::string_view layer_instead_of(std::string_view layer, const ViewSettings& settings) {
  const bool is_stress = layer == "stress";
  if (!is_stress && layer != "strain") return "";
  if (settings.is_on("heat")) return "heat";
  return is_stress && settings.is_on("strain") ? "strain" : "";
}

void grey_out(const LayerContext& context, DrawSurface& item) {
  if (item.pick == 0 || item.pick > context.record.bodies.size()) return;
  const BodyRecord& body = context.record.bodies[item.pick - 1];
  item.heat = nullptr;
  if (!is_moved_by_contact(body) || given_color(context.settings.colors, body.name)) return;
  item.color = role::kNoValue;
  item.asleep = false;
}

std::vector<double> heat_of_elements(const DeformableBody& body, HeatQuantity quantity) {
  std::vector<double> values;
  switch (quantity) {
    case HeatQuantity::von_mises:
      return element_von_mises(body);
    case HeatQuantity::mean_stress:
      return element_mean_stress(body);
    case HeatQuantity::equivalent_strain:
      return element_equivalent_strain(body);
    default:
      values = element_volume_ratio(body);
      for (double& v : values) v -= 1.0;
      return values;
  }
}

ColorScale heat_scale(const StepRecord& record, const ViewSettings& settings, HeatQuantity quantity) {
  const bool is_stress = quantity == HeatQuantity::von_mises || quantity == HeatQuantity::mean_stress;
  const bool is_signed = quantity == HeatQuantity::mean_stress || quantity == HeatQuantity::volume_change;
  const ScaleSettings& own = is_stress ? settings.of_layer<StressSettings>("stress").colors
                                       : settings.of_layer<StrainSettings>("strain").colors;
  // at rest nothing but rounding is left, which is no picture
  const double least = is_stress ? 1.0 : 1e-4;
  std::vector<double> all;
  for (const BodyRecord& body : record.bodies) {
    if (body.deformable == nullptr || own.max > 0.0) continue;
    std::vector<double> shown = node_average(*body.deformable, heat_of_elements(*body.deformable, quantity));
    if (!body.deformable->embedding.tet.empty())
      shown = values_at_points(body.deformable->embedding, body.deformable->fem.rest(), shown);
    for (const double v : shown)
      if (std::isfinite(v)) all.push_back(std::abs(v));
  }
  if (all.empty()) return own.scale(least, is_signed);
  const auto place = all.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(all.size() - 1));
  std::nth_element(all.begin(), place, all.end());
  return own.scale(std::max(*place, least), is_signed);
}

std::vector<double> values_at_points(const Embedding& embedding, const TetMesh& mesh,
                                     const std::vector<double>& of_nodes) {
  std::vector<double> values(embedding.tet.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Tet& tet = mesh.tets[static_cast<std::size_t>(embedding.tet[i])];
    const Vec4& weight = embedding.weight[i];
    for (int k = 0; k < 4; ++k) values[i] += weight[k] * of_nodes[static_cast<std::size_t>(tet[k])];
  }
  return values;
}

ColorBar heat_bar(HeatQuantity quantity, const ColorScale& scale, ColorMap map) {
  if (quantity == HeatQuantity::von_mises) return make_color_bar("von Mises stress", "Pa", scale, map);
  if (quantity == HeatQuantity::mean_stress) return make_color_bar("mean stress", "Pa", scale, map);
  ColorBar bar = make_color_bar(quantity == HeatQuantity::equivalent_strain ? "equivalent strain" : "change of volume",
                                "", scale, map);
  bar.unit = "%";
  bar.factor = 100.0;
  return bar;
}

void draw_heat(const LayerContext& context, DrawList& list, HeatQuantity quantity) {
  const StepRecord& record = context.record;
  if (std::none_of(record.bodies.begin(), record.bodies.end(),
                   [](const BodyRecord& b) { return b.deformable != nullptr; }))
    return;
  ColorBar bar = heat_bar(quantity, heat_scale(record, context.settings, quantity), context.settings.color_map);
  for (DrawSurface& item : list.surfaces) {
    if (item.pick == 0 || item.pick > record.bodies.size()) continue;
    const BodyRecord& body = record.bodies[item.pick - 1];
    if (body.deformable == nullptr || body.deformable->embedding.tet.empty()) {
      grey_out(context, item);
      continue;
    }
    const std::vector<double> nodes = node_average(*body.deformable, heat_of_elements(*body.deformable, quantity));
    const std::vector<double> points = values_at_points(body.deformable->embedding, body.deformable->fem.rest(), nodes);
    auto heat = std::make_shared<std::vector<float>>();
    heat->reserve(item.surface->source.size());
    for (const std::uint32_t v : item.surface->source) heat->push_back(bar.place(points[v]));
    item.heat = std::move(heat);
  }
  if (list.color_bars.empty())
    list.color_bars.push_back(bar);
  else
    list.color_bars.front() = bar;  // strain's instead of stress's
}

}  // namespace impinge
