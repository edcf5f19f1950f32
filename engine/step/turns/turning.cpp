#include "engine/step/turns/turning.hpp"

#include <algorithm>
#include <cmath>

#include "engine/bodies/rigid_body.hpp"
#include "engine/contact/row_bound.hpp"

namespace impinge {
namespace {

constexpr double kMostLeft = 0.05;  // of the activation distance: what positions may take back of it

}  // namespace

bool is_turning(const Bodies& bodies, const AssembledGroup& group, const ContactSettings& settings, double time_step) {
  return std::any_of(group.rigid.begin(), group.rigid.end(), [&](BodyIndex b) {
    return is_notable(time_step * bodies[b].twist().angular.norm(), bodies[b], settings);
  });
}

double most_lost(const GroupSystem& system, const EndRows& ends, const ContactSettings& settings, double time_step) {
  double most = 0.0;
  for (std::size_t i = 0; i < ends.gaps.size(); ++i) {
    const ContactRows& row = system.contacts[i];
    double lost = std::min(row.gap, 0.0) - ends.gaps[i];
    if (ends.is_round[i] != 0 && system.lambda[i].x() > 0.0) {
      const double straight = row.gap + time_step * system.displacement_velocity(i).x(),
                   turning = std::min(ends.gaps[i] - straight, 0.0);
      lost = std::max({lost, turning - row.turning, time_step * (ends.rolling[i] - row.rolling).norm()});
    }
    // what counted on a turn that did not come would be lifted out of it, and win what that takes
    const double little = (row.turning > 0.0 ? kNotable : 1.0) * kTurningTolerance;
    if (lost > little * settings.activation_distance.at(row.scale.length)) most = std::max(most, lost);
  }
  return most;
}

bool ends_deep(const GroupSystem& system, const EndRows& ends, const ContactSettings& settings) {
  for (std::size_t i = 0; i < ends.gaps.size(); ++i) {
    const ContactRows& row = system.contacts[i];
    if (std::min(row.gap, 0.0) - ends.gaps[i] > kMostLeft * settings.activation_distance.at(row.scale.length))
      return true;
  }
  return false;
}

std::pair<double, double> energy_won(const Bodies& bodies, const AssembledGroup& group) {
  const GroupSystem& s = group.system;
  double with = 0.0, free = 0.0;
  for (std::size_t i = 0; i < group.rigid.size(); ++i) {
    const RigidBody& body = *bodies[group.rigid[i]].as<RigidBody>();
    const auto energy = [&](const Vec3& velocity, const Vec3& spin) {
      return 0.5 * (body.mass * velocity.squaredNorm() + spin.dot(body.world_inertia() * spin));
    };
    const RigidBlock& block = s.rigid[i];
    free += energy(body.velocity, body.angular_velocity());
    with += energy(block.velocity + s.delta_velocity[i], block.angular_velocity + s.delta_angular_velocity[i]);
  }
  if (s.deformable.empty()) return {with - free, free};
  double won = 0.0;  // A holds elastic forces too: the work of the impulses
  for (std::size_t i = 0; i < s.contacts.size(); ++i)
    won += 0.5 * s.lambda[i].dot(s.contact_velocity(i, false) + s.contact_velocity(i, true));
  return {won, free};
}

bool ask_for_turning(GroupSystem& system, const EndRows& ends, std::span<const double> bounds,
                     const ContactSettings& settings, double time_step) {
  bool is_much = false;
  for (std::size_t i = 0; i < ends.gaps.size(); ++i) {
    ContactRows& row = system.contacts[i];
    if (row.kind != RowKind::contact) continue;
    const double little = kTurningTolerance * settings.activation_distance.at(row.scale.length),
                 straight = row.gap + time_step * system.displacement_velocity(i).x(),
                 at_rest = row_bound({row.gap, 0.0, 0.0, 0.0, 0.0, row.scale.speed}, settings, time_step);
    const bool may_lift = ends.is_on_face[i] != 0 && !(bounds[i] > at_rest);  // a rebound is owed whatever turns
    row.turning = may_lift ? ends.gaps[i] - straight : std::min(ends.gaps[i] - straight, 0.0);
    row.bound = at_rest - row.turning / time_step;
    if (!may_lift) row.bound = std::max(bounds[i], row.bound);
    if (may_lift && ends.handed_over[i] != 0)
      row.bound -= settings.activation_distance.at(row.scale.length) / time_step;
    row.surface += ends.rolling[i] - row.rolling, row.rolling = ends.rolling[i];
    is_much |= row.turning < -little || std::max(row.turning, time_step * row.rolling.norm()) > kNotable * little;
  }
  return is_much;
}

bool limit_turning(GroupSystem& system, std::span<const double> bounds, const ContactSettings& settings,
                   double time_step) {
  bool is_less = false;
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    ContactRows& row = system.contacts[i];
    const double most = std::max(bounds[i], -system.contact_velocity(i, false).x());
    if (!(row.turning < 0.0 && row.bound > most)) continue;
    if ((row.bound - most) * time_step > kMostLeft * settings.activation_distance.at(row.scale.length)) return false;
    row.bound = most;
    is_less = true;
  }
  return is_less;
}

void forget_turning(GroupSystem& system, std::span<const double> bounds) {
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    ContactRows& row = system.contacts[i];
    row.bound = bounds[i], row.turning = 0.0;
    row.surface -= row.rolling, row.rolling.setZero();
  }
}

}  // namespace impinge
