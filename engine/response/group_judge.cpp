#include "engine/response/group_judge.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/lcp/residual.hpp"

namespace impinge {
namespace {

/// |J v* - bound| of the rows that there are.
double asked(const GroupSystem& group, std::size_t i) {
  Vec3 u = group.contact_velocity(i, false);
  u.x() -= group.contacts[i].bound;
  return group.contacts[i].has_one_row() ? std::abs(u.x()) : u.norm();
}

}  // namespace

// bodies that fly together, or turn about what holds them, ask for no more, and a share of that says nothing
double rounding_of_speeds(const GroupSystem& group) {
  double speed = 0.0;
  for (const RigidBlock& block : group.rigid) speed = std::max(speed, block.velocity.norm());
  for (const ContactRows& row : group.contacts) {
    for (const ContactSide* side : {&row.a, &row.b}) {
      if (side->rigid < 0) continue;
      const RigidBlock& block = group.rigid[side->rigid];
      speed = std::max(speed, block.velocity.norm() + block.angular_velocity.norm() * side->arm.norm());
    }
  }
  for (const DeformableBlock& block : group.deformable)
    if (block.velocity.size() > 0) speed = std::max(speed, block.velocity.cwiseAbs().maxCoeff());
  return 64.0 * std::numeric_limits<double>::epsilon() * speed;
}

double most_asked(const GroupSystem& group) {
  double most = 0.0;
  for (std::size_t i = 0; i < group.contacts.size(); ++i) most = std::max(most, asked(group, i));
  return most;
}

bool starts_too_high(const GroupSystem& group, std::span<const Vec3> start) {
  constexpr double kTooHigh = 1e10;
  double given = 0.0;  // m/s
  const double wanted = most_asked(group);
  for (std::size_t i = 0; i < group.contacts.size(); ++i)
    for (const ContactSide* side : {&group.contacts[i].a, &group.contacts[i].b})
      if (side->rigid >= 0) given = std::max(given, group.rigid[side->rigid].inverse_mass * start[i].norm());
  return wanted <= rounding_of_speeds(group) || given > kTooHigh * wanted;
}

GroupVerdict judge_group(const GroupSystem& group, const std::vector<Mat3>* w_diagonal, double rounding) {
  GroupVerdict verdict;
  double scale = 0.0;
  verdict.of_contacts.assign(group.contacts.size(), 0.0);
  std::vector<Vec3> impulse(group.rigid.size(), Vec3::Zero()), turn(group.rigid.size(), Vec3::Zero());
  for (std::size_t i = 0; i < group.contacts.size(); ++i) {
    const ContactRows& rows = group.contacts[i];
    const Vec3 force = rows.directions.transpose() * group.lambda[i];
    Mat3 w = Mat3::Zero();
    const auto add = [&](const ContactSide& side, double sign) {
      if (side.rigid >= 0) {
        const RigidBlock& block = group.rigid[side.rigid];
        impulse[side.rigid] += sign * force;
        turn[side.rigid] += sign * side.arm.cross(force);
        Vec3 direction[3], moment[3], spin[3];
        for (int r = 0; r < 3; ++r) {
          direction[r] = rows.directions.row(r);
          moment[r] = side.arm.cross(direction[r]);
          spin[r] = block.inverse_inertia * moment[r];
        }
        for (int r = 0; r < 3; ++r)
          for (int c = 0; c < 3; ++c)
            w(r, c) += block.inverse_mass * direction[r].dot(direction[c]) + moment[r].dot(spin[c]);
      }
      for (const NodeWeight& n : side.nodes) {  // the natural map needs a scale only: the nodes' own blocks serve
        const BlockMatrix& a = *group.deformable[side.deformable].a;
        w += n.weight * n.weight * rows.directions * a.values[a.pattern->diagonal[n.node]].inverse() *
             rows.directions.transpose();
      }
    };
    add(rows.a, 1.0);
    add(rows.b, -1.0);
    if (w_diagonal != nullptr) w = (*w_diagonal)[i];
    if (w(0, 0) <= 0.0) continue;  // both points are held: nothing can respond
    Vec3 u = group.contact_velocity(i, true);
    u.x() -= rows.bound;
    scale = std::max(scale, asked(group, i));
    const double r = rows.kind == RowKind::attachment ? u.norm()
                     : rows.kind == RowKind::sliding  ? std::abs(u.x())
                                                      : natural_map(w, u, group.lambda[i], rows.friction);
    verdict.of_contacts[i] = r;
    if (std::isnan(verdict.natural_map) || r <= verdict.natural_map) continue;
    verdict.natural_map = r;
    verdict.worst = static_cast<int>(i);
  }
  for (std::size_t b = 0; b < group.rigid.size(); ++b) {
    const RigidBlock& block = group.rigid[b];
    const Vec3 linear = group.delta_velocity[b] - block.inverse_mass * impulse[b];
    const Vec3 angular = group.delta_angular_velocity[b] - block.inverse_inertia * turn[b];
    verdict.momentum = larger(larger(verdict.momentum, linear.norm()), angular.norm());
  }
  // A Δv - J^T λ by node, as the velocity that its own block makes of it
  for (std::size_t s = 0; s < group.deformable.size(); ++s) {
    const BlockMatrix& a = *group.deformable[s].a;
    const VecX r = a * group.deformable_delta[s] - group.deformable_impulse(static_cast<int>(s), group.lambda);
    for (int i = 0; i < a.pattern->rows; ++i)
      verdict.momentum =
          larger(verdict.momentum, (a.values[a.pattern->diagonal[i]].inverse() * r.segment<3>(3 * i)).norm());
  }
  const double known = rounding > 0.0 ? rounding : rounding_of_speeds(group);
  const auto relative = [&](double map) { return map <= known ? 0.0 : scale > 0.0 ? map / scale : map; };
  verdict.relative = relative(verdict.natural_map);
  for (double& map : verdict.of_contacts) map = relative(map);
  return verdict;
}

}  // namespace impinge
