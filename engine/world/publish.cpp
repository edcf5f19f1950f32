// Stage 12: the step record, with every quantity at the end of the frame.
#include <algorithm>

#include "engine/bodies/deformable_body.hpp"
#include "engine/contact/pair_coefficients.hpp"
#include "engine/step/sub_step.hpp"
#include "engine/world/finite_record.hpp"
#include "engine/world/self_crossings.hpp"
#include "engine/world/world.hpp"

namespace impinge {
namespace {

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
  const Twist twist = body.twist();
  r.velocity = twist.linear;
  r.angular_velocity = twist.angular;
  r.mass = body.mass;
  r.deformable = body.as<DeformableBody>();
  r.asleep = body.asleep;
  return r;
}

}  // namespace

void World::publish_found() {
  SubStep& s = *sub_step_;
  s.results.clear();
  s.groups = find_groups(bodies_, s.contacts(attachments_));
  std::vector<SolvedContact> contacts;
  for (const Collision& c : s.collisions) {
    const Body &a = bodies_[c.body_a], &b = bodies_[c.body_b];
    contacts.push_back(unsolved_contact(c, a.surface_point(c.triangle_a, c.point_a),
                                        b.surface_point(c.triangle_b, c.point_b),
                                        pair_friction(a, b, parameters.contact), bodies_));
  }
  for (GroupIndex g(0); g < s.groups.size(); ++g)
    for (const ContactIndex c : s.groups[g].contacts)
      if (c < contacts.size()) contacts[c].group = g;
  publish(contacts);
}

void World::publish_solved() {
  std::vector<SolvedContact> contacts;
  for (const GroupResult& result : sub_step_->results)
    contacts.insert(contacts.end(), result.solved.begin(), result.solved.end());
  publish(contacts);
}

void World::publish(std::span<const SolvedContact> contacts) {
  const SubStep& s = *sub_step_;
  next_record_.bodies.clear();
  for (const Body& body : bodies_) next_record_.bodies.push_back(record_of(body));
  next_record_.groups.clear();
  for (GroupIndex g(0); g < s.groups.size(); ++g) {
    next_record_.groups.push_back(s.groups[g].bodies);
    for (const BodyIndex b : s.groups[g].bodies) next_record_.bodies[b].group = g;
  }
  next_record_.broad_pairs = s.pairs;
  next_record_.triangle_pairs = s.triangle_pairs;
  next_record_.contacts.clear();
  for (const SolvedContact& contact : contacts) next_record_.contacts.push_back(carried(contact, bodies_));
  next_record_.attachments.clear();
  for (const Attachment& a : attachments_)
    next_record_.attachments.push_back(
        {a.name, a.a.body, a.b.body, a.a.position(bodies_), a.b.position(bodies_), Vec3::Zero()});
  const ContactList list = s.contacts(attachments_);
  for (const GroupResult& result : s.results)
    for (std::size_t i = 0; i < result.contacts.size(); ++i)
      if (list.collision(result.contacts[i]) == nullptr)
        next_record_.attachments[list.attachment_at(result.contacts[i])].impulse = result.impulses[i].impulse;
  next_record_.gravity = parameters.simulation.gravity;
  next_record_.frame_time = parameters.simulation.frame_time;

  stats_.frame = frame_;
  stats_.time = time_;
  stats_.substeps = parameters.simulation.substeps;
  stats_.bodies = bodies_.size();
  stats_.dofs = stats_.asleep = 0;
  Balance balance;
  for (Body& body : bodies_) {
    stats_.dofs += body.dofs();
    stats_.asleep += body.asleep ? 1 : 0;
    balance += body.balance(parameters.simulation.gravity);
  }
  stats_.broad_pairs = static_cast<std::int64_t>(next_record_.broad_pairs.size());
  stats_.triangle_pairs = static_cast<std::int64_t>(next_record_.triangle_pairs.size());
  stats_.contacts = static_cast<std::int64_t>(next_record_.contacts.size());
  stats_.groups = static_cast<std::int64_t>(next_record_.groups.size());
  stats_.max_penetration = 0.0;
  for (const ContactRecord& c : next_record_.contacts)
    stats_.max_penetration = std::max(stats_.max_penetration, -c.gap);
  stats_.self_crossings = count_self_crossings(bodies_);
  stats_.take(balance);
  stats_.state_hash = state_hash();
  next_record_.stats = stats_;
  check_finite(next_record_, bodies_);
  std::swap(record_, next_record_);  // so that a frame that may not be published leaves the last one standing
}

}  // namespace impinge
