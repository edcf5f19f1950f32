#include "viewer/layers/heat_map.hpp"

#include <algorithm>
#include <cmath>

#include "engine/bodies/element_stress.hpp"
#include "viewer/layers/contact_measures.hpp"

namespace impinge {

namespace {

const char* layer_of(HeatQuantity quantity) { return quantity == HeatQuantity::stress ? "stress" : "strain"; }

}  // namespace

std::optional<HeatQuantity> heat_shown(const ViewSettings& settings) {
  for (const HeatQuantity quantity : {HeatQuantity::strain, HeatQuantity::stress})
    if (settings.is_on(layer_of(quantity))) return quantity;
  return std::nullopt;
}

std::vector<double> heat_of_elements(const DeformableBody& body, HeatQuantity quantity) {
  return quantity == HeatQuantity::stress ? element_von_mises(body) : element_equivalent_strain(body);
}

double heat_high(const StepRecord& record, const ViewSettings& settings, HeatQuantity quantity) {
  const HeatSettings& own = settings.of_layer<HeatSettings>(layer_of(quantity));
  if (own.max > 0.0) return own.max;
  std::vector<double> all;
  for (const BodyRecord& body : record.bodies) {
    if (body.deformable == nullptr) continue;
    std::vector<double> shown = node_average(*body.deformable, heat_of_elements(*body.deformable, quantity));
    if (!body.deformable->embedding.tet.empty())
      shown = values_at_points(body.deformable->embedding, body.deformable->fem.rest(), shown);
    std::copy_if(shown.begin(), shown.end(), std::back_inserter(all), [](double v) { return std::isfinite(v); });
  }
  // at rest nothing but rounding is left, which is no picture
  const double least = quantity == HeatQuantity::stress ? 1.0 : 1e-4;
  if (all.empty()) return least;
  const auto place = all.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(all.size() - 1));
  std::nth_element(all.begin(), place, all.end());
  return rounded_up(std::max(*place, least));
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

ColorBar make_color_bar(HeatQuantity quantity, double high) {
  if (quantity == HeatQuantity::strain) return {"equivalent strain", "%", 100.0 * high};
  const char* const units[] = {"Pa", "kPa", "MPa", "GPa"};
  int thousands = 0;
  while (thousands < 3 && high >= 1000.0) high /= 1000.0, ++thousands;
  return {"von Mises stress", units[thousands], high};
}

void draw_heat(const LayerContext& context, DrawList& list, HeatQuantity quantity) {
  const StepRecord& record = context.record;
  if (std::none_of(record.bodies.begin(), record.bodies.end(),
                   [](const BodyRecord& b) { return b.deformable != nullptr; }))
    return;
  const double high = heat_high(record, context.settings, quantity);
  ColorBar bar = make_color_bar(quantity, high);
  for (DrawSurface& item : list.surfaces) {
    if (item.pick == 0 || item.pick > record.bodies.size()) continue;
    const BodyRecord& body = record.bodies[item.pick - 1];
    if (body.deformable == nullptr || body.deformable->embedding.tet.empty()) continue;
    const std::vector<double> nodes = node_average(*body.deformable, heat_of_elements(*body.deformable, quantity));
    const std::vector<double> points = values_at_points(body.deformable->embedding, body.deformable->fem.rest(), nodes);
    auto heat = std::make_shared<std::vector<float>>();
    heat->reserve(item.surface->source.size());
    for (const std::uint32_t v : item.surface->source) heat->push_back(static_cast<float>(points[v] / high));
    bar.exceeded = bar.exceeded || std::any_of(heat->begin(), heat->end(), [](float v) { return v > 1.0f; });
    item.heat = std::move(heat);
  }
  if (list.color_bars.empty())
    list.color_bars.push_back(bar);
  else
    list.color_bars.front() = bar;  // strain's instead of stress's
}

}  // namespace impinge
