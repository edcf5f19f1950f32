// Pulls: from the point of the body that a hand has hold of to where it is drawn to.
#include <algorithm>

#include "viewer/layers/layer.hpp"
#include "viewer/layers/pull_mark.hpp"

namespace impinge {

void mark_pull(const Vec3& point, const Vec3& target, const ViewSettings& settings, double scale, PickId pick,
               DrawList& list) {
  const auto size = static_cast<float>(scale * settings.point_size),
             width = static_cast<float>(2.2 * scale * settings.line_width);
  if ((target - point).norm() > 0.0)
    list.arrows.push_back({point, target - point, role::kPull, 0.0f, width, Depth::on_top, pick});
  list.points.push_back({point, role::kPull, size, Depth::on_top, pick});
  list.points.push_back({point, role::kOutline, 0.4f * size, Depth::on_top, pick});
}

namespace {

bool has_pulls(const StepRecord& record) {
  return std::any_of(record.bodies.begin(), record.bodies.end(),
                     [](const BodyRecord& b) { return b.pull.has_value(); });
}

void draw_pulls(const LayerContext& context, DrawList& list) {
  for (std::size_t i = 0; i < context.record.bodies.size(); ++i)
    if (const auto& pull = context.record.bodies[i].pull)
      mark_pull(pull->point, pull->target, context.settings, 1.0, body_pick(i), list);
}

}  // namespace

Layer pulls_layer() {
  return {"pulls",
          "Pulls by hand or by a script: from the point of the body to where it is drawn to.",
          true,
          draw_pulls,
          {{LegendRow::arrow, role::kPull, "pulled to", has_pulls}}};
}

}  // namespace impinge
