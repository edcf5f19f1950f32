#include "engine/contact/attachments.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/bodies/rigid_body.hpp"
#include "engine/contact/contact_frame.hpp"
#include "engine/contact/surface_foot.hpp"
#include "engine/core/error.hpp"
#include "engine/core/parameter.hpp"

namespace impinge {
namespace {

BodyIndex body_named(const AttachmentDescription& d, const std::string& name, const Bodies& bodies) {
  const BodyIndex body = bodies.find(name);
  if (!body.is_none()) return body;
  const std::string near = nearest_word(name, bodies.names());
  throw InputError(fmt::format("attachment '{}' names the body '{}', which is not there{}", d.name, name,
                               near.empty() ? "" : "; did you mean '" + near + "'?"));
}

AttachmentEnd make_end(const AttachmentDescription& d, const std::string& name, const Bodies& bodies) {
  AttachmentEnd end;
  end.point.local = d.point;
  if (name.empty()) return end;
  end.body = body_named(d, name, bodies);
  try {
    end.point = bodies[end.body].inner_point(d.point);
  } catch (const InputError& error) {
    throw InputError(
        fmt::format("attachment '{}' has its point {}; a point in it, or close to its surface, is wanted; "
                    "move the point",
                    d.name, error.what()));
  }
  return end;
}

/// What slides on a surface has no point of it to keep.
AttachmentEnd make_surface_end(const AttachmentDescription& d, const Bodies& bodies) {
  if (d.body_b.empty())
    throw InputError(fmt::format("attachment '{}' slides on the surface of no body; name body_b", d.name));
  AttachmentEnd end;
  end.body = body_named(d, d.body_b, bodies);
  if (!bodies[end.body].shape)
    throw InputError(fmt::format("attachment '{}' slides on '{}', which has no surface", d.name, d.body_b));
  return end;
}

Vec3 material_normal(const AttachmentEnd& b, const Bodies& bodies, const Vec3& normal) {
  return b.body.is_none() ? normal : bodies[b.body].material_normal(b.point, normal);
}

Vec3 world_normal(const AttachmentEnd& b, const Bodies& bodies, const Vec3& normal) {
  return b.body.is_none() ? normal : bodies[b.body].world_normal(b.point, normal);
}

AttachmentHold hold_on_surface(const Attachment& slide, const Bodies& bodies, AttachmentHold hold) {
  const Body& body = bodies[slide.b.body];
  const SurfaceFoot foot = surface_foot(body, hold.point_a);
  hold.point_b = foot.point;
  hold.at_b = body.surface_point(foot.triangle, foot.point);
  hold.normal = hold.axis = foot.normal;
  return hold;
}

}  // namespace

Vec3 AttachmentEnd::position(const Bodies& bodies) const {
  return body.is_none() ? point.local : bodies[body].position_of(point);
}

AttachmentHold hold_of(const Attachment& attachment, const Bodies& bodies) {
  AttachmentHold hold;
  hold.point_a = attachment.a.position(bodies);
  if (attachment.kind == AttachmentKind::surface) return hold_on_surface(attachment, bodies, hold);
  hold.at_b = attachment.b.point;
  hold.point_b = attachment.b.position(bodies);
  if (attachment.kind == AttachmentKind::point) return hold;
  hold.normal = hold.axis = world_normal(attachment.b, bodies, attachment.normal);
  const Vec3 off = hold.point_a - hold.point_b;
  if (attachment.kind == AttachmentKind::line) {
    hold.axis = hold.normal.cross(world_normal(attachment.b, bodies, attachment.other_normal)).normalized();
    hold.point_b += hold.axis.dot(off) * hold.axis;
  } else {
    hold.point_b = hold.point_a - hold.normal.dot(off) * hold.normal;
  }
  if (!attachment.b.body.is_none())
    hold.at_b = bodies[attachment.b.body].point_beside(attachment.b.point, hold.point_b);
  return hold;
}

std::vector<Attachment> make_attachment(const AttachmentDescription& d, const Bodies& bodies, int number) {
  Attachment attachment{d.name, make_end(d, d.body_a, bodies),
                        d.kind == AttachmentKind::surface ? make_surface_end(d, bodies) : make_end(d, d.body_b, bodies),
                        d.kind};
  attachment.number = number;
  const auto moves = [&](const AttachmentEnd& end) { return !end.body.is_none() && bodies[end.body].has_freedom(); };
  if (!moves(attachment.a) && !moves(attachment.b))
    throw InputError(fmt::format(
        "attachment '{}' joins nothing that can move; a dynamic or deformable body is wanted at one end", d.name));
  if (d.kind == AttachmentKind::point || d.kind == AttachmentKind::surface) return {attachment};
  if (!(d.axis.norm() > 0.0))
    throw InputError(fmt::format("attachment '{}' slides along an axis of no length", d.name));
  const Mat3 axes = contact_axes(d.axis.normalized());
  const auto carried = [&](int k) { return material_normal(attachment.b, bodies, axes.row(k)); };
  if (d.kind == AttachmentKind::plane) {
    attachment.normal = carried(0);
    return {attachment};
  }
  Attachment second = attachment;
  attachment.normal = second.other_normal = carried(1);
  attachment.other_normal = second.normal = carried(2);
  return {attachment, second};
}

namespace {

/// Radians by which the axis of what is held in one point goes round in that time.
double most_round(std::span<const Attachment> attachments, const Bodies& bodies, double time) {
  double most = 0.0;
  for (const Attachment& attachment : attachments)
    for (const BodyIndex b : {attachment.a.body, attachment.b.body}) {
      const RigidBody* body = b.is_none() ? nullptr : bodies[b].as<RigidBody>();
      if (body == nullptr || body->asleep || !body->has_freedom()) continue;
      const double round = time * body->angular_momentum.norm() / body->principal.moments[1];
      const auto holds = [&](const Attachment& a) { return a.a.body == b || a.b.body == b; };
      if (round <= most || attachment.kind != AttachmentKind::point) continue;
      if (std::count_if(attachments.begin(), attachments.end(), holds) == 1) most = round;
    }
  return most;
}

/// Of a point attachment: calls visit(body, arm, sign) for the rigid bodies that move freely at its ends, the arm from the
/// centre of mass, world axes.
template <class Visit>
void for_arms(const Attachment& attachment, const Bodies& bodies, Visit&& visit) {
  if (attachment.kind != AttachmentKind::point) return;
  for (const auto& [end, sign] : {std::pair(&attachment.a, 1.0), std::pair(&attachment.b, -1.0)}) {
    const RigidBody* body = end->body.is_none() ? nullptr : bodies[end->body].template as<RigidBody>();
    if (body != nullptr && !body->asleep && body->has_freedom())
      visit(*body, Vec3(body->pose.rotation * end->point.local), sign);
  }
}

/// How far the arcs of two points that are held together part from straight ways, of the arms that they go round on.
double most_bent(std::span<const Attachment> attachments, const Bodies& bodies, double time) {
  double most = 0.0;
  for (const Attachment& attachment : attachments) {
    Vec3 bend = Vec3::Zero();
    double arms = 0.0;
    for_arms(attachment, bodies, [&](const RigidBody& body, const Vec3& arm, double sign) {
      const Vec3 spin = body.angular_velocity();
      bend += 0.5 * time * time * sign * spin.cross(spin.cross(arm));
      arms += arm.norm();
    });
    if (bend.norm() > most * arms) most = bend.norm() / arms;
  }
  return most;
}

}  // namespace

double share_of_turns(std::span<const Attachment> attachments, const Bodies& bodies, double time_step) {
  constexpr double kMostRound = 1.25;  // radians: from 2 on a disc on a pin was seen to leave it
  constexpr double kMostBent = 0.02;   // what turns by a fifth of a radian
  constexpr double kLeast = 1.0 / 32.0;
  const double round = most_round(attachments, bodies, time_step), bent = most_bent(attachments, bodies, time_step);
  const double share =
      std::min(round > kMostRound ? kMostRound / round : 1.0, bent > kMostBent ? std::sqrt(kMostBent / bent) : 1.0);
  return std::max(kLeast, share);
}

double most_apart(std::span<const Attachment> attachments, const Bodies& bodies) {
  double most = 0.0;
  for (const Attachment& attachment : attachments) {
    double arms = 0.0;
    for_arms(attachment, bodies, [&](const RigidBody&, const Vec3& arm, double) { arms += arm.norm(); });
    if (arms == 0.0) continue;
    most = std::max(most, (attachment.a.position(bodies) - attachment.b.position(bodies)).norm() / arms);
  }
  return most;
}

}  // namespace impinge
