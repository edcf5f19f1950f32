// Contacts are sought where free velocities lead. The response may lead elsewhere: what one body holds, strikes or drags
// comes upon others that fell beside it and had no contact with it. So rigid bodies whose relative motion the response
// changed are looked at again with the velocities that it gave them, and solved again with what is found.
#pragma once

#include <map>

#include "engine/step/detect.hpp"
#include "engine/step/respond.hpp"

namespace impinge {

/// Of a step that is solved, once or more: looks may be repeated. Pairs with a body that sleeps or deforms are not looked at.
class SecondLook {
 public:
  SecondLook(const Bodies& bodies, const Detecting& by, SubStep& step);

  /// Where the step's velocities lead from now on; whoever finds does so first.
  std::span<const Collider> take_velocities();
  /// Whether the solved velocities lead into what has no contact and would end as an overlap: contacts that were dropped,
  /// and what no search has found yet. Changes nothing.
  bool find(StageTimes& times);
  /// How fast the deepest of that goes beyond the activation distance until the end, m/s; 0: none is as deep.
  double missed_speed() const;
  /// Adds that to the step's pairs, triangle pairs and collisions. `carried`: as reduce_contacts has it.
  void add(const ContactCache& carried);

 private:
  void exchange();
  void hand_on(std::span<const Collision> of_pair, std::size_t count, const std::map<ContactKey, Vec3*>& impulses,
               std::vector<ContactKey>& waiting) const;
  void find_dropped();
  void find_driven(StageTimes& times);
  bool is_anyone_driven() const;
  std::vector<BodyPair> driven_pairs() const;
  bool is_awake_and_rigid(BodyIndex a, BodyIndex b) const;
  bool is_driven(BodyIndex a, BodyIndex b) const;
  double end_gap(const Collision& c) const;
  bool ends_as_overlap(const Collision& c) const;

  using Twists = std::pair<Twist, Twist>;
  const Bodies& bodies_;
  const Detecting& by_;
  SubStep& step_;
  std::vector<Collider>& colliders_;                          // with the solved velocities: the step's later ones
  std::map<std::pair<BodyIndex, BodyIndex>, Twists> sought_;  // of pairs that a look has sought contacts of, with these
  std::vector<Collision> back_;                               // of those that were dropped
  std::vector<BodyPair> pairs_;                               // with something new
  std::vector<TrianglePair> triangles_;
  std::vector<Collision> found_;  // of those pairs
  std::vector<Collision> ahead_;  // overlaps that deforming bodies end in
};

/// What was there before a second look, and its solution: groups which the look leaves alone keep theirs, and an answer
/// that can't be had is not taken.
class SolvedBefore {
 public:
  SolvedBefore(const SubStep& step, const ContactList& contacts);

  /// Groups and results of the step as it is now: each group whose contacts are no longer the same is solved again, from
  /// the impulses in the step's results. Returns the iterations of the answers that this replaces.
  int solve_changed(Bodies& bodies, std::span<const Attachment> attachments, const Solving& how, SubStep& step,
                    StageTimes& times) const;
  /// Whether more groups had an answer, and what that did not see was not far more than what is left unanswered now.
  bool was_better(const SubStep& step, double missed_speed) const;
  /// Returns by how much more iterations it gives up than those of the answers that it brings back.
  int restore(SubStep& step) const;

 private:
  std::vector<Collision> collisions_, dropped_;
  std::vector<Vec3> start_;
  std::vector<CollisionGroup> groups_;
  std::vector<GroupResult> results_;
  std::size_t brought_ = 0;
  std::vector<std::vector<ContactKey>> keys_;  // by group
};

}  // namespace impinge
