// Box against mesh. A box is a polyhedron, so its twelve triangles are the box exactly: the contacts are those of two
// meshes, found with the box's own frame as the search structure. The box still counts as an exact shape: triangle -1.
#include <algorithm>

#include "engine/narrowphase/box_mesh.hpp"
#include "engine/narrowphase/contact_points.hpp"
#include "engine/narrowphase/triangle_pair_test.hpp"

namespace impinge {
namespace {

/// Triangles of the mesh that reach into the box widened by the margin.
std::vector<int> triangles_near_box(const Collider& mesh, const Collider& box, double margin) {
  const Vec3 reach = std::get<Box>(*box.shape).half + Vec3::Constant(margin);
  const Aabb local{-reach, reach}, world = box.bounds.inflated(margin);
  std::vector<int> near;
  const std::vector<Triangle>& triangles = mesh.mesh().mesh.triangles;
  for (int t = 0; t < static_cast<int>(triangles.size()); ++t) {
    const TriangleCorners c = corners_of(mesh, t);
    if (!overlap(bounds_of(c[0], c[1], c[2]), world)) continue;
    if (overlap(bounds_of(box.pose.apply_inverse(c[0]), box.pose.apply_inverse(c[1]), box.pose.apply_inverse(c[2])), local)) near.push_back(t);
  }
  return near;
}

}  // namespace

void box_mesh_contacts(std::span<const Collider> colliders, const BodyPair& pair, const ContactQuery& query, std::vector<Collision>& contacts) {
  const bool box_first = !is_mesh(*colliders[pair.a].shape);
  Collider both[2] = {colliders[pair.a], colliders[pair.b]};
  Collider& box = both[box_first ? 0 : 1];
  const Collider& mesh = both[box_first ? 1 : 0];
  const double margin = std::max(pair.margin, query.proximity ? query.activation : 0.0);
  const std::vector<int> near = triangles_near_box(mesh, box, margin);
  if (near.empty()) return;

  const Shape twelve = make_box_mesh(std::get<Box>(*box.shape).half);
  std::vector<Vec3> corners = std::get<MeshPointer>(twelve)->mesh.vertices;
  for (Vec3& v : corners) v = box.pose.apply(v);
  box.shape = &twelve;
  box.vertices = corners;

  std::vector<TrianglePair> triangles;
  for (int t = 0; t < 12; ++t)
    for (int m : near) {
      const int ta = box_first ? t : m, tb = box_first ? m : t;
      const PairState state = test_triangles(corners_of(both[0], ta), corners_of(both[1], tb), margin);
      if (state != PairState::apart) triangles.push_back({0, 1, ta, tb, state == PairState::intersecting});
    }
  std::sort(triangles.begin(), triangles.end());
  if (triangles.empty()) return;

  const std::size_t begin = contacts.size();
  const BodyPair local{0, 1, margin};
  if (query.proximity)
    proximity_contacts(both, local, triangles, query.activation, query.time_step, contacts);
  else
    intersection_contacts(both, local, triangles, contacts);
  for (std::size_t i = begin; i < contacts.size(); ++i) {
    Collision& c = contacts[i];
    c.body_a = pair.a;
    c.body_b = pair.b;
    (box_first ? c.triangle_a : c.triangle_b) = -1;
    if (c.normal_owner >= 0) c.normal_owner = c.normal_owner == 0 ? pair.a : pair.b;
  }
}

}  // namespace impinge
