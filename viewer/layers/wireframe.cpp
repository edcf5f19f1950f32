// Every edge of every surface that takes part in contact: dark over drawn surfaces, in the bodies' colours where surfaces are not shown.
#include "engine/shapes/primitives.hpp"
#include "viewer/layers/body_style.hpp"
#include "viewer/layers/layer.hpp"

namespace impinge {
namespace {

void draw_wireframe(const LayerContext& context, DrawList& list) {
  const std::vector<Color> colors = body_colors(context.record, context.settings.colors);
  const bool over_surfaces = context.settings.is_on("meshes");
  const float width = 0.7f * static_cast<float>(context.settings.line_width);
  for (std::size_t i = 0; i < context.record.bodies.size(); ++i) {
    const BodyRecord& body = context.record.bodies[i];
    if (body.shape->as<Plane>() != nullptr) continue;
    const ShadedSurfacePointer surface = context.surfaces.touched_surface_of(*body.shape);
    std::vector<Vec3> world;
    world.reserve(surface->positions.size());
    if (body.deformable != nullptr)
      for (const std::uint32_t v : surface->source) world.push_back(body.vertices[v]);
    else
      for (const Eigen::Vector3f& p : surface->positions) world.push_back(body.pose.apply(p.cast<double>()));
    const Color color = over_surfaces ? with_alpha(role::kOutline, 0.6f) : with_alpha(colors[i], 0.8f);
    for (const auto& [a, b] : surface->edges)
      list.lines.push_back({world[a], world[b], color, width, Depth::tested, body_pick(i)});
  }
}

}  // namespace

Layer wireframe_layer() {
  return {"wireframe", "The edges of all triangles that take part in contact.", false, draw_wireframe, {}};
}

}  // namespace impinge
