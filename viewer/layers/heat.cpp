// Surfaces coloured by how fast they are, or by what their contacts do: of each contact the colour is its own at the
// nearest vertex and fades round it.
#include <algorithm>
#include <cmath>

#include "viewer/layers/contact_measures.hpp"
#include "viewer/layers/heat_map.hpp"
#include "viewer/layers/layer.hpp"

namespace impinge {
namespace {

constexpr double kReach = 0.1;  // of the smaller body of a contact, to where its colour fades

enum class HeatOf { speed, overlap, impulse, slip, residual };

struct HeatSettings {
  HeatOf of = HeatOf::speed;
  ScaleSettings colors;

  void declare(const Rows& rows) {
    rows.add(
        "of", of,
        {{HeatOf::speed, "speed"},
         {HeatOf::overlap, "overlap"},
         {HeatOf::impulse, "impulse"},
         {HeatOf::slip, "slip"},
         {HeatOf::residual, "residual"}},
        "What colours mean: the speed of the material (m/s); at contacts how deep the bodies overlap (m), the "
        "normal impulse (N s), the speed at which the two points slide along each other (m/s), or how far the answer "
        "is from Coulomb's law, as the judge measures it: relative, no more than residual_coulomb.");
    colors.declare(rows, 1e15, "");
  }
};

/// Where the positions of a drawn surface are in the world.
std::vector<Vec3> world_positions(const DrawSurface& item) {
  const Pose placement = item.placement();
  std::vector<Vec3> all;
  for (const Eigen::Vector3f& x : item.moved ? item.moved->positions : item.surface->positions)
    all.push_back(placement.apply(x.cast<double>()));
  return all;
}

std::vector<double> speeds(const DrawSurface& item, const BodyRecord& body) {
  std::vector<double> values;
  if (body.deformable == nullptr) {
    for (const Vec3& x : world_positions(item))
      values.push_back((body.velocity + body.angular_velocity.cross(x - body.pose.position)).norm());
    return values;
  }
  const DeformableBody& soft = *body.deformable;
  std::vector<Vec3> velocities;
  interpolate(soft.embedding, soft.fem.rest(), soft.velocity, velocities);
  for (const std::uint32_t v : item.surface->source) values.push_back(velocities[v].norm());
  return values;
}

double reach_of(const StepRecord& record, const ContactRecord& c) {
  double least = INFINITY;
  for (const BodyIndex b : {c.body_a, c.body_b}) {
    const Aabb& box = record.bodies[static_cast<std::size_t>(b.value())].bounds;
    if (!box.is_empty() && box.extent().allFinite()) least = std::min(least, kReach * box.extent().norm());
  }
  return least;
}

std::vector<double> by_contacts(std::span<const Vec3> at, std::size_t own, const StepRecord& record,
                                ContactMeasure what) {
  std::vector<double> values(at.size(), 0.0);
  for (const ContactRecord& c : record.contacts) {
    const bool is_a = static_cast<std::size_t>(c.body_a.value()) == own;
    if (!is_a && static_cast<std::size_t>(c.body_b.value()) != own) continue;
    const double value = measure_of(record, c, what);
    if (!(value > 0.0)) continue;
    const double reach = reach_of(record, c);
    const Vec3& point = is_a ? c.point_a : c.point_b;
    double nearest_sq = INFINITY;
    for (const Vec3& x : at) nearest_sq = std::min(nearest_sq, (x - point).squaredNorm());
    for (std::size_t i = 0; i < at.size(); ++i) {
      // from the nearest vertex on, which has it whole, however coarse the surface is
      const double d = (std::sqrt((at[i] - point).squaredNorm()) - std::sqrt(nearest_sq)) / reach;
      if (!(d < 1.0)) continue;
      const double left = (1.0 - d * d) * (1.0 - d * d);
      values[i] = std::max(values[i], left * value);
    }
  }
  return values;
}

/// None of speed.
std::optional<ContactMeasure> measure_of_heat(HeatOf what) {
  if (what == HeatOf::speed) return std::nullopt;
  if (what == HeatOf::overlap) return ContactMeasure::overlap;
  if (what == HeatOf::residual) return ContactMeasure::residual;
  return what == HeatOf::impulse ? ContactMeasure::impulse : ContactMeasure::slip;
}

void draw_heat(const LayerContext& context, DrawList& list) {
  const StepRecord& record = context.record;
  const HeatSettings& own = context.own<HeatSettings>();
  const std::optional<ContactMeasure> measure = measure_of_heat(own.of);
  std::vector<std::vector<double>> values(list.surfaces.size());
  double most = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const DrawSurface& item = list.surfaces[i];
    if (item.pick == 0 || item.pick > record.bodies.size()) continue;
    const BodyRecord& body = record.bodies[item.pick - 1];
    if (body.kind == BodyKind::fixed && !measure) continue;
    values[i] = measure ? by_contacts(world_positions(item), item.pick - 1, record, *measure) : speeds(item, body);
    const double highest = values[i].empty() ? 0.0 : *std::max_element(values[i].begin(), values[i].end());
    if (measure && highest == 0.0) values[i].clear();  // nothing touches it
    most = std::max(most, highest);
  }
  const double least = measure ? least_shown(record, *measure) : kLeastShown;
  const ColorScale scale = own.colors.scale(std::max(most, least), false);
  const ColorMap map = context.settings.color_map;
  ColorBar bar = measure ? bar_of(*measure, scale, map) : make_color_bar("speed", "m/s", scale, map);
  bool any = false;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i].empty()) {
      grey_out(context, list.surfaces[i]);
      continue;
    }
    any = true;
    auto heat = std::make_shared<std::vector<float>>();
    for (const double v : values[i]) heat->push_back(bar.place(v));
    list.surfaces[i].heat = std::move(heat);
  }
  list.color_bars.clear();  // of the surfaces there is one: instead of stress's or strain's
  if (any) list.color_bars.push_back(bar);
}

}  // namespace

std::vector<float> heat_at(const LayerContext& context, DrawList& list, std::size_t body, std::span<const Vec3> points,
                           std::span<const Vec3> velocities) {
  if (!context.settings.is_on("heat") || list.color_bars.empty()) return {};
  const std::optional<ContactMeasure> measure = measure_of_heat(context.settings.of_layer<HeatSettings>("heat").of);
  std::vector<double> values;
  if (measure)
    values = by_contacts(points, body, context.record, *measure);
  else
    for (const Vec3& v : velocities) values.push_back(v.norm());
  if (measure && std::all_of(values.begin(), values.end(), [](double v) { return v == 0.0; })) return {};
  std::vector<float> heat;
  for (const double v : values) heat.push_back(list.color_bars.front().place(v));
  return heat;
}

Layer heat_layer() {
  return {"heat",
          "Surfaces coloured by speed, or by overlap, impulse, slip or residual of their contacts (view.heat.of); the "
          "colour bar "
          "gives its range.",
          false,
          draw_heat,
          {},
          HeatSettings{}};
}

}  // namespace impinge
