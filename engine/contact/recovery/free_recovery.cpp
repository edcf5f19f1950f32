#include "engine/contact/recovery/free_recovery.hpp"

#include <algorithm>
#include <cmath>

#include "engine/bodies/rigid_body.hpp"

namespace impinge {
namespace {

constexpr double kSlowed = 1e-3;  // of their speeds against one another: what may pay for the angular momentum

/// Of bodies about their common centre, which moves at `velocity`.
struct InnerMotion {
  Vec3 center = Vec3::Zero(), velocity = Vec3::Zero();  // metres, m/s
  double energy = 0.0;                                  // J
  Vec3 spin = Vec3::Zero();                             // angular momentum, kg·m²/s
  Mat3 inertia = Mat3::Zero();                          // of all as one body, kg·m²
};

InnerMotion inner_motion(std::span<RigidBody* const> bodies) {
  InnerMotion all;
  double mass = 0.0;
  for (const RigidBody* b : bodies)
    mass += b->mass, all.center += b->mass * b->pose.position, all.velocity += b->mass * b->velocity;
  all.center /= mass, all.velocity /= mass;
  for (const RigidBody* b : bodies) {
    const Vec3 arm = b->pose.position - all.center, way = b->velocity - all.velocity;
    all.energy += 0.5 * (b->mass * way.squaredNorm() + b->angular_momentum.dot(b->angular_velocity()));
    all.spin += b->mass * arm.cross(way) + b->angular_momentum;
    all.inertia += b->world_inertia() + b->mass * (arm.squaredNorm() * Mat3::Identity() - arm * arm.transpose());
  }
  return all;
}

/// The largest part of a turn that leaves at most `allowed` J; of none that does, the one that leaves least. A part s of it
/// makes energy + s linear + s² square of the energy.
double largest_part(double energy, double linear, double square, double allowed) {
  if (energy + linear + square <= allowed) return 1.0;
  const double least = std::clamp(-0.5 * linear / square, 0.0, 1.0);
  if (!(energy + least * (linear + least * square) < allowed)) return least;
  const double root = std::sqrt(linear * linear - 4.0 * square * (energy - allowed));
  return std::clamp((root - linear) / (2.0 * square), least, 1.0);
}

}  // namespace

void displace_floating(Bodies& bodies, std::span<const BodyIndex> group, std::span<const BodyVector> by, double taken) {
  std::vector<RigidBody*> rigid;
  for (const BodyIndex b : group) rigid.push_back(bodies[b].as<RigidBody>());
  const InnerMotion before = inner_motion(rigid);
  for (std::size_t i = 0; i < rigid.size(); ++i) rigid[i]->displace(by[i]);
  const InnerMotion after = inner_motion(rigid);

  // the turn of all as one body is what angular momentum asks for, and bodies may be slowed against that
  const auto factor = after.inertia.ldlt();
  const Vec3 lost = before.spin - after.spin, turn = factor.solve(lost), as_one = factor.solve(after.spin);
  const double whole = 0.5 * as_one.dot(after.spin), apart = std::max(0.0, after.energy - whole);
  const double linear = turn.dot(after.spin), square = 0.5 * turn.dot(lost), most = before.energy + taken;
  const double kept = (1.0 - kSlowed) * (1.0 - kSlowed) * apart;
  const double part = square > 0.0 ? largest_part(whole + kept, linear, square, most) : 0.0;
  const double turning = whole + part * (linear + part * square);
  const double slower = apart > 0.0 && turning + apart > most ? std::sqrt(std::max(0.0, most - turning) / apart) : 1.0,
               all = turning > most ? std::sqrt(most / turning) : 1.0;
  for (RigidBody* b : rigid) {
    const Vec3 arm = b->pose.position - after.center, way = b->velocity - after.velocity;
    const Mat3 inertia = b->world_inertia();
    b->velocity += (slower - 1.0) * (way - as_one.cross(arm)) + part * turn.cross(arm);
    b->angular_momentum += (slower - 1.0) * (b->angular_momentum - inertia * as_one) + part * (inertia * turn);
    if (all == 1.0) continue;
    b->velocity = after.velocity + all * (b->velocity - after.velocity);
    b->angular_momentum *= all;
  }
}

}  // namespace impinge
