#include "engine/world/judge.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/interrupt.hpp"
#include "engine/core/parallel.hpp"
#include "engine/geometry/inside.hpp"
#include "engine/geometry/triangle_intersection.hpp"

namespace impinge {
namespace {

/// Signed distance of a world point from an exact shape's surface, negative inside. Metres.
double signed_distance(const RigidBody& body, const Vec3& world) {
  const Vec3 x = body.pose.apply_inverse(world);
  if (const auto* p = std::get_if<Plane>(&body.shape)) return p->normal.dot(x) - p->offset;
  if (const auto* s = std::get_if<Sphere>(&body.shape)) return x.norm() - s->radius;
  if (const auto* c = std::get_if<Capsule>(&body.shape))
    return (x - Vec3(0, std::clamp(x.y(), -c->half_length, c->half_length), 0)).norm() - c->radius;
  const Vec3 q = x.cwiseAbs() - std::get<Box>(body.shape).half;
  return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
}

/// How deep two boxes overlap along the best of their 15 axes; 0 if one separates them. Metres.
double box_overlap(const RigidBody& a, const RigidBody& b) {
  const Vec3 half_a = std::get<Box>(a.shape).half, half_b = std::get<Box>(b.shape).half;
  const Vec3 between = b.pose.position - a.pose.position;
  double best = std::numeric_limits<double>::infinity();
  const auto try_axis = [&](const Vec3& axis) {
    const double length = axis.norm();
    if (length < 1e-9) return;  // parallel edges: their axis is covered by the faces
    const double reach = (a.pose.rotation.transpose() * axis).cwiseAbs().dot(half_a) +
                         (b.pose.rotation.transpose() * axis).cwiseAbs().dot(half_b);
    best = std::min(best, (reach - std::abs(axis.dot(between))) / length);
  };
  for (int i = 0; i < 3; ++i) {
    try_axis(a.pose.rotation.col(i));
    try_axis(b.pose.rotation.col(i));
    for (int j = 0; j < 3; ++j) try_axis(a.pose.rotation.col(i).cross(b.pose.rotation.col(j)));
  }
  return std::max(0.0, best);
}

/// The segment inside a sphere (a point) or capsule, and its radius.
bool centre_line(const RigidBody& body, Vec3& p, Vec3& q, double& radius) {
  if (const auto* s = std::get_if<Sphere>(&body.shape)) {
    p = q = body.pose.position;
    radius = s->radius;
    return true;
  }
  if (const auto* c = std::get_if<Capsule>(&body.shape)) {
    p = body.pose.apply(Vec3(0, -c->half_length, 0));
    q = body.pose.apply(Vec3(0, c->half_length, 0));
    radius = c->radius;
    return true;
  }
  return false;
}

std::span<const Triangle> triangles_of(const RigidBody& body) {
  return std::get<MeshPointer>(body.shape)->mesh.triangles;
}

double depth_in_mesh(const RigidBody& mesh, const Vec3& x) {
  if (winding_number(x, mesh.world_vertices, triangles_of(mesh)) < 0.5) return 0.0;
  return distance_to_surface(x, mesh.world_vertices, triangles_of(mesh));
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

double vertices_in_mesh(const RigidBody& source, const RigidBody& mesh) {
  const Aabb box = mesh.bounds();
  std::vector<Vec3> inside_box;
  for (const Vec3& v : source.world_vertices)
    if (overlap(box, Aabb{v, v})) inside_box.push_back(v);
  std::vector<double> depth(inside_box.size());
  parallel_for(inside_box.size(), 8, [&](std::size_t i) { depth[i] = depth_in_mesh(mesh, inside_box[i]); });
  return depth.empty() ? 0.0 : *std::max_element(depth.begin(), depth.end());
}

double mesh_with_shape(const RigidBody& mesh, const RigidBody& shape) {
  double depth = 0.0;
  check_interrupt();
  for (const Vec3& v : mesh.world_vertices) depth = std::max(depth, -signed_distance(shape, v));
  if (const auto* box = std::get_if<Box>(&shape.shape)) {
    for (int i = 0; i < 8; ++i) {
      const Vec3 corner((i & 1 ? 1 : -1) * box->half.x(), (i & 2 ? 1 : -1) * box->half.y(),
                        (i & 4 ? 1 : -1) * box->half.z());
      const Vec3 x = shape.pose.apply(corner);
      if (overlap(mesh.bounds(), Aabb{x, x})) depth = std::max(depth, depth_in_mesh(mesh, x));
    }
  }
  Vec3 p, q;
  double radius = 0.0;
  if (centre_line(shape, p, q, radius)) {
    // the surface reaches `radius` beyond its centre line, which itself is sampled: a mesh's distance is not convex
    const int samples = (q - p).norm() > 0.0 ? 33 : 1;
    for (int i = 0; i < samples; ++i) {
      check_interrupt();
      const Vec3 x = p + (samples == 1 ? 0.0 : i / (samples - 1.0)) * (q - p);
      const double distance = distance_to_surface(x, mesh.world_vertices, triangles_of(mesh));
      const bool inside = winding_number(x, mesh.world_vertices, triangles_of(mesh)) > 0.5;
      depth = std::max(depth, radius + (inside ? distance : -distance));
    }
  }
  return depth;
}

double pair_penetration(const RigidBody& a, const RigidBody& b) {
  const bool mesh_a = is_mesh(a.shape), mesh_b = is_mesh(b.shape);
  if (mesh_a && mesh_b) return std::max(vertices_in_mesh(a, b), vertices_in_mesh(b, a));
  if (mesh_a || mesh_b) return mesh_a ? mesh_with_shape(a, b) : mesh_with_shape(b, a);
  Vec3 p, q;
  double radius = 0.0;
  for (const auto& [line, other] : {std::pair(&a, &b), std::pair(&b, &a)})
    if (centre_line(*line, p, q, radius))
      return std::max(0.0, radius - lowest_on_segment(p, q, [&](const Vec3& x) { return signed_distance(*other, x); }));
  const bool plane_a = std::holds_alternative<Plane>(a.shape), plane_b = std::holds_alternative<Plane>(b.shape);
  if (plane_a && plane_b) return 0.0;
  if (!plane_a && !plane_b) return box_overlap(a, b);
  const RigidBody& box = plane_a ? b : a;
  const Vec3 half = std::get<Box>(box.shape).half;
  double depth = 0.0;
  for (int i = 0; i < 8; ++i)
    depth = std::max(depth, -signed_distance(plane_a ? a : b, box.pose.apply(Vec3((i & 1 ? 1 : -1) * half.x(),
                                                                                  (i & 2 ? 1 : -1) * half.y(),
                                                                                  (i & 4 ? 1 : -1) * half.z()))));
  return depth;
}

std::int64_t crossing_triangles(const RigidBody& a, const RigidBody& b) {
  const auto corners = [](const RigidBody& body, const Triangle& t) {
    return TriangleCorners{body.world_vertices[t[0]], body.world_vertices[t[1]], body.world_vertices[t[2]]};
  };
  const auto near = [&](const RigidBody& body, const Aabb& region) {
    std::vector<std::pair<Aabb, TriangleCorners>> list;
    for (const Triangle& t : triangles_of(body)) {
      const TriangleCorners c = corners(body, t);
      const Aabb box = bounds_of(c[0], c[1], c[2]);
      if (overlap(box, region)) list.emplace_back(box, c);
    }
    return list;
  };
  const auto list_a = near(a, b.bounds()), list_b = near(b, a.bounds());
  std::int64_t count = 0;
  InterruptPoll poll;
  for (const auto& [box_a, corners_a] : list_a)
    for (const auto& [box_b, corners_b] : list_b) {
      poll();
      if (overlap(box_a, box_b) && triangles_intersect(corners_a, corners_b)) ++count;
    }
  return count;
}

}  // namespace

OverlapVerdict judge_overlap(std::span<const RigidBody> bodies) {
  OverlapVerdict verdict;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    for (std::size_t j = i + 1; j < bodies.size(); ++j) {
      const RigidBody &a = bodies[i], &b = bodies[j];
      if (!a.has_freedom() && !b.has_freedom()) continue;
      if (!overlap(a.bounds(), b.bounds())) continue;
      if (is_mesh(a.shape) && is_mesh(b.shape)) verdict.intersections += crossing_triangles(a, b);
      const double depth = pair_penetration(a, b);
      if (depth <= verdict.penetration) continue;
      verdict.penetration = depth;
      verdict.body_a = static_cast<int>(i);
      verdict.body_b = static_cast<int>(j);
    }
  return verdict;
}

}  // namespace impinge
