#include "engine/detection/pairs/deforming_vertices.hpp"

#include <algorithm>

#include "engine/detection/contacts/surface_view.hpp"
#include "engine/detection/pairs/triangles_near.hpp"
#include "engine/geometry/convex/convex_gap.hpp"
#include "engine/geometry/convex/convex_point.hpp"

namespace impinge {
namespace {

const ConvexSet* solid_of(const Collider& c) {
  const auto form = c.shape->form();
  const ConvexSet* const* solid = std::get_if<const ConvexSet*>(&form);
  return solid != nullptr ? *solid : nullptr;
}

}  // namespace

bool has_deforming_vertices(const ContactSink& sink) {
  const ConvexSet* solid = solid_of(sink.first());
  return solid != nullptr && solid->polyhedron() == nullptr && sink.query().proximity &&
         !sink.second().vertex_velocities.empty();
}

void add_deforming_vertices(ContactSink& sink) {
  const SurfaceView mesh(sink.second(), 1);
  const PlacedConvex solid{solid_of(sink.first()), sink.first().pose};
  const Aabb region = sink.first().bounds.inflated(sink.reach());
  std::vector<int> vertices;
  for (const int t : triangles_near(sink.second(), region))
    for (const int v : mesh.triangle(t))
      if (overlap(region, Aabb{mesh.vertex(v), mesh.vertex(v)})) vertices.push_back(v);
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  const ConvexPoint point;
  for (const int v : vertices) {
    const ConvexGap gap = convex_gap(solid, {&point, {Mat3::Identity(), mesh.vertex(v)}}, sink.reach());
    if (!gap.is_within_reach || gap.normal.dot(mesh.normal({Feature::vertex, v})) <= 0.0) continue;
    Candidate c;
    c.normal = gap.normal;
    c.point_first = gap.point_a;
    c.point_second = mesh.vertex(v);
    c.kind_second = Feature::vertex;
    c.index_second = v;
    c.triangle_second = mesh.triangle_of({Feature::vertex, v});
    sink.add_new(c);
  }
}

}  // namespace impinge
