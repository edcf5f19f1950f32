// The world's working memory: the algorithms in use and what passes between the stages of a sub-step. Private to
// world/.
#pragma once

#include "engine/contact/contact_cache.hpp"
#include "engine/frozen/frozen_step.hpp"
#include "engine/integrators/deformable_integrator.hpp"
#include "engine/response/response.hpp"
#include "engine/world/detection.hpp"
#include "engine/world/group_assembly.hpp"
#include "engine/world/sleeping.hpp"
#include "engine/world/world.hpp"

namespace impinge {

/// A contact of the last sub-step in the coordinates of its bodies, so that its points can be carried to any later
/// pose.
struct SolvedContact {
  Collision collision;
  // in the body's frame; of a deformable body: weights of the triangle
  Vec3 local_a = Vec3::Zero(), local_b = Vec3::Zero();
  Vec3 local_normal = Vec3::Zero();
  Vec3 lambda = Vec3::Zero();
  double friction = 0.0;
  ContactState state = ContactState::open;
  int group = -1;
};

struct World::Stages {
  Detection detection;
  ContactCache cache;
  Sleeping sleeping;
  std::vector<Twist> before;                    // velocities at the start of the sub-step
  std::vector<std::unique_ptr<SoftStep>> soft;  // a slot a body; null: not deformable
  LinearSolverChoice linear_solver;             // that `soft` was made with
  std::vector<CollisionGroup> groups;
  std::vector<SolvedContact> contacts;
  std::vector<Vec3> attachment_impulse;       // on body A, N·s, of the last sub-step
  std::vector<ContactCache::Item> solved;     // what the cache will hold after this sub-step
  std::vector<std::pair<int, int>> supports;  // (dynamic, scripted) that touch
  std::vector<Twist> push;                    // displacements that recover overlap, by rigid body
  std::vector<VecX> soft_push;                // and by deformable body, over its free nodes; empty: none
  std::uint64_t settings_seen = 0;            // hash of what parameters_changed compares with
  FrameStats frame_stats;                     // sums and maxima over the frame's sub-steps
  StepRecord next_record;                     // of the frame to be published
  FrozenStep* frozen = nullptr;               // if given, gets the groups of the frame's last sub-step
  bool freezing = false;                      // this is that sub-step

  /// Solvers are made anew where another kind is wanted.
  void choose_linear_solver(const LinearSolverChoice& wanted);
  /// Groups of what detection found last, and of the attachments.
  void make_collision_groups(std::span<const RigidBody> bodies, std::span<const Attachment> attachments);
  /// What the impulse of a group's contact is remembered by.
  ContactCache::Item cache_key(std::span<const Attachment> attachments, int contact) const;
  /// What a frozen group keeps beside its system: scene indices and where its contacts are.
  void freeze_geometry(std::span<const RigidBody> bodies, std::span<const Attachment> attachments,
                       const CollisionGroup& group, FrozenGroup& frozen) const;
  void warm_start(std::span<const Attachment> attachments, const CollisionGroup& group, GroupSystem& system) const;
};

/// A point of a body's surface in coordinates that move with it, and back.
Vec3 attach_point(const RigidBody& body, int triangle, const Vec3& world);
Vec3 carry_point(const RigidBody& body, int triangle, const Vec3& local);

}  // namespace impinge
