#include "engine/world/record_parts.hpp"

#include "engine/contact/pair_coefficients.hpp"

namespace impinge {

SolvedContact found_contact(const Collision& c, const Bodies& bodies, const ContactSettings& settings) {
  const Body &a = bodies[c.body_a], &b = bodies[c.body_b];
  return unsolved_contact(c, a.surface_point(c.triangle_a, c.touches_a()), b.surface_point(c.triangle_b, c.touches_b()),
                          pair_friction(a, b, settings), bodies);
}

ContactRecord carried(const SolvedContact& contact, const Bodies& bodies) {
  const Collision& c = contact.collision;
  ContactRecord record;
  record.body_a = c.body_a, record.body_b = c.body_b;
  record.triangle_a = c.triangle_a, record.triangle_b = c.triangle_b;
  record.point_a = bodies[c.body_a].position_of(contact.point_a);
  record.point_b = bodies[c.body_b].position_of(contact.point_b);
  record.normal = normal_of(contact, bodies);
  record.gap = record.normal.dot(record.point_a - record.point_b);
  record.gap0 = c.gap;
  record.lambda = contact.lambda;
  record.friction = contact.friction;
  record.state = contact.state;
  record.group = contact.group;
  record.pair_id = c.feature;
  record.residual = contact.residual;
  return record;
}

BodyRecord record_of(const Body& body) {
  BodyRecord r;
  r.name = body.name;
  r.kind = body.kind();
  r.shape = body.shape.get();
  r.pose = {body.pose.rotation, body.center_of_mass()};
  r.file_pose = body.file_pose();
  r.vertices = body.world_vertices;
  r.bounds = body.bounds();
  const Twist twist = body.deleted ? Twist() : body.twist();
  r.velocity = twist.linear;
  r.angular_velocity = twist.angular;
  r.mass = body.mass;
  r.deformable = body.as<DeformableBody>();
  r.asleep = body.asleep;
  r.deleted = body.deleted;
  if (body.pull) r.pull = {body.position_of(body.pull->point), body.pull->target};
  return r;
}

void show_attachments(std::span<const Attachment> attachments, const Bodies& bodies, StepRecord& record) {
  record.attachments.clear();
  const auto is_deleted = [&](BodyIndex b) { return !b.is_none() && bodies[b].deleted; };
  for (const Attachment& a : attachments) {
    if (!record.attachments.empty() && a.number == record.attachments.back().number) continue;  // a line's other normal
    if (is_deleted(a.a.body) || is_deleted(a.b.body)) continue;
    const AttachmentHold hold = hold_of(a, bodies);
    record.attachments.push_back(
        {a.name, a.a.body, a.b.body, hold.point_a, hold.point_b, Vec3::Zero(), a.kind, hold.axis, a.number});
  }
}

}  // namespace impinge
