// Stage 12: the step record, with every quantity at the end of the frame.
#include <algorithm>

#include "engine/core/archive.hpp"
#include "engine/world/finite_record.hpp"
#include "engine/world/ledger.hpp"
#include "engine/world/world_stages.hpp"

namespace impinge {
namespace {

/// Detection alone (frame 0): its collisions as contacts that nothing has solved.
SolvedContact unsolved(const Collision& c, const std::vector<RigidBody>& bodies, const Parameters& parameters) {
  SolvedContact contact;
  contact.collision = c;
  contact.local_a = attach_point(bodies[c.body_a], c.triangle_a, c.point_a);
  contact.local_b = attach_point(bodies[c.body_b], c.triangle_b, c.point_b);
  contact.local_normal =
      c.normal_owner >= 0 ? Vec3(bodies[c.normal_owner].pose.rotation.transpose() * c.normal) : c.normal;
  contact.friction = pair_friction(bodies[c.body_a], bodies[c.body_b], parameters);
  return contact;
}

ContactRecord carried(const SolvedContact& contact, const std::vector<RigidBody>& bodies) {
  const Collision& c = contact.collision;
  ContactRecord record;
  record.body_a = c.body_a, record.body_b = c.body_b;
  record.triangle_a = c.triangle_a, record.triangle_b = c.triangle_b;
  record.point_a = carry_point(bodies[c.body_a], c.triangle_a, contact.local_a);
  record.point_b = carry_point(bodies[c.body_b], c.triangle_b, contact.local_b);
  record.normal = c.normal_owner >= 0 ? Vec3(bodies[c.normal_owner].pose.rotation * contact.local_normal) : c.normal;
  record.gap = record.normal.dot(record.point_a - record.point_b);
  record.gap0 = c.gap;
  record.lambda = contact.lambda;
  record.friction = contact.friction;
  record.state = contact.state;
  record.group = contact.group;
  record.pair_id = c.feature;
  return record;
}

}  // namespace

Vec3 attach_point(const RigidBody& body, int triangle, const Vec3& world) {
  return body.soft ? triangle_weights(body, triangle, world) : body.pose.apply_inverse(world);
}

Vec3 carry_point(const RigidBody& body, int triangle, const Vec3& local) {
  if (!body.soft) return body.pose.apply(local);
  const Triangle& t = body.shape->mesh()->mesh.triangles[triangle];
  return local.x() * body.world_vertices[t[0]] + local.y() * body.world_vertices[t[1]] +
         local.z() * body.world_vertices[t[2]];
}

void World::publish(bool solved) {
  Stages& s = *stages_;
  if (!solved) {
    s.contacts.clear();
    for (const Collision& c : s.detection.collisions) s.contacts.push_back(unsolved(c, bodies_, parameters));
    s.make_collision_groups(bodies_, attachments_);
    s.attachment_impulse.assign(attachments_.size(), Vec3::Zero());
    for (std::size_t g = 0; g < s.groups.size(); ++g)
      for (int c : s.groups[g].contacts)
        if (c < static_cast<int>(s.contacts.size())) s.contacts[c].group = static_cast<int>(g);
  }

  StepRecord& record = s.next_record;
  record.bodies.clear();
  for (const RigidBody& body : bodies_) {
    BodyRecord r;
    r.name = body.name;
    r.kind = body.kind;
    r.shape = body.shape.get();
    r.pose = body.pose;
    r.file_pose = body.file_pose();
    r.vertices = body.world_vertices;
    r.bounds = body.bounds();
    r.velocity = body.velocity;
    r.angular_velocity = body.angular_velocity();
    r.mass = body.mass;
    if (body.soft) {
      r.soft = &body.soft->fem;
      r.embedding = &body.soft->embedding;
      r.pose.position = r.file_pose.position = body.soft->fem.center_of_mass();
    }
    r.asleep = body.asleep;
    record.bodies.push_back(r);
  }
  record.groups.clear();
  for (std::size_t g = 0; g < s.groups.size(); ++g) {
    record.groups.push_back(s.groups[g].bodies);
    for (int b : s.groups[g].bodies) record.bodies[b].group = static_cast<int>(g);
  }
  record.broad_pairs = s.detection.pairs;
  record.triangle_pairs = s.detection.triangle_pairs;
  record.contacts.clear();
  for (const SolvedContact& contact : s.contacts) record.contacts.push_back(carried(contact, bodies_));
  record.attachments.clear();
  for (std::size_t i = 0; i < attachments_.size(); ++i) {
    const Attachment& a = attachments_[i];
    record.attachments.push_back(
        {a.name, a.a.body, a.b.body, a.a.position(bodies_), a.b.position(bodies_), s.attachment_impulse[i]});
  }
  record.gravity = parameters.simulation.gravity;
  record.frame_time = parameters.simulation.frame_time;

  FrameStats& stats = s.frame_stats;
  stats.frame = frame_;
  stats.time = time_;
  stats.substeps = parameters.simulation.substeps;
  stats.bodies = static_cast<int>(bodies_.size());
  stats.dofs = stats.asleep = 0;
  for (const RigidBody& body : bodies_) {
    stats.dofs += body.is_dynamic() ? 6 : body.soft ? body.soft->fem.dofs() : 0;
    stats.asleep += body.asleep ? 1 : 0;
  }
  stats.broad_pairs = static_cast<std::int64_t>(record.broad_pairs.size());
  stats.triangle_pairs = static_cast<std::int64_t>(record.triangle_pairs.size());
  stats.contacts = static_cast<std::int64_t>(record.contacts.size());
  stats.groups = static_cast<std::int64_t>(record.groups.size());
  stats.max_penetration = 0.0;
  for (const ContactRecord& c : record.contacts) stats.max_penetration = std::max(stats.max_penetration, -c.gap);
  const Ledger ledger = make_ledger(bodies_, parameters.simulation.gravity);
  stats.kinetic = ledger.kinetic;
  stats.elastic = ledger.elastic;
  stats.potential = ledger.potential;
  stats.momentum = ledger.momentum;
  stats.angular_momentum = ledger.angular_momentum;
  stats.state_hash = state_hash();
  record.stats = stats;
  check_finite(record, bodies_);
  std::swap(record_, record);  // so that a frame that may not be published leaves the last one standing
}

}  // namespace impinge
