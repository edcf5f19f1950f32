#include "engine/frozen/frozen_step.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace impinge {

std::size_t FrozenStep::contacts() const {
  std::size_t sum = 0;
  for (const FrozenGroup& group : groups) sum += group.system.contacts.size();
  return sum;
}

std::string_view FrozenStep::setting(std::string_view path) const {
  for (const auto& [known, value] : settings)
    if (known == path) return value;
  return "";
}

bool FrozenStep::is_block_diagonal() const {
  return std::all_of(groups.begin(), groups.end(), [](const FrozenGroup& group) {
    return std::all_of(group.system.deformable.begin(), group.system.deformable.end(),
                       [](const DeformableBlock& block) { return block.is_diagonal; });
  });
}

bool is_finite(const GroupAnswer& answer) {
  const auto finite = [](const auto& v) { return v.allFinite(); };
  return std::all_of(answer.lambda.begin(), answer.lambda.end(), finite) &&
         std::all_of(answer.delta_velocity.begin(), answer.delta_velocity.end(), finite) &&
         std::all_of(answer.delta_angular_velocity.begin(), answer.delta_angular_velocity.end(), finite) &&
         std::all_of(answer.deformable_delta.begin(), answer.deformable_delta.end(), finite);
}

FrozenGroup freeze(const GroupSystem& system) {
  FrozenGroup frozen;
  frozen.system = system;
  frozen.system.assembled.reset(), frozen.system.between_nodes.reset();
  for (DeformableBlock& block : frozen.system.deformable) {
    frozen.matrices.push_back(*block.a);
    block.a = nullptr;
    block.solver = nullptr;
  }
  return frozen;
}

ThawedGroup thaw(const FrozenGroup& group, const LinearSolverChoice& linear_solver) {
  ThawedGroup thawed;
  thawed.system = group.system;
  for (std::size_t s = 0; s < group.matrices.size(); ++s) {
    const BlockMatrix& a = group.matrices[s];
    thawed.solvers.push_back(linear_solver.make(a.rows(), kContactRightHandSides));
    thawed.solvers.back()->analyze(*a.pattern);
    thawed.system.deformable[s].a = &a;
    thawed.system.deformable[s].solver = thawed.solvers.back().get();
  }
  return thawed;
}

double energy_product(const FrozenGroup& group, const GroupAnswer& x, const GroupAnswer& y) {
  double sum = 0.0;
  for (std::size_t b = 0; b < group.system.rigid.size(); ++b) {
    const RigidBlock& block = group.system.rigid[b];
    sum += x.delta_velocity[b].dot(y.delta_velocity[b]) / block.inverse_mass;
    sum += x.delta_angular_velocity[b].dot(Mat3(block.inverse_inertia.inverse()) * y.delta_angular_velocity[b]);
  }
  for (std::size_t s = 0; s < group.matrices.size(); ++s)
    sum += dot(x.deformable_delta[s], group.matrices[s] * y.deformable_delta[s]);
  return sum;
}

double energy_distance(const FrozenGroup& group, const GroupAnswer& x, const GroupAnswer& y) {
  GroupAnswer difference = x;
  for (std::size_t b = 0; b < x.delta_velocity.size(); ++b) {
    difference.delta_velocity[b] -= y.delta_velocity[b];
    difference.delta_angular_velocity[b] -= y.delta_angular_velocity[b];
  }
  for (std::size_t s = 0; s < x.deformable_delta.size(); ++s) difference.deformable_delta[s] -= y.deformable_delta[s];
  return std::sqrt(std::max(0.0, energy_product(group, difference, difference)));
}

}  // namespace impinge
