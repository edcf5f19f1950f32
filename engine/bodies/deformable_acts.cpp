// What somebody does to a deformable body, and which point of it is meant.
#include "engine/bodies/deformable_body.hpp"
#include "engine/core/error.hpp"

namespace impinge {

/// With the nodes at `nodes`.
MaterialPoint DeformableBody::nearest_point(const Vec3& world, const VecX& nodes) const {
  TetMesh mesh = fem.rest();
  for (int i = 0; i < this->nodes(); ++i) mesh.vertices[i] = nodes.segment<3>(3 * i);
  const Embedding place = embed(mesh, std::span(&world, 1));
  MaterialPoint point;
  point.tet = place.tet[0];
  // a point outside is carried with negative weights, by a lever: the nearest one inside has none
  point.weight = place.weight[0].cwiseMax(0.0);
  point.weight /= point.weight.sum();
  return point;
}

MaterialPoint DeformableBody::own_point(const Vec3& own) const {
  if (pull && pull->point.local == own) return pull->point;  // a drag asks in every frame
  VecX rest(position.size());
  for (int i = 0; i < nodes(); ++i) rest.segment<3>(3 * i) = rest_position(i);
  MaterialPoint point = nearest_point(own, rest);
  point.local = own;
  return point;
}

Vec3 DeformableBody::own_coordinates(const Vec3& world) const {
  Vec3 own = Vec3::Zero();
  for (const auto& [node, weight] : nodes_of(nearest_point(world, position))) own += weight * rest_position(node);
  return own;
}

std::array<NodeWeight, 4> DeformableBody::nodes_of(const MaterialPoint& point) const {
  std::array<NodeWeight, 4> list;
  for (int k = 0; k < 4; ++k) list[k] = {fem.rest().tets[point.tet][k], point.weight[k]};
  return list;
}

void DeformableBody::push(const Vec3& impulse, const std::optional<Vec3>& at) {
  VecX change = VecX::Zero(dofs());
  if (at) {
    for (const auto& [node, weight] : nodes_of(nearest_point(*at, position)))
      if (!is_held(node)) change.segment<3>(3 * free_index_[node]) += weight * impulse;
    BlockMatrix m(free_pattern_);
    for (std::size_t i = 0; i < free_source_.size(); ++i)
      m.values[i].diagonal().setConstant(fem.block_mass()[free_source_[i]]);
    const std::unique_ptr<LinearSolver> solver = make_linear_solver("conjugate_gradient");
    solver->tolerance = 1e-14;
    solver->analyze(*free_pattern_);
    const VecX momentum = change;
    change.setZero();
    if (solver->factorize(m) == SolveStatus::ok) solver->solve(momentum, change);
  } else {
    for (int i = 0; i < free_nodes(); ++i) change.segment<3>(3 * i) = impulse / mass;
  }
  VecX all = VecX::Zero(velocity.size());
  scatter_free(change, all);
  velocity += all;
  acceleration_known = false;
  center_velocity_ = momentum() / mass;
  interpolate(embedding, fem.rest(), velocity, surface_velocity_);
}

void DeformableBody::shift(const Vec3& by, const Mat3& turn) {
  IMPINGE_ASSERT(turn.isIdentity(0.0));
  for (int i = 0; i < nodes(); ++i) position.segment<3>(3 * i) += by;
  for (HeldRegion& region : held) region.displacement += by, region.wanted += by;  // what is held is held elsewhere
  update_world_vertices();
}

}  // namespace impinge
