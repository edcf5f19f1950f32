// The bodies' surfaces. At rest: nearly grey. Static: grey. Scripted: pale with bands. Walls and containers in the way: see-through.
#include <algorithm>
#include <optional>

#include "engine/shapes/primitives.hpp"
#include "viewer/draw/body_color.hpp"
#include "viewer/layers/body_style.hpp"
#include "viewer/layers/container.hpp"
#include "viewer/layers/layer.hpp"

namespace impinge {
namespace {

void draw_meshes(const LayerContext& context, DrawList& list) {
  const std::vector<Color> colors = body_colors(context.record, context.settings.colors);
  for (std::size_t i = 0; i < context.record.bodies.size(); ++i) {
    const BodyRecord& body = context.record.bodies[i];
    if (const auto* plane = body.shape->as<Plane>()) {
      const Vec3 normal = body.pose.rotation * plane->normal;
      list.planes.push_back(
          {normal, plane->offset + normal.dot(body.pose.position),
           given_color(context.settings.colors, body.name)
               .value_or(context.settings.backdrop == BackdropStyle::light ? role::kLightFloor : role::kFloor),
           body_pick(i)});
      continue;
    }
    DrawSurface item{context.surfaces.surface_of(*body.shape), body.pose, colors[i], false, false, body_pick(i)};
    item.moved = context.surfaces.moved_of(body);
    item.striped = body.kind == BodyKind::scripted;
    item.asleep = body.asleep;
    if (body.asleep) item.color = asleep_color(item.color);
    item.see_through =
        is_wall_in_the_way(body, context.camera) || hides_what_is_inside(context.record, i, context.camera.eye);
    list.surfaces.push_back(std::move(item));
    if (is_wall(body)) {
      const Vec3 half = body.shape->as<Box>()->half;
      const auto first = static_cast<std::ptrdiff_t>(list.lines.size());
      list.add_box(body.pose, -half, half, with_alpha(role::kWallEdge, 0.55f), 1.0f, Depth::tested, body_pick(i));
      const auto gone = [&](DrawLine& line) { return !context.settings.clip.trim(line.a, line.b); };
      list.lines.erase(std::remove_if(list.lines.begin() + first, list.lines.end(), gone), list.lines.end());
    }
  }
}

std::optional<Color> color_of_sleepers(const DrawList& list) {
  for (const DrawSurface& item : list.surfaces)
    if (item.asleep && item.heat == nullptr) return item.color;
  return std::nullopt;
}

}  // namespace

Layer meshes_layer() {
  return {"meshes",
          "The bodies' surfaces: bodies asleep nearly grey, static grey, scripted banded, walls and containers in the "
          "way see-through.",
          true,
          draw_meshes,
          {{LegendRow::area, role::kScripted, "scripted body"},
           {LegendRow::area, role::kStatic, "static body"},
           {LegendRow::area, {}, "body asleep (at rest)", nullptr, nullptr, color_of_sleepers}}};
}

}  // namespace impinge
