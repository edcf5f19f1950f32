#include "engine/contact/surface_foot.hpp"

#include "engine/detection/contacts/surface_view.hpp"
#include "engine/geometry/box_tree.hpp"
#include "engine/geometry/convex/convex_gap.hpp"
#include "engine/geometry/convex/convex_point.hpp"
#include "engine/geometry/nearest_triangle.hpp"
#include "engine/shapes/primitives.hpp"

namespace impinge {
namespace {

/// Of the mean edge: what is nearer to an edge or vertex has no direction of its own from there but rounding.
constexpr double kInFeature = 1e-7;

SurfaceFoot foot_on_convex(const ConvexSet& solid, const Pose& pose, const Vec3& x) {
  const ConvexPoint point;
  const ConvexGap gap = convex_gap({&point, {Mat3::Identity(), x}}, {&solid, pose});
  return {gap.point_b, gap.normal, gap.gap, {}};
}

SurfaceFoot foot_on_plane(const Plane& plane, const Pose& pose, const Vec3& x) {
  const Vec3 normal = pose.rotation * plane.normal;
  const double distance = plane.signed_distance(pose.apply_inverse(x));
  return {x - distance * normal, normal, distance, {}};
}

SurfaceFoot foot_on_mesh(const Body& body, const SurfaceMesh& mesh, const Vec3& x) {
  const bool deforms = body.kind() == BodyKind::deformable;
  std::vector<Aabb> boxes;
  if (deforms) mesh.tree().fit(triangle_boxes(mesh.mesh.triangles, body.world_vertices), boxes);
  // a rigid mesh keeps its tree in its own frame
  const NearestTriangle nearest =
      deforms ? nearest_triangle(mesh.tree(), mesh.mesh.triangles, body.world_vertices, x, boxes)
              : nearest_triangle(mesh.tree(), mesh.mesh.triangles, mesh.mesh.vertices, body.pose.apply_inverse(x));
  Collider collider;
  collider.shape = body.shape.get();
  collider.vertices = body.world_vertices;
  const SurfaceView view(collider, 0);
  const auto on = closest_on_triangle(x, view.corners(nearest.triangle));
  SurfaceFoot foot{on.point, view.normal(view.feature(nearest.triangle, on.feature)), 0.0,
                   TriangleIndex(nearest.triangle)};
  const Vec3 away = x - foot.point;
  const double side = foot.normal.dot(away) < 0.0 ? -1.0 : 1.0;
  if (on.feature != TriangleFeature::face && away.norm() > kInFeature * body.mean_edge)
    foot.normal = side * away.normalized();
  foot.distance = foot.normal.dot(away);
  return foot;
}

}  // namespace

SurfaceFoot surface_foot(const Body& body, const Vec3& x) {
  const ShapeForm form = body.shape->form();
  if (const auto* plane = std::get_if<const Plane*>(&form)) return foot_on_plane(**plane, body.pose, x);
  if (const auto* convex = std::get_if<const ConvexSet*>(&form)) return foot_on_convex(**convex, body.pose, x);
  if (const auto* mesh = std::get_if<const SurfaceMesh*>(&form)) return foot_on_mesh(body, **mesh, x);
  SurfaceFoot nearest;
  nearest.distance = INFINITY;
  for (const ShapePart& part : *std::get<const std::vector<ShapePart>*>(form)) {
    const Pose pose{body.pose.rotation * part.pose.rotation, body.pose.apply(part.pose.position)};
    const SurfaceFoot foot = foot_on_convex(*std::get<const ConvexSet*>(part.shape->form()), pose, x);
    if (foot.distance < nearest.distance) nearest = foot;
  }
  return nearest;
}

}  // namespace impinge
