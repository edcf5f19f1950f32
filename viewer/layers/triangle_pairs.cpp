// The triangles that the narrow phase found to touch or to be near, each once; faint where something hides them.
#include <map>

#include "viewer/layers/layer.hpp"

namespace impinge {
namespace {

void draw_triangle_pairs(const LayerContext& context, DrawList& list) {
  std::map<std::pair<int, int>, bool> found;  // (body, triangle) -> in some intersection
  for (const TrianglePair& pair : context.record.triangle_pairs) {
    if (pair.triangle_a >= 0) found[{pair.a, pair.triangle_a}] |= pair.intersecting;
    if (pair.triangle_b >= 0) found[{pair.b, pair.triangle_b}] |= pair.intersecting;
  }
  for (const auto& [key, intersecting] : found) {
    const BodyRecord& body = context.record.bodies[key.first];
    const SurfaceMesh* mesh = body.shape->mesh();
    if (mesh == nullptr) continue;
    std::array<Vec3, 3> corners;
    const Triangle& t = mesh->mesh.triangles[key.second];
    for (int k = 0; k < 3; ++k) corners[k] = body.vertices[t[k]];
    const Color color = intersecting ? role::kTriangle : role::kNearTriangle;
    list.triangles.push_back(
        {corners, with_alpha(color, 0.75f), Depth::both, body_pick(static_cast<std::size_t>(key.first))});
    for (int k = 0; k < 3; ++k)
      list.lines.push_back({corners[k], corners[(k + 1) % 3], mix(color, role::kOutline, 0.45f),
                            0.8f * static_cast<float>(context.settings.line_width), Depth::both,
                            body_pick(static_cast<std::size_t>(key.first))});
  }
}

}  // namespace

Layer triangle_pairs_layer() {
  return {"triangle_pairs",
          "Triangles that intersect others or are near enough to count.",
          false,
          draw_triangle_pairs,
          {{LegendRow::area, role::kTriangle, "triangle, intersects"},
           {LegendRow::area, role::kNearTriangle, "triangle, near"}}};
}

}  // namespace impinge
