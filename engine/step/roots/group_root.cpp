#include "engine/step/roots/group_root.hpp"

#include "engine/core/finite.hpp"

namespace impinge {

GroupRoot::GroupRoot(Bodies& bodies, const DeformableIntegrator& integrator, const NewtonSettings& newton,
                     const AssembledGroup& first)
    : bodies_(bodies), integrator_(integrator), search_(newton.tolerance, newton.max_iterations) {
  for (const DeformableBlock& block : first.system.deformable) at_.push_back(block.velocity);
  for (const ContactRows& row : first.system.contacts) bounds_.push_back(row.bound);
}

double GroupRoot::residual_of(const AssembledGroup& answer) {
  const GroupSystem& s = answer.system;
  residual_ = 0.0;
  to_.clear();
  for (std::size_t k = 0; k < answer.deformable.size(); ++k) {
    to_.push_back(s.deformable[k].velocity + s.deformable_delta[k]);
    residual_ =
        larger(residual_, bodies_[answer.deformable[k]].relinearize(
                              integrator_, s.deformable_delta[k], s.deformable_impulse(static_cast<int>(k), s.lambda)));
  }
  return residual_;
}

void GroupRoot::go_on(const AssembledGroup& answer, bool is_last) {
  const std::vector<DeformableBlock>& blocks = answer.system.deformable;
  std::vector<const BlockMatrix*> a;
  for (const DeformableBlock& block : blocks) a.push_back(block.a);
  at_ = search_.next(at_, to_, residual_, a);
  if (is_last && !search_.best().empty()) at_ = search_.best();
  for (std::size_t k = 0; k < answer.deformable.size(); ++k) {
    Body& body = bodies_[answer.deformable[k]];
    if (is_controlled()) body.relinearize(integrator_, at_[k] - blocks[k].velocity, VecX::Zero(at_[k].size()));
    body.solve_again();
  }
}

void GroupRoot::keep_bounds(GroupSystem& system) const {
  for (std::size_t i = 0; is_controlled() && i < bounds_.size(); ++i) system.contacts[i].bound = bounds_[i];
}

}  // namespace impinge
