#include "viewer/layers/container.hpp"

#include "engine/geometry/box_tree.hpp"
#include "engine/geometry/convex/convex_triangle.hpp"
#include "engine/geometry/triangle_intersection.hpp"
#include "engine/shapes/shape.hpp"

namespace impinge {
namespace {

constexpr std::size_t kMostTriangles = 100'000;  // for which a picture may make a tree

bool contains(const Aabb& outer, const Aabb& inner) {
  return !inner.is_empty() && (outer.min.array() <= inner.min.array()).all() &&
         (inner.max.array() <= outer.max.array()).all();
}

/// Of a segment and a box round its middle, by the axes of both.
bool meets(const Aabb& box, const Vec3& from, const Vec3& to) {
  const Vec3 half = 0.5 * box.extent(), way = 0.5 * (to - from), apart = 0.5 * (from + to) - box.center();
  for (int k = 0; k < 3; ++k)
    if (std::abs(apart[k]) > half[k] + std::abs(way[k])) return false;
  const Vec3 across = way.cross(apart).cwiseAbs();
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    if (across[k] > half[i] * std::abs(way[j]) + half[j] * std::abs(way[i])) return false;
  }
  return true;
}

bool crosses(const TriangleCorners& triangle, const Vec3& from, const Vec3& to) {
  const std::optional<RayHit> hit = intersect_line(from, to - from, triangle);
  return hit && hit->t >= 0.0 && hit->t <= 1.0;
}

}  // namespace

bool hides_what_is_inside(const StepRecord& record, std::size_t body, const Vec3& eye) {
  const BodyRecord& own = record.bodies[body];
  const SurfaceMesh* surface = own.kind == BodyKind::deformable ? nullptr : own.shape->mesh();
  if (surface == nullptr || surface->mesh.triangles.size() > kMostTriangles || own.deleted) return false;
  if (own.bounds.is_empty() || contains(own.bounds, Aabb{eye, eye})) return false;
  const Vec3 from = own.pose.apply_inverse(eye);
  bool is_any = false;
  for (std::size_t i = 0; i < record.bodies.size(); ++i) {
    const BodyRecord& other = record.bodies[i];
    if (i == body || other.deleted || other.kind == BodyKind::fixed || !contains(own.bounds, other.bounds)) continue;
    is_any = true;
    const Vec3 to = own.pose.apply_inverse(other.bounds.center());
    const BoxTree& tree = surface->tree();
    bool is_hidden = false;
    tree.search([&](int n) { return !is_hidden && meets(tree.nodes()[static_cast<std::size_t>(n)].box, from, to); },
                [&](int t) { is_hidden = is_hidden || crosses(ConvexTriangle(surface->mesh, t).corners(), from, to); });
    if (!is_hidden) return false;
  }
  return is_any;
}

}  // namespace impinge
