#include "engine/preflight/enclosure.hpp"

#include <algorithm>

#include "engine/core/interrupt.hpp"
#include "engine/geometry/inside.hpp"
#include "engine/geometry/surface/inner_points.hpp"
#include "engine/shapes/primitives.hpp"

namespace impinge {
namespace {

constexpr std::size_t kMostPoints = 2000, kFewestPoints = 50;
constexpr std::size_t kMostWork = 20'000'000;  // points times triangles: under a second

/// Of its surface, spread over it; fewer where each has to be held against many triangles.
std::vector<Vec3> points_of(const Body& body, const Body& outer) {
  const SurfaceMesh* mesh = outer.shape->mesh();
  const std::size_t most =
      mesh == nullptr
          ? kMostPoints
          : std::clamp(kMostWork / std::max<std::size_t>(mesh->mesh.triangles.size(), 1), kFewestPoints, kMostPoints);
  std::vector<Vec3> all = body.world_vertices;
  if (all.empty())
    for (const Vec3& x : body.shape->drawn().vertices) all.push_back(body.pose.apply(x));
  if (all.size() <= most) return all;
  std::vector<Vec3> some;
  for (std::size_t i = 0; i < most; ++i) some.push_back(all[i * all.size() / most]);
  return some;
}

/// How deep a world point is in the body, metres; not positive outside.
double depth_in(const Body& body, const Vec3& world) {
  const SurfaceMesh* mesh = body.shape->mesh();
  if (mesh == nullptr) return -body.shape->signed_distance(body.pose.apply_inverse(world));
  if (winding_number(world, body.world_vertices, mesh->mesh.triangles) < 0.5) return 0.0;
  return distance_to_surface(world, body.world_vertices, mesh->mesh.triangles);
}

bool is_solid(const Body& body) { return body.shape->mesh() == nullptr || body.shape->mesh()->topology.is_closed(); }

bool is_plane(const Body& body) { return body.shape->as<Plane>() != nullptr; }

bool holds(const Aabb& outer, const Aabb& inner) {
  return (inner.min.array() >= outer.min.array()).all() && (inner.max.array() <= outer.max.array()).all();
}

/// 0: not wholly inside.
double least_depth(const Body& inner, const Body& outer) {
  double least = INFINITY;
  for (const Vec3& point : points_of(inner, outer)) {
    check_interrupt();
    least = std::min(least, depth_in(outer, point));
    if (!(least > 0.0)) return 0.0;
  }
  return std::isfinite(least) ? least : 0.0;
}

}  // namespace

std::vector<Enclosure> find_enclosures(const Bodies& bodies) {
  std::vector<Enclosure> found;
  std::vector<Aabb> boxes;
  for (const Body& body : bodies) boxes.push_back(body.bounds());
  const auto may_hold = [&](BodyIndex outer, BodyIndex inner) {
    return is_plane(bodies[outer]) ||
           holds(boxes[static_cast<std::size_t>(outer.value())], boxes[static_cast<std::size_t>(inner.value())]);
  };
  for (BodyIndex inner(0); inner < bodies.size(); ++inner)
    for (BodyIndex outer(0); outer < bodies.size(); ++outer) {
      if (inner == outer || bodies[inner].absent || bodies[outer].absent) continue;
      if (!bodies[inner].has_freedom() && !bodies[outer].has_freedom()) continue;
      if (is_plane(bodies[inner]) || !may_hold(outer, inner) || bodies.never_touch(inner, outer)) continue;
      if (const double depth = least_depth(bodies[inner], bodies[outer]); depth > 0.0)
        found.push_back({inner, outer, depth});
    }
  return found;
}

double depth_in_one_place(const Body& a, const Body& b) {
  constexpr std::size_t kPoints = 32, kFewest = 4;
  double deepest = 0.0;
  for (const auto& [own, other] : {std::pair(&a, &b), std::pair(&b, &a)}) {
    const SurfaceMesh* mesh = own->shape->mesh();
    if (mesh == nullptr || !is_solid(*own) || !is_solid(*other)) continue;
    check_interrupt();
    const std::size_t most =
        std::clamp(kMostWork / std::max<std::size_t>(mesh->mesh.triangles.size(), 1), kFewest, kPoints);
    const auto depth = [&, body = other](const Vec3& x) { return depth_in(*body, x); };
    deepest =
        std::max(deepest, deepest_inner_point(SearchedMesh(*mesh, own->world_vertices), most, other->bounds(), depth));
  }
  return deepest;
}

}  // namespace impinge
