// The nodes of deformable bodies that are held: rings, which contacts are not; those being moved are orange and show
// where they go.
#include <algorithm>

#include "viewer/layers/body_style.hpp"
#include "viewer/layers/layer.hpp"

namespace impinge {
namespace {

constexpr double kFramesAhead = 6.0;  // as the velocities layer

/// At any time: a legend that comes and goes with the motion would be in the way.
bool has_moved_nodes(const StepRecord& record) {
  return std::any_of(record.bodies.begin(), record.bodies.end(), [](const BodyRecord& body) {
    const DeformableBody* soft = body.deformable;
    return soft != nullptr &&
           (!soft->held_velocity().isZero(0.0) ||
            std::any_of(soft->held.begin(), soft->held.end(), [](const HeldRegion& r) { return r.is_moved(); }));
  });
}

void draw_fixed_nodes(const LayerContext& context, DrawList& list) {
  const float size = 0.85f * static_cast<float>(context.settings.point_size),
              width = 1.4f * static_cast<float>(context.settings.line_width);
  for (std::size_t i = 0; i < context.record.bodies.size(); ++i) {
    const DeformableBody* body = context.record.bodies[i].deformable;
    if (body == nullptr) continue;
    for (int n = 0; n < body->nodes(); ++n) {
      if (!body->is_held(n)) continue;
      const Vec3 at = body->position.segment<3>(3 * n), velocity = body->held_velocity().segment<3>(3 * n);
      const bool moves = velocity.squaredNorm() > 0.0;
      if (moves)
        list.arrows.push_back({at, velocity * (kFramesAhead * context.record.frame_time), role::kMoved, 0.0f, width,
                               Depth::both, body_pick(i)});
      list.points.push_back({at, moves ? role::kMoved : role::kHeld, size, Depth::both, body_pick(i)});
      list.points.push_back({at, role::kOutline, 0.35f * size, Depth::both, body_pick(i)});
    }
  }
}

}  // namespace

Layer fixed_nodes_layer() {
  return {"fixed_nodes",
          "Held nodes of deformable bodies; those that a script moves with their way of the next six frames.",
          false,
          draw_fixed_nodes,
          {{LegendRow::ring, role::kHeld, "node, held", has_held_nodes},
           {LegendRow::arrow, role::kMoved, "node, moved by the scene", has_moved_nodes}}};
}

}  // namespace impinge
