// One sub-step as the values that its stages hand on. Each stage is a function of a file of its own in this folder (or,
// for what belongs to contacts, in contact/), takes what stands above it here, and fills what is its own; so a sub-step
// can be looked at between any two stages, and a stage done again.
#pragma once

#include "engine/contact/rebound_shares.hpp"
#include "engine/detection/collider.hpp"
#include "engine/step/find_pairs.hpp"
#include "engine/step/group_result.hpp"

namespace impinge {

struct SubStep {
  double time = 0.0, time_step = 0.0;  ///< s, at its start; Δt
  double drift_time = 0.0;             ///< of the piece before, s: in which attachments drifted to where they are
  ReboundShares rebounds;              ///< where they would win energy

  // 5, 6: detection at the free velocities
  std::vector<Collider> colliders;           ///< by body
  SearchBoxes boxes;                         ///< likewise
  std::vector<BodyPair> pairs;               ///< sorted
  std::vector<TrianglePair> triangle_pairs;  ///< sorted; of mesh-mesh pairs
  std::vector<Collision> collisions;         ///< in pair order
  std::vector<Collision> before_flights;     ///< in pair order; those in whose place there are some of a later meeting
  std::vector<Collision> asked;              ///< contacts that a look at the motion asked for, beside those found

  // of a motion that was taken back, for the one that is made instead: its impulses, and what second looks brought
  std::optional<ContactCache> tried;
  std::vector<Collision> brought;
  std::vector<BodyPair> passing;  ///< sorted; rigid bodies whose end is to be looked at because they passed each other

  // 7: contacts that can't come to carry are gone from collisions
  std::vector<Collision> dropped;  ///< in pair order

  // 7: what each contact starts from, on A, world axes, N·s; empty: from nothing
  std::vector<Vec3> start;

  // 8: the contacts of a group are those that something responds to, once it is solved
  std::vector<CollisionGroup> groups;

  // 9, 10: by group
  std::vector<GroupResult> results;

  // 10: contacts of pairs that had some in its earlier pieces only
  std::vector<SolvedContact> parted;

  // 10: pairs whose end second looks saw, sorted
  std::vector<BodyPair> seen_at_end;

  // 10, 12: the colliders later: with the velocities that the response gave to rigid bodies, and where the motion led
  std::vector<Collider> later;

  /// `later` as `colliders` are: of active bodies, or of all where nothing is known of it.
  void begin_later(const Bodies& bodies);
  ContactList contacts(std::span<const Attachment> attachments) const { return {collisions, attachments}; }
  /// Whether the contacts of two are those of where they meet within the sub-step.
  bool is_flight(BodyIndex a, BodyIndex b) const;
  /// None: nothing touches the body.
  GroupIndex group_of(BodyIndex body) const;
};

}  // namespace impinge
