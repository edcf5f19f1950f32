// Stage 12: the step record, with every quantity at the end of the frame.
#include <algorithm>
#include <functional>
#include <map>
#include <optional>

#include "engine/contact/pair_scale.hpp"
#include "engine/detection/contacts/deepest_vertex.hpp"
#include "engine/shapes/primitives.hpp"
#include "engine/shapes/wall.hpp"
#include "engine/step/end_pose.hpp"
#include "engine/step/find_pairs.hpp"
#include "engine/step/sub_step.hpp"
#include "engine/world/finite_record.hpp"
#include "engine/world/record_parts.hpp"
#include "engine/world/self_crossings.hpp"
#include "engine/world/world.hpp"

namespace impinge {
namespace {

constexpr double kLeastOfEdges = 4e-4;  // of the activation distance: edges are shown that are deeper
constexpr double kOfVertices = 1e-6;  // of the smaller body's extent: deeper vertices tell how deep a pair is, within 2

bool has_slid(const ContactRecord& c, double activation) {
  return have_parted(c.point_a - c.point_b, c.normal, activation);
}

/// A contact of before the motion shows how far its own two points went, which is more or less than their bodies overlap.
/// The deepest of a pair is put where they overlap most, and none shows an overlap where there is none, or more than
/// twice what there is. `of_pair`: theirs, as places in the record.
void show_overlap(const BodyPair& pair, const MeshOverlap& overlap, std::span<const std::size_t> of_pair,
                  const Bodies& bodies, double activation, StepRecord& record) {
  const Collision* where = overlap.edge ? &*overlap.edge : overlap.deepest ? &*overlap.deepest : nullptr;
  const double of_vertices = overlap.deepest ? -overlap.deepest->gap : 0.0;
  const bool is_known = !overlap.crosses || where != nullptr;  // how deep edges graze, only their contacts tell
  // judged_penetration_m is of vertices: where they are in one another no more than twice of it is shown
  const double extent = std::min(bodies[pair.a].bounds().extent().norm(), bodies[pair.b].bounds().extent().norm());
  const double most = of_vertices > kOfVertices * extent ? 2.0 * of_vertices
                      : where != nullptr                 ? -2.0 * where->gap
                                                         : 0.0;
  const double depth = where != nullptr ? std::min(-where->gap, most) : 0.0;
  ContactRecord* deepest = nullptr;
  for (const std::size_t i : of_pair) {
    ContactRecord& c = record.contacts[i];
    if ((is_known || has_slid(c, activation)) && c.gap < -most) c.point_b += (c.gap + most) * c.normal, c.gap = -most;
    if (deepest == nullptr || c.gap < deepest->gap) deepest = &c;
  }
  if (depth == 0.0 || (deepest != nullptr && deepest->gap <= -depth)) return;
  if (deepest == nullptr) {
    deepest = &record.contacts.emplace_back();
    deepest->body_a = pair.a, deepest->body_b = pair.b;
    deepest->pair_id = where->feature;
    deepest->group = record.bodies[bodies[pair.a].is_moving() ? pair.a : pair.b].group;
  }
  deepest->triangle_a = where->triangle_a, deepest->triangle_b = where->triangle_b;
  deepest->point_a = where->point_a, deepest->point_b = where->point_b + (where->gap + depth) * where->normal;
  deepest->normal = where->normal;
  deepest->gap = -depth;
}

using ContactsOfPairs = std::map<std::pair<BodyIndex, BodyIndex>, std::vector<std::size_t>>;

ContactsOfPairs contacts_of_pairs(const StepRecord& record) {
  ContactsOfPairs contacts;
  for (std::size_t i = 0; i < record.contacts.size(); ++i)
    contacts[{record.contacts[i].body_a, record.contacts[i].body_b}].push_back(i);
  return contacts;
}

/// A surface that bends slides over a round shape by more than its contacts' tangents tell, and so does any other in a
/// motion that is long. And where detection lost a contact with a mesh, none tells of the overlap that comes of it.
void show_overlaps_of_shapes(const Bodies& bodies, const SubStep& step, const Parameters& parameters,
                             StepRecord& record) {
  const auto bends = [&](BodyIndex b) { return bodies[b].kind() == BodyKind::deformable; };
  const auto is_mesh = [&](BodyIndex b) { return bodies[b].shape->mesh() != nullptr; };
  const auto is_plane = [&](BodyIndex b) { return bodies[b].shape->as<Plane>() != nullptr; };
  const auto is_of_shapes = [&](const BodyPair& pair) {
    return !is_plane(pair.a) && !is_plane(pair.b) && !(is_mesh(pair.a) && is_mesh(pair.b));
  };
  const auto activation = [&](const BodyPair& pair) {
    return parameters.contact.activation(pair_size(bodies[pair.a], bodies[pair.b]));
  };
  std::vector<BodyPair> pairs;
  std::optional<ContactsOfPairs> contacts;  // once somebody asks: what sleeps doesn't
  const auto is_lost = [&](const BodyPair& pair) {
    const Body &a = bodies[pair.a], &b = bodies[pair.b];
    if (!is_mesh(pair.a) && !is_mesh(pair.b)) return false;  // formulas lose none
    if ((a.asleep && b.asleep) || !overlap(a.bounds(), b.bounds())) return false;
    if (!contacts) contacts = contacts_of_pairs(record);
    return !contacts->contains({pair.a, pair.b});
  };
  for (const BodyPair& pair : step.pairs)
    if (is_of_shapes(pair) && (bends(pair.a) || bends(pair.b) || is_lost(pair))) pairs.push_back({pair.a, pair.b});
  for (const ContactRecord& c : record.contacts) {
    const BodyPair pair{c.body_a, c.body_b};
    if (is_of_shapes(pair) && (has_slid(c, activation(pair)) || is_idle_overlap(c.lambda, c.gap, activation(pair))))
      pairs.push_back(pair);
  }
  if (pairs.empty()) return;
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  if (!contacts) contacts = contacts_of_pairs(record);
  const std::vector<std::optional<Collision>> deepest = deepest_now(bodies, detecting(parameters), pairs);
  for (std::size_t i = 0; i < pairs.size(); ++i)
    show_overlap(pairs[i], {deepest[i].has_value(), deepest[i], {}}, (*contacts)[{pairs[i].a, pairs[i].b}], bodies,
                 activation(pairs[i]), record);
}

/// Of the pairs that there are triangles of, and of those of `also` that there are none of.
void show_overlaps(const Bodies& bodies, const ContactSettings& contact, std::span<const Collider> colliders,
                   std::span<const TrianglePair> triangles, StepRecord& record, std::vector<BodyPair> also = {}) {
  if (triangles.empty() && also.empty()) return;
  ContactsOfPairs contacts = contacts_of_pairs(record);
  for (std::size_t first = 0, last = 0; first < triangles.size(); first = last) {
    const BodyPair pair{triangles[first].a, triangles[first].b};
    while (last < triangles.size() && triangles[last].a == pair.a && triangles[last].b == pair.b) ++last;
    if (pair.a == pair.b) continue;
    const double activation = contact.activation(pair_size(bodies[pair.a], bodies[pair.b]));
    const MeshOverlap overlap =
        find_overlap(colliders, pair, triangles.subspan(first, last - first), kLeastOfEdges * activation);
    show_overlap(pair, overlap, contacts[{pair.a, pair.b}], bodies, activation, record);
    std::erase(also, pair);
  }
  for (const BodyPair& pair : also) {  // the one may be inside the other, where its contact is all that tells how deep
    const double activation = contact.activation(pair_size(bodies[pair.a], bodies[pair.b]));
    show_overlap(pair, {true, {}, {}}, contacts[{pair.a, pair.b}], bodies, activation, record);
  }
}

/// Pairs of meshes with an overlap to show that detection has no triangles of: a look at the motion asked for their contacts.
std::vector<BodyPair> asked_pairs(const Bodies& bodies, std::span<const TrianglePair> known, const StepRecord& record) {
  std::vector<BodyPair> pairs;
  for (const ContactRecord& c : record.contacts) {
    const bool are_meshes = bodies[c.body_a].shape->mesh() != nullptr && bodies[c.body_b].shape->mesh() != nullptr;
    if (!(c.gap < 0.0) || !are_meshes || c.body_a == c.body_b) continue;
    const auto bodies_of = [](const TrianglePair& t) { return std::pair(t.a, t.b); };
    if (!std::ranges::binary_search(known, std::pair(c.body_a, c.body_b), std::less(), bodies_of))
      pairs.push_back({c.body_a, c.body_b, 0.0});
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

void show_overlaps_at_end(const Bodies& bodies, SubStep& step, const Parameters& parameters, StepRecord& record) {
  show_overlaps_of_shapes(bodies, step, parameters, record);
  std::vector<BodyPair> mesh_pairs;
  for (const BodyPair& pair : step.pairs)
    if (bodies[pair.a].shape->mesh() != nullptr && bodies[pair.b].shape->mesh() != nullptr)
      mesh_pairs.push_back({pair.a, pair.b, 0.0});
  if (mesh_pairs.empty()) return;
  make_colliders(bodies, step.later);
  const std::span<const Collider> colliders = step.later;
  std::vector<TrianglePair> now;
  std::span<const TrianglePair> known = step.triangle_pairs;
  // where motions are not kept short, triangles may meet that were out of reach when contacts were sought
  if (watching(parameters) == Continuous::off || parameters.response.method->lives_on_overlap()) {
    parameters.narrow_phase.method->find(colliders, mesh_pairs, now);
    known = now;
  }
  show_overlaps(bodies, parameters.contact, colliders, known, record);
  const std::vector<BodyPair> asked = asked_pairs(bodies, known, record);
  if (asked.empty()) return;
  std::vector<TrianglePair> of_asked;
  parameters.narrow_phase.method->find(colliders, asked, of_asked);
  show_overlaps(bodies, parameters.contact, colliders, of_asked, record, asked);
}

/// The contact that is deepest as a share of the thinner one's thickness; of shallow ones nobody asks.
Crossing sunk_deepest(const Bodies& bodies, std::span<const ContactRecord> contacts) {
  constexpr double kShallow = 0.01;  // of a size
  Crossing deepest;
  for (const ContactRecord& c : contacts) {
    const Body &a = bodies[c.body_a], &b = bodies[c.body_b];
    if (c.body_a == c.body_b || -c.gap <= kShallow * pair_size(a, b)) continue;
    const double thickness = std::min(wall_of(*a.shape), wall_of(*b.shape));
    if (std::isfinite(thickness) && -c.gap > deepest.share() * thickness)
      deepest = {a.name, b.name, -c.gap, thickness, 0};
  }
  return deepest;
}

/// Nothing of one that is deleted.
BodyShare share_of(Body& body, const Vec3& gravity) {
  if (body.deleted) return {};
  return {1, body.dofs(), body.asleep ? 1 : 0, count_self_crossings(body, CrossingsOf::self_colliding),
          body.balance(gravity)};
}

}  // namespace

void World::publish_found() {
  SubStep& s = *sub_step_;
  s.results.clear(), s.parted.clear();
  s.groups = find_groups(bodies_, s.contacts(attachments_));
  std::vector<SolvedContact> contacts;
  for (const Collision& c : s.collisions) contacts.push_back(found_contact(c, bodies_, parameters.contact));
  for (GroupIndex g(0); g < s.groups.size(); ++g)
    for (const ContactIndex c : s.groups[g].contacts)
      if (c < contacts.size()) contacts[c].group = g;
  publish(contacts);
}

StepRecord World::record_of_all() const {
  StepRecord all = record();
  for (const Body& body : bodies_)
    if (body.absent) all.bodies.push_back(record_of(body)), all.bodies.back().deleted = false;
  return all;
}

std::vector<SolvedContact> World::solved_contacts() const {
  std::vector<SolvedContact> contacts;
  for (const GroupResult& result : sub_step_->results)
    contacts.insert(contacts.end(), result.solved.begin(), result.solved.end());
  contacts.insert(contacts.end(), sub_step_->parted.begin(), sub_step_->parted.end());
  return contacts;
}

void World::publish_solved() { publish(solved_contacts()); }

void World::publish(std::span<const SolvedContact> contacts) {
  describe(contacts, stats_, next_record_);
  check_finite(next_record_, bodies_);
  next_state_.take(frame_, time_, bodies_, cache_, sleeping_);
  std::swap(record_, next_record_);  // so that a frame that may not be published leaves the last one standing
  std::swap(state_, next_state_);
  hash_is_due_ = true;
  is_published_ = true;
}

/// The bodies as they are, with figures to which those of the sub-steps made so far have been added.
void World::describe(std::span<const SolvedContact> contacts, FrameStats& stats, StepRecord& record) {
  SubStep& s = *sub_step_;
  for (const std::vector<BodyIndex>& group : record.groups)
    for (const BodyIndex b : group) record.bodies[b].group = {};
  const std::size_t present = static_cast<std::size_t>(bodies_.present().value());
  const std::span<const BodyIndex> changed = bodies_.to_renew(record.bodies.size() == present);
  record.bodies.resize(present);
  for (const BodyIndex b : changed)
    if (b < present) record.bodies[b] = record_of(bodies_[b]);
  record.groups.clear();
  for (GroupIndex g(0); g < s.groups.size(); ++g) {
    record.groups.push_back(s.groups[g].bodies);
    for (const BodyIndex b : s.groups[g].bodies) record.bodies[b].group = g;
  }
  record.broad_pairs = s.pairs;
  record.triangle_pairs = s.triangle_pairs;
  record.contacts.clear();
  for (const SolvedContact& contact : contacts) record.contacts.push_back(carried(contact, bodies_));
  show_overlaps_at_end(bodies_, s, parameters, record);
  show_attachments(attachments_, bodies_, record);
  stats.attachment_error = 0.0;
  for (const AttachmentRecord& a : record.attachments)
    stats.attachment_error = larger(stats.attachment_error, a.error());
  const ContactList list = s.contacts(attachments_);
  for (const GroupResult& result : s.results)
    for (std::size_t i = 0; i < result.contacts.size(); ++i)
      if (list.collision(result.contacts[i]) == nullptr)
        std::lower_bound(record.attachments.begin(), record.attachments.end(),
                         list.attachment(result.contacts[i]).number,
                         [](const AttachmentRecord& a, int number) { return a.number < number; })
            ->impulse += result.impulses[i].impulse;
  record.gravity = parameters.simulation.gravity;
  record.frame_time = parameters.simulation.frame_time;

  stats.unsafe_motions = static_cast<std::int64_t>(unsafe_.size());
  stats.unsafe.clear();
  for (const auto& [body, unsafe] : unsafe_) stats.unsafe.push_back(unsafe);
  stats.frame = frame_;
  stats.time = time_;
  stats.substeps = parameters.simulation.substeps;
  const bool are_known = shares_.size() == static_cast<std::size_t>(bodies_.size().value());
  shares_.resize(static_cast<std::size_t>(bodies_.size().value()));
  for (const BodyIndex b : bodies_.to_renew(are_known))
    shares_[b] = share_of(bodies_[b], parameters.simulation.gravity);
  stats.take(shares_);
  stats.broad_pairs = static_cast<std::int64_t>(record.broad_pairs.size());
  stats.triangle_pairs = static_cast<std::int64_t>(record.triangle_pairs.size());
  stats.contacts = static_cast<std::int64_t>(record.contacts.size());
  stats.groups = static_cast<std::int64_t>(record.groups.size());
  stats.max_penetration = 0.0;
  for (const ContactRecord& c : record.contacts) stats.max_penetration = std::max(stats.max_penetration, -c.gap);
  stats.crossing = sunk_deepest(bodies_, record.contacts);  // a judge puts what he finds in its place
  stats.substep_penetration = std::max(stats.substep_penetration, stats.max_penetration);
  record.stats = stats;
}

}  // namespace impinge
