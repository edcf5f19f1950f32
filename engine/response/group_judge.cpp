#include "engine/response/group_judge.hpp"

#include <algorithm>

#include "engine/lcp/residual.hpp"

namespace impinge {

GroupVerdict judge_group(const GroupSystem& group) {
  GroupVerdict verdict;
  std::vector<Vec3> impulse(group.bodies.size(), Vec3::Zero()), turn(group.bodies.size(), Vec3::Zero());
  for (std::size_t i = 0; i < group.contacts.size(); ++i) {
    const ContactRows& rows = group.contacts[i];
    const Vec3 force = rows.directions.transpose() * group.lambda[i];
    Mat3 w = Mat3::Zero();
    const auto side = [&](int body, const Vec3& arm, double sign) {
      if (body < 0) return;
      const BodyBlock& block = group.bodies[body];
      impulse[body] += sign * force;
      turn[body] += sign * arm.cross(force);
      for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c) {
          const Vec3 dr = rows.directions.row(r), dc = rows.directions.row(c);
          w(r, c) += block.inverse_mass * dr.dot(dc) + arm.cross(dr).dot(block.inverse_inertia * arm.cross(dc));
        }
    };
    side(rows.a, rows.arm_a, 1.0);
    side(rows.b, rows.arm_b, -1.0);
    Vec3 u = group.contact_velocity(i, true);
    u.x() -= rows.bound;
    const double r = natural_map(w, u, group.lambda[i], rows.friction);
    if (!(r <= verdict.natural_map)) {
      verdict.natural_map = r;
      verdict.worst = static_cast<int>(i);
    }
  }
  for (std::size_t b = 0; b < group.bodies.size(); ++b) {
    const BodyBlock& block = group.bodies[b];
    verdict.momentum = std::max({verdict.momentum, (group.delta_velocity[b] - block.inverse_mass * impulse[b]).norm(),
                                 (group.delta_angular_velocity[b] - block.inverse_inertia * turn[b]).norm()});
  }
  return verdict;
}

}  // namespace impinge
