#include "engine/bodies/rigid_body.hpp"

#include <fmt/format.h>

#include "engine/bodies/rigid_motion.hpp"
#include "engine/bodies/time_integration.hpp"
#include "engine/core/archive.hpp"
#include "engine/core/error.hpp"
#include "engine/geometry/rotation.hpp"

namespace impinge {
namespace {

constexpr double kCarries = 2.0;  // of gravity: an acceleration by impulses that is no blow
constexpr double kStands = 1e-3;  // of what gravity makes of a speed in `lag`: a speed that is none

double rounding_of(const Shape& shape) {
  if (shape.mesh() != nullptr) return 0.0;
  const ShapeForm form = shape.form();
  const auto* convex = std::get_if<const ConvexSet*>(&form);
  return convex != nullptr ? (*convex)->rounding() : 0.0;
}

}  // namespace

Vec3 Stagger::agreed(const Vec3& last, const Vec3& now) {
  if (last.dot(now) <= 0.0) return Vec3::Zero();
  return last.squaredNorm() < now.squaredNorm() ? last : now;
}

void Stagger::save(ByteWriter& out) const {
  for (const Vec3& v : {lead, spin_lead, rate, spin_rate}) out.put(v);
}

Stagger Stagger::restore(ByteReader& in) {
  Stagger s;
  for (Vec3* v : {&s.lead, &s.spin_lead, &s.rate, &s.spin_rate}) *v = in.get_vec3();
  return s;
}

void RigidBody::set_inertia(const Mat3& about_center) {
  principal = principal_inertia(about_center);
  inertia = principal.matrix();
  inertia_inverse = principal.inverse();
}

void RigidBody::open_sub_step() {
  Body::open_sub_step();
  given_.setZero(), spin_given_.setZero(), is_struck_ = false;
  if (lag == 0.0) return;
  velocity -= stagger_.lead, angular_momentum -= stagger_.spin_lead;
  lead_ = {stagger_.lead, world_inertia_inverse() * stagger_.spin_lead};
}

void RigidBody::find_free_velocity(const TimeIntegration& how) {
  kick = lag + how.ahead();
  apply_gravity(*this, mean_gravity(how), kick);
  pulled_ = velocity, spin_pulled_ = angular_momentum;
  if (pull) apply_pull(*this, *pull, kick, how.time_step);
  pulled_ = velocity - pulled_, spin_pulled_ = angular_momentum - spin_pulled_;
}

SystemBlock RigidBody::system_block() const {
  return RigidBlock{1.0 / mass, world_inertia_inverse(), velocity, angular_velocity(), rounding_of(*shape)};
}

CarriedPoint RigidBody::carry(const MaterialPoint&, const Vec3& at) const {
  CarriedPoint carried;
  carried.arm = at - pose.position;
  carried.velocity_before = before_.linear + before_.angular.cross(carried.arm);
  if (lag != 0.0) carried.lead = lead_.linear + lead_.angular.cross(carried.arm);
  return carried;
}

void RigidBody::change_velocity(const BodyVector& change, bool is_blow) {
  is_struck_ = is_blow;
  given_ = change.twist.linear, spin_given_ = world_inertia() * change.twist.angular;
  velocity += given_;
  angular_momentum += spin_given_;
}

void RigidBody::advance(const TimeIntegration& how, double /*end*/) {
  try {
    advance_rigid(*this, how.time_step);
  } catch (const DivergenceError& error) {  // it knows no name
    throw DivergenceError(
        fmt::format("body '{}': {}; use more sub-steps, or smaller velocities and forces", name, error.what()));
  }
  lag = how.time_step - how.ahead(), lag_gravity = how.gravity;
  if (lag != 0.0)
    lead_on(how);
  else
    stagger_ = {};
}

/// By gravity, a pull and impulses: those that carry a weight, and of larger ones what agrees with the sub-step before. What
/// they have brought to a stand stays there.
void RigidBody::lead_on(const TimeIntegration& how) {
  Vec3 rate = given_ / kick, spin_rate = spin_given_ / kick;
  const double weight = kCarries * how.gravity.norm();
  const bool carries = rate.norm() <= weight;
  Vec3 goes_on = carries ? rate : Stagger::agreed(stagger_.rate, rate),
       spin_goes_on = carries ? spin_rate : Stagger::agreed(stagger_.spin_rate, spin_rate);
  if (is_struck_ && !carries) {  // of a blow nothing goes on but the weight that was carried before
    if (stagger_.rate.norm() > weight) goes_on.setZero(), spin_goes_on.setZero();
    rate = goes_on, spin_rate = spin_goes_on;
  }
  const Vec3 lead = lag * (how.gravity + goes_on + pulled_ / kick),
             spin_lead = lag * (spin_goes_on + spin_pulled_ / kick);
  const bool stands = !given_.isZero(0.0) && velocity.norm() <= kStands * lag * how.gravity.norm();
  stagger_ = {stands ? Vec3(Vec3::Zero()) : lead, stands ? Vec3(Vec3::Zero()) : spin_lead, rate, spin_rate};
  velocity += stagger_.lead, angular_momentum += stagger_.spin_lead;
}

void RigidBody::displace(const BodyVector& by) {
  if (!by.twist.is_zero()) displace_rigid(*this, by.twist.linear, by.twist.angular);
}

void RigidBody::stay(ByteReader& start) {
  const double late = lag;
  const Vec3 gravity = lag_gravity;
  restore_frame(start);
  lag = late, lag_gravity = gravity;
}

void RigidBody::check_finite() const {
  // a maximum alone may pass over NaN
  const bool fine = pose.position.allFinite() && velocity.allFinite() &&
                    pose.position.cwiseAbs().maxCoeff() < kLargest && velocity.cwiseAbs().maxCoeff() < kLargest &&
                    angular_momentum.allFinite() && pose.rotation.allFinite();
  if (fine) return;
  throw DivergenceError(
      fmt::format("body '{}': position or velocity is no longer a finite number below {:g}; use more sub-steps, or "
                  "smaller velocities and forces",
                  name, kLargest));
}

void RigidBody::come_to_rest() {
  catch_up();
  velocity.setZero();
  angular_momentum.setZero();
}

void RigidBody::push(const Vec3& impulse, const std::optional<Vec3>& at) {
  velocity += impulse / mass;
  if (at) angular_momentum += (*at - pose.position).cross(impulse);
}

void RigidBody::shift(const Vec3& by, const Mat3& turn) {
  const Vec3 w = angular_velocity();
  pose.position += by;
  pose.rotation = orthonormalized(turn * pose.rotation);
  angular_momentum = world_inertia() * w;
}

Balance RigidBody::balance(const Vec3& gravity) {
  const Vec3 p = mass * velocity;
  Balance own;
  own.kinetic = 0.5 * p.dot(velocity) + 0.5 * angular_momentum.dot(angular_velocity());
  own.potential = -(mass * gravity.dot(pose.position));
  own.momentum = p;
  own.angular_momentum = pose.position.cross(p) + angular_momentum;
  return own;
}

void RigidBody::save(ByteWriter& out) const {
  save_frame(out, velocity, angular_momentum, Vec3::Zero());
  if (lag != 0.0) stagger_.save(out);
}

void RigidBody::restore(ByteReader& in) {
  const Frame frame = restore_frame(in);
  velocity = frame.velocity;
  angular_momentum = frame.angular_momentum;
  stagger_ = lag != 0.0 ? Stagger::restore(in) : Stagger();
}

}  // namespace impinge
