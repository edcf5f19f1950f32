// Stage 12: the step record, with every quantity at the end of the frame.
#include <algorithm>
#include <map>

#include "engine/bodies/deformable_body.hpp"
#include "engine/contact/pair_coefficients.hpp"
#include "engine/core/archive.hpp"
#include "engine/detection/contacts/deepest_vertex.hpp"
#include "engine/step/find_pairs.hpp"
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

/// A contact of before the motion shows how far its own two points went, which is more or less than their bodies overlap.
/// The deepest of two meshes is put where they overlap most, and none shows an overlap where there is none, or more than
/// twice what there is. `of_pair`: theirs, as places in the record.
void show_overlap(const BodyPair& pair, const MeshOverlap& overlap, std::span<const std::size_t> of_pair,
                  const Bodies& bodies, StepRecord& record) {
  const double depth = overlap.deepest ? -overlap.deepest->gap : 0.0;
  const bool is_known = !overlap.crosses || depth > 0.0;  // how deep edges cross, only their contacts tell
  ContactRecord* deepest = nullptr;
  for (const std::size_t i : of_pair) {
    ContactRecord& c = record.contacts[i];
    if (is_known && c.gap < -2.0 * depth) c.point_b += (c.gap + 2.0 * depth) * c.normal, c.gap = -2.0 * depth;
    if (deepest == nullptr || c.gap < deepest->gap) deepest = &c;
  }
  if (depth == 0.0 || (deepest != nullptr && deepest->gap <= -depth)) return;
  const Collision& where = *overlap.deepest;
  if (deepest == nullptr) {
    deepest = &record.contacts.emplace_back();
    deepest->body_a = pair.a, deepest->body_b = pair.b;
    deepest->pair_id = where.feature;
    deepest->group = record.bodies[bodies[pair.a].is_moving() ? pair.a : pair.b].group;
  }
  deepest->triangle_a = where.triangle_a, deepest->triangle_b = where.triangle_b;
  deepest->point_a = where.point_a, deepest->point_b = where.point_b;
  deepest->normal = where.normal;
  deepest->gap = where.gap;
}

void show_overlaps(const Bodies& bodies, std::span<const Collider> colliders, std::span<const TrianglePair> triangles,
                   StepRecord& record) {
  if (triangles.empty()) return;
  std::map<std::pair<BodyIndex, BodyIndex>, std::vector<std::size_t>> contacts;
  for (std::size_t i = 0; i < record.contacts.size(); ++i)
    contacts[{record.contacts[i].body_a, record.contacts[i].body_b}].push_back(i);
  for (std::size_t first = 0, last = 0; first < triangles.size(); first = last) {
    const BodyPair pair{triangles[first].a, triangles[first].b};
    while (last < triangles.size() && triangles[last].a == pair.a && triangles[last].b == pair.b) ++last;
    if (pair.a == pair.b) continue;
    const MeshOverlap overlap = find_overlap(colliders, pair, triangles.subspan(first, last - first));
    show_overlap(pair, overlap, contacts[{pair.a, pair.b}], bodies, record);
  }
}

void show_overlaps_at_end(const Bodies& bodies, const SubStep& step, const Parameters& parameters, StepRecord& record) {
  std::vector<BodyPair> mesh_pairs;
  for (const BodyPair& pair : step.pairs)
    if (bodies[pair.a].shape->mesh() != nullptr && bodies[pair.b].shape->mesh() != nullptr)
      mesh_pairs.push_back({pair.a, pair.b, 0.0});
  if (mesh_pairs.empty()) return;
  std::vector<Collider> colliders;
  make_colliders(bodies, colliders);
  // where motions are not kept short, triangles may meet that were out of reach when contacts were sought
  if (watching(parameters) == Continuous::off || parameters.response.method->lives_on_overlap()) {
    std::vector<TrianglePair> now;
    parameters.narrow_phase.method->find(colliders, mesh_pairs, now);
    return show_overlaps(bodies, colliders, now, record);
  }
  show_overlaps(bodies, colliders, step.triangle_pairs, record);
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
  show_overlaps_at_end(bodies_, s, parameters, next_record_);
  next_record_.attachments.clear();
  stats_.attachment_error = 0.0;
  for (const Attachment& a : attachments_) {
    if (a.number < static_cast<int>(next_record_.attachments.size())) continue;  // the other normal of a line
    const AttachmentHold hold = hold_of(a, bodies_);
    next_record_.attachments.push_back(
        {a.name, a.a.body, a.b.body, hold.point_a, hold.point_b, Vec3::Zero(), a.kind, hold.axis});
    stats_.attachment_error = larger(stats_.attachment_error, next_record_.attachments.back().error());
  }
  const ContactList list = s.contacts(attachments_);
  for (const GroupResult& result : s.results)
    for (std::size_t i = 0; i < result.contacts.size(); ++i)
      if (list.collision(result.contacts[i]) == nullptr)
        next_record_.attachments[list.attachment(result.contacts[i]).number].impulse += result.impulses[i].impulse;
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
  stats_.self_crossings = count_self_crossings(bodies_, CrossingsOf::self_colliding);
  stats_.substep_penetration = std::max(stats_.substep_penetration, stats_.max_penetration);
  stats_.take(balance);
  next_record_.stats = stats_;
  check_finite(next_record_, bodies_);
  ByteWriter state(std::move(next_state_));
  save_state(state);
  next_state_ = state.take();
  std::swap(record_, next_record_);  // so that a frame that may not be published leaves the last one standing
  std::swap(state_, next_state_);
  hash_is_due_ = true;
}

}  // namespace impinge
