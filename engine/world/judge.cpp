#include "engine/world/judge.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/interrupt.hpp"
#include "engine/core/lazily.hpp"
#include "engine/core/parallel.hpp"
#include "engine/geometry/surface/edges_inside.hpp"
#include "engine/geometry/surface/inner_points.hpp"
#include "engine/geometry/triangle_intersection.hpp"
#include "engine/shapes/primitives.hpp"
#include "engine/shapes/wall.hpp"
#include "engine/world/judge_convex.hpp"

namespace impinge {
namespace {

constexpr double kOnSurface = 1e-9;  // of the smaller box: a depth that is rounding

constexpr std::size_t kMostPoints = 64;  // well inside a mesh

/// A solid that the judge looks at by itself: a body, or a part of one that is a compound.
struct Solid {
  const SharedShape* shared = nullptr;
  JudgeMemory* memory = nullptr;
  const Shape* shape = nullptr;
  Pose pose;
  std::span<const Vec3> vertices;  ///< of a mesh
  Aabb bounds;
  // of a mesh, for all its pairs
  Lazily<SearchedMesh> lazy_search = {};
  Lazily<std::vector<Vec3>> lazy_points = {};
  const SearchedMesh& search() const {
    return lazy_search.get([&] { return SearchedMesh(*shape->mesh(), vertices, &memory->rims_of(*shared)); });
  }
  const std::vector<Vec3>& points_inside() const {
    return lazy_points.get([&] { return inner_points(search(), kMostPoints); });
  }
};

std::vector<Solid> solids_of(const Body& body, JudgeMemory& memory) {
  const std::vector<ShapePart>* parts = body.shape->parts();
  if (parts == nullptr)
    return {{&body.shape, &memory, body.shape.get(), body.pose, body.world_vertices, body.bounds()}};
  std::vector<Solid> list;
  for (const ShapePart& part : *parts) {
    const Pose pose{body.pose.rotation * part.pose.rotation, body.pose.apply(part.pose.position)};
    list.push_back({&part.shape, &memory, part.shape.get(), pose, {}, part.shape->bounds(pose)});
  }
  return list;
}

/// Of a solid that is neither plane nor mesh.
const ConvexSet* convex_of(const Solid& solid) { return std::get<const ConvexSet*>(solid.shape->form()); }

/// Signed distance of a world point from the surface of a solid that is no mesh, negative inside. Metres.
double signed_distance(const Solid& solid, const Vec3& world) {
  return solid.shape->signed_distance(solid.pose.apply_inverse(world));
}

/// The segment inside a sphere (a point) or capsule, and its radius. Others are judged without one.
bool centre_line(const Solid& solid, Vec3& p, Vec3& q, double& radius) {
  if (const auto* s = solid.shape->as<Sphere>()) {
    p = q = solid.pose.position;
    radius = s->radius;
    return true;
  }
  if (const auto* c = solid.shape->as<Capsule>()) {
    p = solid.pose.apply(Vec3(0, -c->half_length, 0));
    q = solid.pose.apply(Vec3(0, c->half_length, 0));
    radius = c->radius;
    return true;
  }
  return false;
}

double depth_in_mesh(const Solid& mesh, const Vec3& x) {
  return mesh.search().winding(x) < 0.5 ? 0.0 : mesh.search().distance(x);
}

/// Lowest value of a convex function on the segment pq (golden section).
template <class Function>
double lowest_on_segment(const Vec3& p, const Vec3& q, Function f) {
  double low = 0.0, high = 1.0;
  const double g = 0.5 * (std::sqrt(5.0) - 1.0);
  for (int i = 0; i < 80; ++i) {
    const double a = high - g * (high - low), b = low + g * (high - low);
    if (f(Vec3(p + a * (q - p))) <= f(Vec3(p + b * (q - p))))
      high = b;
    else
      low = a;
  }
  return std::min({f(Vec3(p + 0.5 * (low + high) * (q - p))), f(p), f(q)});
}

/// The deepest of some points inside a mesh.
double points_in_mesh(std::span<const Vec3> points, const Solid& mesh) {
  std::vector<Vec3> inside_box;
  for (const Vec3& v : points)
    if (overlap(mesh.bounds, Aabb{v, v})) inside_box.push_back(v);
  std::vector<double> depth(inside_box.size());
  parallel_for(inside_box.size(), 8, [&](std::size_t i) { depth[i] = depth_in_mesh(mesh, inside_box[i]); });
  return depth.empty() ? 0.0 : *std::max_element(depth.begin(), depth.end());
}

/// How deep two solids are in one another, metres.
struct Overlap {
  double vertices = 0.0;       ///< as OverlapVerdict::penetration says
  double edges = 0.0;          ///< the same, edges of meshes between their ends included
  std::int64_t crossings = 0;  ///< of triangles
};

/// How deep vertices of a mesh are in another solid, metres, negative outside.
struct VertexDepths {
  std::vector<int> vertices;  ///< ascending
  std::vector<double> depths;
  double of(int vertex) const {
    return depths[static_cast<std::size_t>(std::lower_bound(vertices.begin(), vertices.end(), vertex) -
                                           vertices.begin())];
  }
};

/// The deepest point inside a convex solid of a mesh's edges, metres; `known` if that is deeper. Edges in the box alone may
/// be in the solid; their ends have depths.
double edges_in_solid(const Solid& mesh, const Solid& solid, const Aabb& box, const VertexDepths& depths,
                      double known) {
  const MeshTopology& topology = mesh.shape->mesh()->topology;
  std::vector<int> edges;
  for (const int t : mesh.search().triangles_near(box))
    for (const int e : topology.triangle_edges[static_cast<std::size_t>(t)]) edges.push_back(e);
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  InterruptPoll poll;
  for (const int number : edges) {
    const MeshTopology::Edge& e = topology.edges[static_cast<std::size_t>(number)];
    const Vec3 &p = mesh.vertices[e.v0], &q = mesh.vertices[e.v1];
    // a distance changes no faster than the place
    if ((q - p).norm() + depths.of(e.v0) + depths.of(e.v1) <= 2.0 * known) continue;
    poll();
    known = std::max(known, -lowest_on_segment(p, q, [&](const Vec3& x) { return signed_distance(solid, x); }));
  }
  return known;
}

/// Solids in one place have every vertex and edge of the one on the other's surface, as solids that touch have: the deepest
/// in the other of points well inside either, metres.
double inner_overlap(const Solid& a, const Solid& b) {
  double deepest = 0.0;
  for (const auto& [own, other] : {std::pair(&a, &b), std::pair(&b, &a)}) {
    if (own->shape->mesh() == nullptr) continue;
    check_interrupt();
    for (const Vec3& x : own->points_inside())
      if (overlap(other->bounds, Aabb{x, x}))
        deepest = std::max(deepest, other->shape->mesh() ? depth_in_mesh(*other, x) : -signed_distance(*other, x));
  }
  return deepest;
}

/// Whether a depth is what rounding makes of a surface that lies on another.
bool may_coincide(const Solid& a, const Solid& b, double depth) {
  return depth <= kOnSurface * std::min(a.bounds.extent().norm(), b.bounds.extent().norm());
}

double deepest_below(const Solid& plane, const Solid& mesh) {
  double depth = 0.0;
  for (const Vec3& v : mesh.vertices) depth = std::max(depth, -signed_distance(plane, v));
  return depth;
}

Overlap mesh_with_shape(const Solid& mesh, const Solid& solid) {
  check_interrupt();
  if (solid.shape->as<Plane>() != nullptr) {
    const double depth = deepest_below(solid, mesh);
    return {depth, depth};
  }
  double depth = 0.0;
  const Aabb box =
      solid.bounds.inflated(kOnSurface * (solid.bounds.extent().norm() + largest_coordinate(solid.bounds)));
  VertexDepths near{mesh.search().vertices_near(box), {}};
  for (const int v : near.vertices) {
    near.depths.push_back(-signed_distance(solid, mesh.vertices[static_cast<std::size_t>(v)]));
    depth = std::max(depth, near.depths.back());
  }
  Vec3 p, q;
  double radius = 0.0;
  if (centre_line(solid, p, q, radius)) {
    // the surface reaches `radius` beyond its centre line, which itself is sampled: a mesh's distance is not convex
    const int samples = (q - p).norm() > 0.0 ? 33 : 1;
    for (int i = 0; i < samples; ++i) {
      check_interrupt();
      const Vec3 x = p + (samples == 1 ? 0.0 : i / (samples - 1.0)) * (q - p);
      const double distance = mesh.search().distance(x);
      const bool inside = mesh.search().winding(x) > 0.5;
      depth = std::max(depth, radius + (inside ? distance : -distance));
    }
  } else {
    // corners of a polyhedron, points on the surface of anything else
    std::vector<Vec3> points = solid.shape->drawn().vertices;
    for (Vec3& x : points) x = solid.pose.apply(x);
    depth = std::max(depth, points_in_mesh(points, mesh));
  }
  const double edges = edges_in_solid(mesh, solid, box, near, depth);
  return {depth, may_coincide(mesh, solid, edges) ? std::max(edges, inner_overlap(mesh, solid)) : edges};
}

/// The deepest of the vertices of `own` inside a mesh.
double vertices_in_mesh(const Solid& own, const Solid& mesh) {
  std::vector<Vec3> points;
  for (const int v : own.search().vertices_near(mesh.bounds))
    points.push_back(own.vertices[static_cast<std::size_t>(v)]);
  return points_in_mesh(points, mesh);
}

Overlap mesh_with_mesh(const Solid& a, const Solid& b) {
  Overlap found;
  std::vector<EdgeHit> of_a, of_b;
  InterruptPoll poll;
  for (const int t_a : a.search().triangles_near(b.bounds))
    for (const int t_b : b.search().triangles_near(a.search().box(t_a))) {
      poll();
      const TriangleCorners corners_a = a.search().corners(t_a), corners_b = b.search().corners(t_b);
      if (!triangles_intersect(corners_a, corners_b)) continue;
      ++found.crossings;
      add_edge_hits(a.search().triangles()[static_cast<std::size_t>(t_a)], a.vertices, corners_b, of_a);
      add_edge_hits(b.search().triangles()[static_cast<std::size_t>(t_b)], b.vertices, corners_a, of_b);
    }
  found.vertices = std::max(vertices_in_mesh(a, b), vertices_in_mesh(b, a));
  found.edges = deepest_of_edges(std::move(of_a), a.vertices, b.search(), found.vertices);
  found.edges = deepest_of_edges(std::move(of_b), b.vertices, a.search(), found.edges);
  if (found.crossings > 0 && may_coincide(a, b, found.edges)) found.edges = std::max(found.edges, inner_overlap(a, b));
  return found;
}

double shapes_penetration(const Solid& a, const Solid& b) {
  Vec3 p, q;
  double radius = 0.0;
  for (const auto& [line, other] : {std::pair(&a, &b), std::pair(&b, &a)})
    if (centre_line(*line, p, q, radius))
      return std::max(0.0, radius - lowest_on_segment(p, q, [&, solid = other](const Vec3& x) {
                             return signed_distance(*solid, x);
                           }));
  const Plane *plane_a = a.shape->as<Plane>(), *plane_b = b.shape->as<Plane>();
  if (plane_a != nullptr && plane_b != nullptr) return 0.0;
  if (plane_a == nullptr && plane_b == nullptr) return least_overlap({convex_of(a), a.pose}, {convex_of(b), b.pose});
  const Solid &plane = plane_a != nullptr ? a : b, &solid = plane_a != nullptr ? b : a;
  const Vec3 down = solid.pose.rotation.transpose() * (plane.pose.rotation * -plane.shape->as<Plane>()->normal);
  const ConvexSet& convex = *convex_of(solid);
  const Vec3 lowest = convex.support(down) + convex.rounding() * down;
  return std::max(0.0, -signed_distance(plane, solid.pose.apply(lowest)));
}

Overlap overlap_of(const Solid& a, const Solid& b) {
  const bool mesh_a = a.shape->mesh() != nullptr, mesh_b = b.shape->mesh() != nullptr;
  if (mesh_a && mesh_b) return mesh_with_mesh(a, b);
  if (mesh_a || mesh_b) return mesh_a ? mesh_with_shape(a, b) : mesh_with_shape(b, a);
  const double depth = shapes_penetration(a, b);
  return {depth, depth};
}

}  // namespace

const NodeRims& JudgeMemory::rims_of(const SharedShape& mesh) {
  const SurfaceMesh* surface = mesh->mesh();
  const auto it = kept_.find(surface);
  if (it != kept_.end()) return it->second.rims;
  return kept_.emplace(surface, Kept{mesh, NodeRims(surface->tree(), surface->mesh.triangles)}).first->second.rims;
}

OverlapVerdict judge_overlap(const Bodies& bodies) {
  JudgeMemory memory;
  return judge_overlap(bodies, memory);
}

OverlapVerdict judge_overlap(const Bodies& bodies, JudgeMemory& memory) {
  std::vector<std::vector<Solid>> solids;
  for (const Body& body : bodies) solids.push_back(solids_of(body, memory));
  OverlapVerdict verdict;
  for (BodyIndex i(0); i < bodies.size(); ++i)
    for (BodyIndex j(i + 1); j < bodies.size(); ++j) {
      if (bodies[i].deleted || bodies[j].deleted) continue;
      if ((!bodies[i].has_freedom() && !bodies[j].has_freedom()) || bodies.never_touch(i, j)) continue;
      for (const Solid& a : solids[i])
        for (const Solid& b : solids[j]) {
          if (!overlap(a.bounds, b.bounds)) continue;
          const Overlap found = overlap_of(a, b);
          verdict.intersections += found.crossings;
          if (found.edges == 0.0) continue;
          verdict.deepest = std::max(verdict.deepest, found.edges);
          const double thickness = std::min(wall_of(*bodies[i].shape), wall_of(*bodies[j].shape));
          if (found.edges / thickness > verdict.crossing.share())
            verdict.crossing = {bodies[i].name, bodies[j].name, found.edges, thickness, 0};
          if (found.vertices <= verdict.penetration) continue;
          verdict.penetration = found.vertices;
          verdict.body_a = static_cast<int>(i);
          verdict.body_b = static_cast<int>(j);
        }
    }
  return verdict;
}

}  // namespace impinge
