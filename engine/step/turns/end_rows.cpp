#include "engine/step/turns/end_rows.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/bodies/rigid_motion.hpp"
#include "engine/geometry/convex/convex_set.hpp"
#include "engine/geometry/rotation.hpp"
#include "engine/shapes/shape.hpp"
#include "engine/step/turns/fine_facets.hpp"
#include "engine/step/turns/row_end.hpp"

namespace impinge {

Vec3 RowEnd::half_way(const Bodies& bodies, const Vec3& then) const {
  const auto moves_on = [&](const BodyEnd& of, BodyIndex body) {
    return Vec3(of.spin_then.cross(then - of.pose.position) - of.spin.cross(now() - bodies[body].pose.position));
  };
  return 0.5 * sign() * (moves_on(end(), body()) - moves_on(face_end(), face()));
}

namespace {

constexpr double kFarthestTurn = 0.5;  // radians; what turns farther leaves its contact's plane
constexpr double kFarthestRoll = 0.5;  // of the arm: a place that moves farther is another one
constexpr double kSmooth = 0.998;      // cosine of a bend of 3.6 degrees
constexpr double kMostTurns = 1e3;     // radians; of what spins about the place where it touches

BodyEnd end_of(const RigidBody& body, const Vec3& velocity, const Vec3& spin, double time_step) {
  BodyEnd end{body.pose, time_step * spin.norm(), spin, spin};
  if (!(end.turn <= kMostTurns)) return end;
  const Vec3 momentum = body.world_inertia() * spin;
  end.pose = free_flight(body, velocity, momentum, time_step);
  end.spin_then = end.pose.rotation * (body.inertia_inverse * (end.pose.rotation.transpose() * momentum));
  return end;
}

/// Of a body that impulses don't move.
BodyEnd end_of(const Body& body, double time_step) {
  const Twist twist = body.twist();
  return {moved(body.pose, time_step * twist.linear, time_step * twist.angular), time_step * twist.angular.norm(),
          twist.angular, twist.angular};
}

/// Whether one body looks at the other with one face, or with faces of a smooth hollow. What hangs in the other, as a pin in
/// its hole, or leans on two sides does not roll: its rows hold each other.
bool is_one_face(std::span<const RowEnd> pair) {
  return std::all_of(pair.begin(), pair.end(), [&](const RowEnd& row) {
    return row.of->normal_owner == pair.front().of->normal_owner &&
           row.of->normal.dot(pair.front().of->normal) > kSmooth;
  });
}

/// In the body's frame, where it touches at the end what it touches at `place`; `from`, `to`: the way it faces there now
/// and then.
Vec3 rolled(const Body& body, const Vec3& place, const Vec3& from, const Vec3& to) {
  const ShapeForm form = body.shape->form();
  const auto* convex = std::get_if<const ConvexSet*>(&form);
  return convex == nullptr ? place : (*convex)->rolled(place, from, to);
}

/// Of one side of a contact: where it touches at the end, if it is round and goes round; else where its material is then.
Vec3 touches_then(const Body& body, const BodyEnd& end, const Vec3& now, const Vec3& material, const Vec3& faces,
                  const Vec3& faces_then) {
  if (body.kind() == BodyKind::deformable || !(end.turn <= kMostTurns)) return material;
  const Vec3 place = body.pose.apply_inverse(now);
  return end.pose.apply(
      rolled(body, place, body.pose.rotation.transpose() * faces, end.pose.rotation.transpose() * faces_then));
}

/// Of what is round and leans on several sides: none of its places is farther out at the end than the one that touches then.
double least_gap(const Bodies& bodies, const RowEnd& at) {
  const Collision& c = *at.of;
  Vec3 a = at.point_a, b = at.point_b;
  if (c.normal_owner != c.body_a) a = touches_then(bodies[c.body_a], *at.a, c.point_a, a, -c.normal, -at.normal);
  if (c.normal_owner != c.body_b) b = touches_then(bodies[c.body_b], *at.b, c.point_b, b, c.normal, at.normal);
  return at.normal.dot(a - b);
}

/// Of a rigid body on another one's face: the velocity of their place half way, between the arms of now and then. Where
/// the body is round that place moves round it, and its gap is that of the place which touches then.
void roll(const Bodies& bodies, const RowEnd& at, const ContactRows& row, std::size_t i, EndRows& ends) {
  if (at.of->normal_owner.is_none()) return;
  const Body &body = bodies[at.body()], &face = bodies[at.face()];
  const BodyEnd &end = at.end(), &face_end = at.face_end();
  if (body.kind() == BodyKind::deformable || face.kind() == BodyKind::deformable) return;
  if (!(std::max(end.turn, face_end.turn) <= kMostTurns)) return;
  const Vec3 place = body.pose.apply_inverse(at.now()),
             place_then = rolled(body, place, body.pose.rotation.transpose() * (-at.sign() * at.of->normal),
                                 end.pose.rotation.transpose() * (-at.sign() * at.normal));
  const bool is_round = place_then != place;
  const Vec3 then = is_round ? end.pose.apply(place_then) : at.then();
  const Vec3 arm = at.now() - body.pose.position;
  if ((then - end.pose.position - arm).norm() > kFarthestRoll * arm.norm()) return;
  ends.rolling[i] = row.directions * at.half_way(bodies, then);
  ends.rolling[i].x() = 0.0;
  ends.is_on_face[i] = is_round || std::isfinite(ends.gaps[i]) ? 1 : 0;
  ends.is_round[i] = is_round ? 1 : 0;
  if (is_round) ends.gaps[i] = at.sign() * at.normal.dot(then - at.face_then());
}

}  // namespace

bool is_notable(double turn, const Body& body, const ContactSettings& settings) {
  return turn * turn * body.radius > kNotable * kTurningTolerance * settings.activation(body.size);
}

EndRows rows_at_end(const Bodies& bodies, const AssembledGroup& group, const ContactList& contacts,
                    const ContactSettings& settings, double time_step, Trust trust) {
  std::vector<BodyEnd> rigid;
  for (std::size_t i = 0; i < group.rigid.size(); ++i)
    rigid.push_back(end_of(*bodies[group.rigid[i]].as<RigidBody>(),
                           group.system.rigid[i].velocity + group.system.delta_velocity[i],
                           group.system.rigid[i].angular_velocity + group.system.delta_angular_velocity[i], time_step));
  std::map<BodyIndex, BodyEnd> others;
  const auto end = [&](int block, BodyIndex b) -> const BodyEnd& {
    if (block >= 0) return rigid[static_cast<std::size_t>(block)];
    const auto [at, is_new] = others.try_emplace(b);
    if (is_new) at->second = end_of(bodies[b], time_step);
    return at->second;
  };
  bool rolls = false;
  for (std::size_t i = 0; i < rigid.size() && !rolls; ++i)
    rolls = trust != Trust::none && is_notable(rigid[i].turn, bodies[group.rigid[i]], settings);
  const auto place = [&](const BodyEnd& of, const ContactSide& side, BodyIndex b, const MaterialPoint& point) {
    if (side.deformable < 0) return of.pose.apply(point.local);
    return Vec3(bodies[b].position_of(point) + time_step * group.system.displacement_velocity(side));
  };
  const std::size_t count = group.contacts.size();
  EndRows ends{std::vector<double>(count, INFINITY), std::vector<Vec3>(count, Vec3::Zero()),
               std::vector<char>(count, 0), std::vector<char>(count, 0), std::vector<char>(count, 0)};
  std::vector<RowEnd> rows(rolls ? count : 0);
  for (std::size_t i = 0; i < count; ++i) {
    const Collision* c = contacts.collision(group.contacts[i]);
    if (c == nullptr || c->meeting) continue;
    const ContactRows& row = group.system.contacts[i];
    const auto is_known = [&](const ContactSide& side, BodyIndex body) {
      return side.deformable >= 0 || bodies[body].kind() != BodyKind::deformable;
    };
    if (row.a.rigid < 0 && row.b.rigid < 0) continue;
    if (!is_known(row.a, c->body_a) || !is_known(row.b, c->body_b)) continue;
    const BodyEnd &a = end(row.a.rigid, c->body_a), &b = end(row.b.rigid, c->body_b);
    Vec3 normal = c->normal;
    for (const auto& [owner, to] : {std::pair(c->body_a, &a), std::pair(c->body_b, &b)})
      if (c->normal_owner == owner) normal = to->pose.rotation * (bodies[owner].pose.rotation.transpose() * c->normal);
    const auto& [point_a, point_b] = group.points[i];
    const Vec3 on_a = place(a, row.a, c->body_a, point_a), on_b = place(b, row.b, c->body_b, point_b);
    if (a.turn <= kFarthestTurn && b.turn <= kFarthestTurn) ends.gaps[i] = normal.dot(on_a - on_b);
    if (rolls) rows[i] = {c, &a, &b, normal, on_a, on_b};
  }
  if (!rolls) return ends;
  for_each_pair(rows, [&](std::size_t first, std::size_t last) {
    if (!is_one_face(std::span(rows).subspan(first, last - first))) {
      for (std::size_t i = first; i < last; ++i)
        if (std::isfinite(ends.gaps[i])) ends.gaps[i] = std::min(ends.gaps[i], least_gap(bodies, rows[i]));
      return;
    }
    for (std::size_t i = first; i < last; ++i) roll(bodies, rows[i], group.system.contacts[i], i, ends);
  });
  if (trust == Trust::facets) roll_over_facets(bodies, group, settings, time_step, rows, ends);
  return ends;
}

}  // namespace impinge
