#include "engine/step/group_result.hpp"

#include <algorithm>
#include <limits>

#include "engine/bodies/scale.hpp"
#include "engine/contact/attachments.hpp"

namespace impinge {

double fastest_point(const BodyVector& velocity, double radius) {
  double fastest = velocity.twist.linear.norm() + velocity.twist.angular.norm() * radius;
  for (Eigen::Index k = 0; k + 2 < velocity.nodes.size(); k += 3)
    fastest = std::max(fastest, velocity.nodes.segment<3>(k).norm());
  return fastest;
}

double share_of_push_out(const Bodies& bodies, const CollisionGroup& group, const Threshold& most, double gravity,
                         std::span<const double> fastest) {
  double share = 1.0;
  for (std::size_t i = 0; i < fastest.size(); ++i) {
    const double allowed = most.at(speed_scale(gravity, bodies[group.bodies[i]].size));
    if (fastest[i] > allowed) share = std::min(share, allowed / fastest[i]);
  }
  return share;
}

double rounding_speed(const Bodies& bodies, const AssembledGroup& group, double time_step) {
  // of the coordinates: a point is a sum of products, a gap or drift the difference of two, and two rows may differ by both
  constexpr double kRoundings = 16.0;
  double farthest = 0.0;
  for (const BodyIndex b : group.rigid)
    farthest = std::max(farthest, bodies[b].pose.position.cwiseAbs().maxCoeff() + bodies[b].radius);
  for (const BodyIndex b : group.deformable) {
    const Aabb bounds = bodies[b].bounds();
    farthest = std::max({farthest, bounds.min.cwiseAbs().maxCoeff(), bounds.max.cwiseAbs().maxCoeff()});
  }
  const double of_positions = kRoundings * std::numeric_limits<double>::epsilon() * farthest / time_step;
  return std::max(of_positions, rounding_of_speeds(group.system));
}

SolvedContact unsolved_contact(const Collision& collision, const MaterialPoint& a, const MaterialPoint& b,
                               double friction, const Bodies& bodies) {
  SolvedContact contact;
  contact.collision = collision;
  contact.point_a = a;
  contact.point_b = b;
  contact.local_normal = collision.normal;
  if (!collision.normal_owner.is_none())
    contact.local_normal = bodies[collision.normal_owner].pose.rotation.transpose() * collision.normal;
  contact.friction = friction;
  return contact;
}

double gap_of(const SolvedContact& contact, const Bodies& bodies) {
  const Collision& c = contact.collision;
  return normal_of(contact, bodies)
      .dot(bodies[c.body_a].position_of(contact.point_a) - bodies[c.body_b].position_of(contact.point_b));
}

Vec3 normal_of(const SolvedContact& contact, const Bodies& bodies) {
  const BodyIndex owner = contact.collision.normal_owner;
  return owner.is_none() ? contact.collision.normal : Vec3(bodies[owner].pose.rotation * contact.local_normal);
}

bool is_held(const Bodies& bodies, const CollisionGroup& group, const ContactList& contacts) {
  const auto holds = [&](BodyIndex b) { return b.is_none() || !bodies[b].has_freedom(); };
  return std::any_of(group.contacts.begin(), group.contacts.end(), [&](ContactIndex i) {
    const auto [a, b] = contacts.bodies(i);
    return holds(a) || holds(b);
  });
}

bool floats(const Bodies& bodies, const CollisionGroup& group, const ContactList& contacts) {
  const auto is_rigid = [&](BodyIndex b) { return !b.is_none() && bodies[b].kind() == BodyKind::dynamic; };
  return std::all_of(group.contacts.begin(), group.contacts.end(), [&](ContactIndex i) {
    const auto [a, b] = contacts.bodies(i);
    return is_rigid(a) && is_rigid(b);
  });
}

bool is_driven(const Bodies& bodies, const CollisionGroup& group, const ContactList& contacts) {
  const auto is_scripted = [&](BodyIndex b) { return !b.is_none() && bodies[b].kind() == BodyKind::scripted; };
  return std::any_of(group.contacts.begin(), group.contacts.end(), [&](ContactIndex i) {
    const auto [a, b] = contacts.bodies(i);
    return is_scripted(a) || is_scripted(b);
  });
}

bool is_on_its_way(const Bodies& bodies, const CollisionGroup& group, const Vec3& gravity, double time_step) {
  constexpr double kMoves = 0.03;  // of √(g size)
  return std::any_of(group.bodies.begin(), group.bodies.end(), [&](BodyIndex b) {
    const Body& body = bodies[b];
    const double fast = kMoves * speed_scale(scale_gravity(gravity), body.size);
    if (body.kind() != BodyKind::dynamic) return body.fastest_point() > fast;
    const Twist free = body.twist();
    const Vec3 before = free.linear - time_step * gravity;
    return before.norm() + free.angular.norm() * body.radius > fast;
  });
}

void keep_rows(const Bodies& bodies, const AssembledGroup& solved, const CollisionGroup& group,
               const ContactList& contacts, GroupResult& result) {
  const GroupSystem& s = solved.system;
  std::vector<Vec3> linear(s.rigid.size(), Vec3::Zero()), angular = linear;
  for (std::size_t i = 0; i < s.contacts.size(); ++i) {
    const ContactRows& rows = s.contacts[i];
    const Vec3 lambda = s.lambda[i], on_a = rows.directions.transpose() * lambda;
    const auto [a, b] = contacts.bodies(solved.contacts[i]);
    const Vec3 tangent = rows.kind == RowKind::contact
                             ? Vec3(rows.directions.transpose() * Vec3(0.0, lambda.y(), lambda.z()))
                             : Vec3(Vec3::Zero());
    result.rows.push_back({rows.kind, a, b, rows.a, rows.b, on_a - tangent, tangent});
    if (solved.meeting > 0.0)
      result.rows.back().way_a = rows.impact * bodies[a].twist().linear,
      result.rows.back().way_b = rows.impact * bodies[b].twist().linear;
    for (const auto& [side, sign] : {std::pair(&rows.a, 1.0), std::pair(&rows.b, -1.0)})
      if (side->rigid >= 0) linear[side->rigid] += sign * on_a, angular[side->rigid] += side->arm.cross(sign * on_a);
  }
  std::vector<VecX> nodes;
  for (std::size_t k = 0; k < s.deformable.size(); ++k)
    nodes.push_back(s.deformable_impulse(static_cast<int>(k), s.lambda));
  result.row_impulse = solved.by_body(group, linear, angular, nodes);
}

void keep_contacts(const Bodies& bodies, const AssembledGroup& solved, const ContactList& contacts, GroupIndex index,
                   GroupResult& result) {
  const GroupSystem& s = solved.system;
  result.contacts = solved.contacts;
  for (std::size_t i = 0; i < solved.contacts.size(); ++i) {
    const ContactIndex c = solved.contacts[i];
    const ContactRows& row = s.contacts[i];
    result.impulses.push_back({contacts.key(c), row.directions.transpose() * s.lambda[i]});
    if (!s.next_start.empty()) result.starts.push_back(row.directions.transpose() * s.next_start[i]);
    const Collision* collision = contacts.collision(c);
    if (collision == nullptr) continue;
    SolvedContact of =
        unsolved_contact(*collision, solved.points[i].first, solved.points[i].second, row.friction, bodies);
    of.lambda = s.lambda[i], of.state = state_of(of.lambda, of.friction);
    of.group = index, of.residual = result.verdict.of_contacts[i];
    if (solved.meeting > 0.0) result.slips.emplace_back(s.contact_velocity(i, false), s.contact_velocity(i, true));
    result.solved.push_back(std::move(of));
  }
}

void keep_answer(const Bodies& bodies, const AssembledGroup& solved, const ContactList& contacts, FrozenGroup& frozen) {
  const GroupSystem& s = solved.system;
  frozen.answer = {s.lambda, s.delta_velocity, s.delta_angular_velocity, s.deformable_delta};
  frozen.rigid_bodies = solved.rigid;
  frozen.deformable_bodies = solved.deformable;
  frozen.geometry.clear();
  for (const ContactIndex c : solved.contacts) {
    const ContactKey key = contacts.key(c);
    if (const Collision* at = contacts.collision(c)) {
      frozen.geometry.push_back(
          {at->body_a, at->body_b, at->triangle_a, at->triangle_b, at->point_a, at->point_b, key.feature});
    } else {
      const AttachmentHold hold = hold_of(contacts.attachment(c), bodies);
      frozen.geometry.push_back({key.body_a, key.body_b, {}, {}, hold.point_a, hold.point_b, key.feature});
    }
  }
}

}  // namespace impinge
