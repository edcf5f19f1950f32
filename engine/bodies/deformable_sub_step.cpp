// A deformable body's part in a sub-step: its open system A v = b, the solvers of A, and what follows from v.
#include <fmt/format.h>

#include "engine/algebra/thrifty_solver.hpp"
#include "engine/bodies/deformable_body.hpp"
#include "engine/bodies/time_integration.hpp"
#include "engine/core/error.hpp"
#include "engine/core/finite.hpp"

namespace impinge {

void DeformableBody::drive(double time, double h, double share) {
  for (HeldRegion& region : held) {
    const bool moved = region.is_moved();
    region.displacement =
        share >= 1.0 ? region.wanted : Vec3(region.displacement + share * (region.wanted - region.displacement));
    for (std::size_t k = 0; k < region.nodes.size(); ++k) {
      const Vec3 now = position.segment<3>(3 * region.nodes[k]);
      set_held_velocity(region.nodes[k], moved ? Vec3((region.at(k, time + h) - now) / h) : Vec3(Vec3::Zero()));
    }
  }
}

void DeformableBody::choose_solvers(const LinearSolverChoice& wanted) {
  if (solvers_.made_with == wanted && solvers_.pattern == free_pattern_) return;
  solvers_.made_with = wanted;
  solvers_.pattern = free_pattern_;
  solvers_.iterative = wanted.make(dofs(), 1);
  solvers_.direct = wanted.make(dofs(), kContactRightHandSides);
  solvers_.iterative->analyze(*free_pattern_);
  solvers_.direct->analyze(*free_pattern_);
}

void DeformableBody::check_solved() const {
  if (step_.linear_status != SolveStatus::not_finite && step_.linear_status != SolveStatus::not_positive_definite)
    return;
  throw DivergenceError(
      fmt::format("body '{}': its system matrix is {}; use more sub-steps or a softer material", name,
                  step_.linear_status == SolveStatus::not_finite ? "not finite" : "not positive definite"));
}

void DeformableBody::find_displacement_velocity() {
  displacement_velocity_ = (step_.s * with_held(step_.v_star) + step_.offset) / step_.time_step;
}

void DeformableBody::open_sub_step() {
  if (lead_.size() > 0) velocity -= lead_;
}

/// Half a sub-step on, as forces have changed it, and gravity since. Where impulses took part nobody knows which of them go on.
void DeformableBody::lead_on(const Vec3& changed) {
  lead_.resize(0);
  if (lag == 0.0 || touched_) return;
  lead_ = lag / kick * (velocity - velocity_before_);
  for (int i = 0; i < nodes(); ++i) lead_.segment<3>(3 * i) += lag * changed;
  for (int i = 0; i < nodes(); ++i)
    if (is_held(i)) lead_.segment<3>(3 * i).setZero();
  velocity += lead_;
}

void DeformableBody::find_free_velocity(const TimeIntegration& how) {
  choose_solvers(how.linear_solver);
  velocity_before_ = velocity;
  touched_ = false;
  is_explicit_ = how.integrator.is_explicit();
  const bool staggers = how.integrator.may_stagger();
  kick = staggers ? lag + how.ahead() : how.time_step;
  step_.kick = kick;
  how.integrator.begin(*this, mean_gravity(how), how.time_step, step_);
  ThriftySolver thrifty(*solvers_.iterative, *solvers_.direct);
  how.integrator.free_velocity(*this, step_, thrifty);
  check_solved();
  find_displacement_velocity();
  interpolate(embedding, fem.rest(), displacement_velocity_, surface_velocity_);
}

SystemBlock DeformableBody::system_block() const {
  return DeformableBlock{&step_.a,
                         solvers_.direct.get(),
                         is_explicit_ && fem.mass_kind() == MassKind::lumped,
                         step_.v_star,
                         gather_free(displacement_velocity_),
                         step_.s / step_.time_step};
}

double DeformableBody::relinearize(const DeformableIntegrator& integrator, const VecX& change, const VecX& impulse) {
  const VecX v = step_.v_star + change;
  integrator.linearize(*this, v, step_);
  const VecX momentum = step_.a * v;
  const double left = (momentum - step_.b - impulse).norm(),
               size = larger(larger(momentum.norm(), step_.b.norm()), impulse.norm());
  return left <= step_.rounding ? 0.0 : left / size;  // what is no number is no root
}

void DeformableBody::solve_again() {
  ThriftySolver thrifty(*solvers_.iterative, *solvers_.direct);
  step_.linear_status = thrifty.factorize(step_.a);
  if (step_.linear_status == SolveStatus::ok) step_.linear_status = thrifty.solve(step_.b, step_.v_star).status;
  check_solved();
  keep_momentum(step_.mass, step_.b, step_.v_star);
  find_displacement_velocity();
}

void DeformableBody::keep_momentum(double mass_factor, const VecX& b, VecX& v) const {
  if (pull || free_nodes() != nodes() || v.size() != b.size()) return;
  const std::vector<double>& node = fem.node_mass();
  Vec3 missing = Vec3::Zero();
  double whole = 0.0;
  for (int i = 0; i < nodes(); ++i) {
    missing += b.segment<3>(3 * i) - mass_factor * node[static_cast<std::size_t>(i)] * v.segment<3>(3 * i);
    whole += mass_factor * node[static_cast<std::size_t>(i)];
  }
  if (!missing.allFinite() || !(whole > 0.0)) return;
  for (int i = 0; i < nodes(); ++i) v.segment<3>(3 * i) += missing / whole;
}

void DeformableBody::surface_at_end(const BodyVector* change, std::vector<Vec3>& vertices) const {
  VecX v = step_.v_star;
  if (change != nullptr) v += change->nodes;
  interpolate(embedding, fem.rest(), step_.position(with_held(v)), vertices);
}

void DeformableBody::change_velocity(const BodyVector& change, bool /*is_blow*/) {
  step_.v_star += change.nodes;
  touched_ = true;
}

void DeformableBody::advance(const TimeIntegration& how, double /*end*/) {
  how.integrator.advance(*this, step_, step_.v_star);
  const Vec3 changed = how.gravity - mean_gravity(how);
  lag = how.integrator.may_stagger() ? how.time_step - how.ahead() : 0.0, lag_gravity = how.gravity;
  lead_on(changed);
  // Newmark's accelerations are those of the elastic forces alone: contact acts at the end of the step [Kane99], or a
  // body that lands would bounce back with the speed it came with; and so does a pull
  if (touched_ || pull) acceleration_known = false;
  center_velocity_ = momentum() / mass;
}

void DeformableBody::displace(const BodyVector& by) {
  VecX displacement = VecX::Zero(position.size());
  scatter_free(by.nodes, displacement);
  position += displacement;
}

void DeformableBody::check_finite() const {
  if (position.allFinite() && position.cwiseAbs().maxCoeff() < kLargest && velocity.allFinite()) return;
  throw DivergenceError(
      fmt::format("body '{}': a node's position or velocity is no longer a finite number below {:g}; use more "
                  "sub-steps, or a more stable material or integrator",
                  name, kLargest));
}

}  // namespace impinge
