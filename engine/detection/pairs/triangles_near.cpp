#include "engine/detection/pairs/triangles_near.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "engine/geometry/nearest_triangle.hpp"
#include "engine/geometry/surface/disc_search.hpp"

namespace impinge {
namespace {

constexpr int kFewest = 64;  // triangles: below, looking at each is as quick

int count_of(const Collider& mesh) { return static_cast<int>(mesh.mesh().mesh.triangles.size()); }

bool deforms(const Collider& mesh) { return !mesh.vertex_velocities.empty(); }

/// A deforming surface has to be fitted first, which costs as much as looking at each triangle once.
bool has_tree(const Collider& mesh) { return count_of(mesh) > kFewest && (!deforms(mesh) || !mesh.node_boxes.empty()); }

/// What world coordinates lose on the way into the frame of the mesh, generously.
double slack(const Collider& mesh, const Aabb& box) {
  return 1e-12 * (largest_coordinate(box) + largest_coordinate(mesh.bounds));
}

/// Triangles in leaves whose boxes, and those above, `meets` says yes to; ascending.
template <class Meets>
std::vector<int> search(const Collider& mesh, Meets&& meets) {
  const BoxTree& tree = mesh.mesh().tree();
  std::vector<int> found;
  tree.search([&](int n) { return meets(deforms(mesh) ? mesh.node_boxes[n] : tree.nodes()[n].box); },
              [&](int t) { found.push_back(t); });
  std::sort(found.begin(), found.end());
  return found;
}

/// How far to search round a point of the mesh's frame, `x` in the world: at least to the nearest triangle, if it is asked for.
double reach_round(const Collider& mesh, const Vec3& x, const Vec3& local, double distance, bool and_nearest) {
  double reach = distance;
  if (and_nearest) {
    const TriangleMesh& own = mesh.mesh().mesh;
    const std::span<const Vec3> places = deforms(mesh) ? mesh.vertices : std::span<const Vec3>(own.vertices);
    const NearestTriangle nearest = nearest_triangle(mesh.mesh().tree(), own.triangles, places, local, mesh.node_boxes);
    reach = std::max(reach, std::sqrt(nearest.at.squared_distance));
  }
  // the box's, whose corner is farther by rounding than the sphere's
  return widened(mesh, {x, x}, reach);
}

}  // namespace

bool has_cones(const Collider& mesh) { return !deforms(mesh) && count_of(mesh) > kFewest; }

double widened(const Collider& mesh, const Aabb& box, double distance) {
  return distance * (1.0 + 1e-9) + slack(mesh, box);
}

std::vector<int> triangles_near(const Collider& mesh, const Aabb& box) {
  std::vector<int> near;
  const SurfaceView view(mesh, 0);
  const auto look = [&](int t) {
    if (overlap(triangle_bounds(view, t), box)) near.push_back(t);
  };
  if (box.is_empty() || !has_tree(mesh)) {
    for (int t = 0; t < count_of(mesh); ++t) look(t);
    return near;
  }
  // nodes are looked at in the world, where the bounds of a triangle are larger than in a rigid mesh's own frame
  const Mat3 turned = mesh.pose.rotation.cwiseAbs();
  const Aabb wide = box.inflated(slack(mesh, box));
  const auto meets = [&](const Aabb& node) {
    if (deforms(mesh)) return overlap(node, box);
    const Vec3 center = mesh.pose.apply(node.center()), half = product(turned, 0.5 * node.extent());
    return overlap(Aabb{center - half, center + half}, wide);
  };
  for (int t : search(mesh, meets)) look(t);
  return near;
}

std::vector<int> triangles_round(const Collider& mesh, const Vec3& x, double distance, bool and_nearest) {
  if (!has_tree(mesh)) {
    std::vector<int> all(static_cast<std::size_t>(count_of(mesh)));
    std::iota(all.begin(), all.end(), 0);
    return all;
  }
  const Vec3 local = deforms(mesh) ? x : mesh.pose.apply_inverse(x);
  const double reach = reach_round(mesh, x, local, distance, and_nearest);
  return search(mesh, [&](const Aabb& node) { return squared_distance(node, local) <= reach * reach; });
}

std::vector<int> triangles_seen_from(const Collider& mesh, const Vec3& x, double distance, bool and_nearest) {
  if (!has_cones(mesh)) return triangles_round(mesh, x, distance, and_nearest);
  const Vec3 local = mesh.pose.apply_inverse(x);
  const TriangleMesh& own = mesh.mesh().mesh;
  // of a surface that doesn't close, either side is in front of something
  const bool or_inside = and_nearest || !mesh.mesh().topology.is_closed();
  const auto seen = [&](double reach) {
    return seen_triangles(mesh.mesh(), reach, or_inside, [&](const Vec3& c) { return Vec3(local - c); });
  };
  std::vector<int> found = seen(reach_round(mesh, x, local, distance, false));
  // the nearest of all is among those within the distance, if there are any
  const auto is_within = [&](int t) {
    const Triangle& c = own.triangles[static_cast<std::size_t>(t)];
    return closest_on_triangle(local, {own.vertices[c[0]], own.vertices[c[1]], own.vertices[c[2]]}).squared_distance <=
           distance * distance;
  };
  if (and_nearest && std::none_of(found.begin(), found.end(), is_within))
    found = seen(reach_round(mesh, x, local, distance, true));
  return found;
}

std::vector<int> triangles_seen_from(const Collider& mesh, const Vec3& p, const Vec3& q, double distance) {
  Aabb box;
  box.include(p), box.include(q);
  if (!has_cones(mesh)) return triangles_near(mesh, box.inflated(distance));
  const Vec3 from = mesh.pose.apply_inverse(p), to = mesh.pose.apply_inverse(q);
  return seen_triangles(mesh.mesh(), widened(mesh, box, distance), false,
                        [&](const Vec3& c) { return Vec3(closest_on_segment(c, from, to).point - c); });
}

std::optional<std::vector<int>> triangles_within(const Collider& mesh, const Aabb& box, const SolidFrame& solid,
                                                 double reach, std::size_t most) {
  if (!has_cones(mesh)) return triangles_near(mesh, box);
  const Mat3 turn = solid.pose.rotation.transpose() * mesh.pose.rotation;
  const Vec3 shift = solid.pose.apply_inverse(mesh.pose.position);
  const Pose to_solid{turn, shift};
  const Aabb own = solid.box();
  const double wide = widened(mesh, box, reach);
  const int last = mesh.mesh().discs().levels() - 1;
  std::size_t count = 0;
  const auto meets = [&](const PlacedDisc& disc, int level, int, int) {
    if (count > most) return false;
    const Vec3 center = to_solid.apply(disc.center);
    const double most_away = wide + disc.radius;
    if (squared_distance(own, center) > most_away * most_away || solid.distance(center) > most_away) return false;
    if (!disc.normal.isZero(0.0)) {
      const Vec3 normal = product(turn, disc.normal);
      const double at = normal.dot(center), thick = wide + disc.thickness;
      if (at - solid.height(normal) > thick || -solid.height(-normal) - at > thick) return false;
    }
    count += level == last ? 1 : 0;
    return true;
  };
  std::vector<int> found = search_discs(mesh.mesh().discs(), meets);
  if (count > most) return std::nullopt;
  const SurfaceView view(mesh, 0);
  std::erase_if(found, [&](int t) { return !overlap(triangle_bounds(view, t), box); });
  return found;
}

std::vector<int> triangles_within(const Collider& mesh, const Aabb& box, const SolidFrame& solid, double reach) {
  return *triangles_within(mesh, box, solid, reach, std::numeric_limits<std::size_t>::max());
}

}  // namespace impinge
