#include "engine/bodies/deformable_body.hpp"

#include <algorithm>
#include <limits>

#include "engine/core/archive.hpp"
#include "engine/core/error.hpp"

namespace impinge {

DeformableBody::DeformableBody(FemAssembly assembly) : fem(std::move(assembly)) {
  mass = fem.total_mass();
  const int n = fem.nodes();
  position.resize(3 * n);
  for (int i = 0; i < n; ++i) position.segment<3>(3 * i) = fem.rest().vertices[i];
  velocity.setZero(3 * n);
  acceleration.setZero(3 * n);
  external_force.setZero(3 * n);
  hold({});
}

void DeformableBody::hold(std::span<const int> held) {
  const int n = nodes();
  free_index_.assign(n, 0);
  for (const int i : held) {
    IMPINGE_ASSERT(i >= 0 && i < n);
    free_index_[i] = -1;
  }
  free_node_.clear();
  for (int i = 0; i < n; ++i)
    if (free_index_[i] == 0) {
      free_index_[i] = static_cast<int>(free_node_.size());
      free_node_.push_back(i);
    } else {
      velocity.segment<3>(3 * i).setZero();
      acceleration.segment<3>(3 * i).setZero();
    }
  held_velocity_.setZero(3 * n);
  acceleration_known = false;
  free_pattern_ = std::make_shared<BlockPattern>(sub_pattern(*fem.pattern(), free_index_, free_source_));
}

void DeformableBody::set_held_velocity(int node, const Vec3& v) {
  IMPINGE_ASSERT(node >= 0 && node < nodes() && is_held(node));
  held_velocity_.segment<3>(3 * node) = v;
}

VecX DeformableBody::gather_free(const VecX& all) const {
  VecX free(dofs());
  for (int i = 0; i < free_nodes(); ++i) free.segment<3>(3 * i) = all.segment<3>(3 * free_node_[i]);
  return free;
}

void DeformableBody::scatter_free(const VecX& free, VecX& all) const {
  for (int i = 0; i < free_nodes(); ++i) all.segment<3>(3 * free_node_[i]) = free.segment<3>(3 * i);
}

VecX DeformableBody::with_held(const VecX& free) const {
  VecX all = held_velocity_;
  scatter_free(free, all);
  return all;
}

double DeformableBody::kinetic_energy() const {
  VecX momenta;
  fem.multiply_mass(velocity, momenta);
  return 0.5 * dot(velocity, momenta);
}

double DeformableBody::potential_energy(const Vec3& gravity) const {
  double sum = 0.0;
  for (int i = 0; i < nodes(); ++i) sum -= fem.node_mass()[i] * gravity.dot(position.segment<3>(3 * i));
  return sum;
}

Vec3 DeformableBody::momentum() const {
  VecX momenta;
  fem.multiply_mass(velocity, momenta);
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < nodes(); ++i) sum += momenta.segment<3>(3 * i);
  return sum;
}

Vec3 DeformableBody::angular_momentum() const {
  VecX momenta;
  fem.multiply_mass(velocity, momenta);
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < nodes(); ++i) sum += Vec3(position.segment<3>(3 * i)).cross(Vec3(momenta.segment<3>(3 * i)));
  return sum;
}

Balance DeformableBody::balance(const Vec3& gravity) {
  return {kinetic_energy(), elastic_energy(), potential_energy(gravity), momentum(), angular_momentum()};
}

double DeformableBody::fastest_point() const {
  double fastest = 0.0;
  for (int i = 0; i < nodes(); ++i) fastest = std::max(fastest, velocity.segment<3>(3 * i).norm());
  return fastest;
}

Vec3 DeformableBody::center_of_mass() const {
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < nodes(); ++i) sum += fem.node_mass()[i] * position.segment<3>(3 * i);
  return sum / fem.total_mass();
}

double DeformableBody::smallest_volume_ratio() const {
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t e = 0; e < fem.elements().size(); ++e) {
    Corners x;
    for (int k = 0; k < 4; ++k) x.col(k) = position.segment<3>(3 * fem.rest().tets[e][k]);
    smallest = std::min(smallest, deformation_gradient(fem.elements()[e], x).determinant());
  }
  return smallest;
}

void DeformableBody::come_to_rest() {
  catch_up();
  velocity.setZero();
  set_center_velocity(Vec3::Zero());
}

void DeformableBody::push(const Vec3& impulse, const std::optional<Vec3>& at) {
  VecX change = VecX::Zero(dofs());
  if (at) {
    for (const auto& [node, weight] : nodes_of(nearest_point(*at)))
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

void DeformableBody::save(ByteWriter& out) const {
  save_frame(out, center_velocity_, Vec3::Zero(), Vec3::Zero());
  out.put(acceleration_known);
  for (const HeldRegion& region : held) out.put(region.displacement), out.put(region.wanted);
  for (const VecX* x : {&position, &velocity, &acceleration})
    for (Eigen::Index i = 0; i < x->size(); ++i) out.put((*x)[i]);
  if (lag == 0.0) return;
  out.put(lead_.size() > 0);
  for (Eigen::Index i = 0; i < lead_.size(); ++i) out.put(lead_[i]);
}

void DeformableBody::stay(ByteReader& start) {
  const VecX moved = position, v = velocity, a = acceleration, lead = lead_;
  const double late = lag;
  const bool is_known = acceleration_known;
  const std::vector<HeldRegion> regions = held;
  const Vec3 center = center_velocity_, gravity = lag_gravity;
  restore(start);
  for (int node = 0; node < nodes(); ++node)
    if (is_held(node)) position.segment<3>(3 * node) = moved.segment<3>(3 * node);
  velocity = v, lead_ = lead, lag = late, lag_gravity = gravity, acceleration = a, acceleration_known = is_known,
  held = regions, center_velocity_ = center;
  interpolate(embedding, fem.rest(), velocity, surface_velocity_);
}

void DeformableBody::restore(ByteReader& in) {
  center_velocity_ = restore_frame(in).velocity;
  acceleration_known = in.get<bool>();
  for (HeldRegion& region : held) region.displacement = in.get_vec3(), region.wanted = in.get_vec3();
  for (VecX* x : {&position, &velocity, &acceleration})
    for (Eigen::Index i = 0; i < x->size(); ++i) (*x)[i] = in.get<double>();
  lead_.resize(lag != 0.0 && in.get<bool>() ? velocity.size() : 0);
  for (Eigen::Index i = 0; i < lead_.size(); ++i) lead_[i] = in.get<double>();
  interpolate(embedding, fem.rest(), velocity, surface_velocity_);
}

}  // namespace impinge
