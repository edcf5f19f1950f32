// The surface of a deformable body and points in it: what carries them, and where they are.
#include <fmt/format.h>

#include <algorithm>

#include "engine/bodies/deformable_body.hpp"
#include "engine/core/error.hpp"
#include "engine/geometry/distance.hpp"

namespace impinge {
namespace {

// in heights of the nearest tetrahedron: farther out, a small strain of it would be a large motion of the point
constexpr double kMostOutside = 1.0;

Vec3 interpolated(const std::vector<NodeWeight>& nodes, const VecX& values) {
  Vec3 sum = Vec3::Zero();
  for (const NodeWeight& n : nodes) sum += n.weight * values.segment<3>(3 * n.node);
  return sum;
}

}  // namespace

void DeformableBody::update_world_vertices() {
  if (!shape || shape->mesh() == nullptr) return;
  interpolate(embedding, fem.rest(), position, world_vertices);
  find_vertex_bounds();
}

void DeformableBody::set_center_velocity(const Vec3& v) {
  center_velocity_ = v;
  surface_velocity_.assign(world_vertices.size(), v);
}

MaterialPoint DeformableBody::surface_point(TriangleIndex triangle, const Vec3& world) const {
  const Triangle& t = shape->mesh()->mesh.triangles[triangle];
  MaterialPoint point;
  point.triangle = triangle;
  point.local = nearest_weights(world, {world_vertices[t[0]], world_vertices[t[1]], world_vertices[t[2]]});
  return point;
}

MaterialPoint DeformableBody::inner_point(const Vec3& world) const {
  TetMesh now = fem.rest();
  for (int i = 0; i < nodes(); ++i) now.vertices[i] = position.segment<3>(3 * i);
  const Embedding place = embed(now, std::span(&world, 1));
  if (place.farthest > kMostOutside)
    throw InputError(
        fmt::format("{:.2g} tetrahedron heights outside of the deformable body '{}'", place.farthest, name));
  MaterialPoint point;
  point.local = world;
  point.tet = place.tet[0];
  point.weight = place.weight[0];
  return point;
}

Vec3 DeformableBody::position_of(const MaterialPoint& point) const {
  if (point.triangle.is_none()) {
    Vec3 x = Vec3::Zero();
    const Tet& nodes = fem.rest().tets[point.tet];
    for (int k = 0; k < 4; ++k) x += point.weight[k] * position.segment<3>(3 * nodes[k]);
    return x;
  }
  const Triangle& t = shape->mesh()->mesh.triangles[point.triangle];
  return point.local.x() * world_vertices[t[0]] + point.local.y() * world_vertices[t[1]] +
         point.local.z() * world_vertices[t[2]];
}

MaterialPoint DeformableBody::nearest_point(const Vec3& world) const {
  TetMesh now = fem.rest();
  for (int i = 0; i < nodes(); ++i) now.vertices[i] = position.segment<3>(3 * i);
  return nearest_point(world, now);
}

MaterialPoint DeformableBody::nearest_point(const Vec3& x, const TetMesh& mesh) {
  const Embedding place = embed(mesh, std::span(&x, 1));
  MaterialPoint point;
  point.tet = place.tet[0];
  // a point outside is carried with negative weights, by a lever: the nearest one inside has none
  point.weight = place.weight[0].cwiseMax(0.0);
  point.weight /= point.weight.sum();
  return point;
}

MaterialPoint DeformableBody::own_point(const Vec3& own) const {
  if (pull && pull->point.local == own) return pull->point;  // a drag asks in every frame
  MaterialPoint point = nearest_point(own, fem.rest());
  point.local = own;
  return point;
}

Vec3 DeformableBody::own_coordinates(const Vec3& world) const {
  Vec3 own = Vec3::Zero();
  for (const auto& [node, weight] : nodes_of(nearest_point(world))) own += weight * rest_position(node);
  return own;
}

std::array<NodeWeight, 4> DeformableBody::nodes_of(const MaterialPoint& point) const {
  std::array<NodeWeight, 4> list;
  for (int k = 0; k < 4; ++k) list[k] = {fem.rest().tets[point.tet][k], point.weight[k]};
  return list;
}

/// From its first node to the three others, by column.
Mat3 DeformableBody::edges_of(int tet) const {
  const Tet& nodes = fem.rest().tets[tet];
  Mat3 edges;
  for (int k = 0; k < 3; ++k) edges.col(k) = position.segment<3>(3 * nodes[k + 1]) - position.segment<3>(3 * nodes[0]);
  return edges;
}

// A plane is where a linear function of the tetrahedron's weights vanishes: what that gains along each edge stays.
Vec3 DeformableBody::material_normal(const MaterialPoint& point, const Vec3& world) const {
  return edges_of(point.tet).transpose() * world;
}

Vec3 DeformableBody::world_normal(const MaterialPoint& point, const Vec3& material) const {
  const Mat3 e = edges_of(point.tet);
  // the cofactors: the inverse's transpose without its division, which a flat tetrahedron has not
  const Vec3 normal = material.x() * e.col(1).cross(e.col(2)) + material.y() * e.col(2).cross(e.col(0)) +
                      material.z() * e.col(0).cross(e.col(1));
  return normal.normalized();
}

MaterialPoint DeformableBody::point_beside(const MaterialPoint& point, const Vec3& world) const {
  const Tet& nodes = fem.rest().tets[point.tet];
  const auto at = [&](int k) { return Vec3(position.segment<3>(3 * nodes[k])); };
  MaterialPoint beside = point;
  beside.local = world;
  beside.weight = barycentric(world, at(0), at(1), at(2), at(3));
  return beside;
}

/// Held ones too, every node once.
std::vector<NodeWeight> DeformableBody::carrying_nodes(const MaterialPoint& point) const {
  std::vector<NodeWeight> list;
  if (point.triangle.is_none()) {
    for (int k = 0; k < 4; ++k)
      if (point.weight[k] != 0.0) list.push_back({fem.rest().tets[point.tet][k], point.weight[k]});
    return list;
  }
  const Triangle& t = shape->mesh()->mesh.triangles[point.triangle];
  for (int k = 0; k < 3; ++k) {
    if (point.local[k] == 0.0) continue;
    const Tet& tet = fem.rest().tets[embedding.tet[t[k]]];
    for (int n = 0; n < 4; ++n) {
      const double weight = point.local[k] * embedding.weight[t[k]][n];
      if (weight == 0.0) continue;
      const auto at = std::find_if(list.begin(), list.end(), [&](const NodeWeight& w) { return w.node == tet[n]; });
      if (at == list.end())
        list.push_back({tet[n], weight});
      else
        at->weight += weight;
    }
  }
  return list;
}

CarriedPoint DeformableBody::carry(const MaterialPoint& point, const Vec3& /*at*/) const {
  // a row acts at the point itself: it is what moves with the nodes
  CarriedPoint carried;
  const std::vector<NodeWeight> nodes = carrying_nodes(point);
  carried.velocity_before = interpolated(nodes, velocity_before_);
  for (const NodeWeight& n : nodes) {
    const int free = free_index_[n.node];
    if (free >= 0)
      carried.nodes.push_back({free, n.weight});
    else
      carried.prescribed.push_back({n.weight, displacement_velocity_.segment<3>(3 * n.node)});
  }
  return carried;
}

}  // namespace impinge
