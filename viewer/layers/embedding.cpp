// How surfaces hang on tetrahedra: from some of a surface's vertices to the four nodes that carry each. A vertex
// outside of all tetrahedra is carried by the nearest one and marked.
#include "viewer/layers/body_style.hpp"
#include "viewer/layers/layer.hpp"

namespace impinge {
namespace {

constexpr double kInsideWeight = -1e-9;
constexpr std::size_t kMostShown = 250;  // of a body, and as many outside ones

void draw_embedding(const LayerContext& context, DrawList& list) {
  const float width = 0.7f * static_cast<float>(context.settings.line_width),
              size = 0.5f * static_cast<float>(context.settings.point_size);
  for (std::size_t i = 0; i < context.record.bodies.size(); ++i) {
    const BodyRecord& body = context.record.bodies[i];
    if (body.deformable == nullptr || body.deformable->embedding.tet.empty()) continue;
    const Embedding& embedding = body.deformable->embedding;
    const PickId pick = body_pick(i);
    const auto draw_vertex = [&](std::size_t v, bool outside) {
      const Vec3& at = body.vertices[v];
      const Color color = outside ? role::kOutside : role::kCarried;
      for (const int n : body.deformable->fem.rest().tets[static_cast<std::size_t>(embedding.tet[v])])
        list.lines.push_back(
            {at, body.deformable->position.segment<3>(3 * n), with_alpha(color, 0.7f), width, Depth::both, pick});
      list.points.push_back({at, color, outside ? 1.5f * size : size, Depth::both, pick});
    };
    std::vector<std::size_t> outside;
    for (std::size_t v = 0; v < embedding.tet.size(); ++v)
      if (embedding.weight[v].minCoeff() < kInsideWeight) outside.push_back(v);
    for (const std::size_t v : thinned(embedding.tet.size(), kMostShown))
      if (embedding.weight[v].minCoeff() >= kInsideWeight) draw_vertex(v, false);
    for (const std::size_t k : thinned(outside.size(), kMostShown)) draw_vertex(outside[k], true);
  }
}

}  // namespace

Layer embedding_layer() {
  return {"embedding",
          "Lines from some vertices of deformable surfaces to the nodes that carry them.",
          false,
          draw_embedding,
          {{LegendRow::line, role::kCarried, "vertex to its nodes", has_deformable},
           {LegendRow::point, role::kOutside, "vertex outside the tetrahedra", has_outside_vertices}}};
}

}  // namespace impinge
