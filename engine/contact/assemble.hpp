// Stage 9 of a sub-step: the contacts of one group become A, J, v* and bounds.
#pragma once

#include "engine/bodies/time_integration.hpp"
#include "engine/contact/collision_groups.hpp"
#include "engine/contact/contact_settings.hpp"
#include "engine/contact/group_system.hpp"
#include "engine/contact/rebound_shares.hpp"

namespace impinge {

/// What stage 9 reads, the same for every group.
struct AssemblyInput {
  const Bodies& bodies;
  ContactList contacts;
  /// By contact, what its impulse starts from: on A, world axes, N·s; empty: from nothing.
  std::span<const Vec3> start;
  const ContactSettings& settings;
  double time_step = 0.0;                   ///< s
  double gravity = 0.0;                     ///< that automatic thresholds go by, m/s²
  const ReboundShares* rebounds = nullptr;  ///< none: all of them whole
  VelocityTime velocities = VelocityTime::end;
  double drift_time = 0.0;  ///< in which attachments drifted to where they are, s
  /// What touches something that can't respond is pushed at its own surface, not half way across the gap: for responses
  /// that nobody asks where bodies meet in flight. Of two that do respond the common point keeps the angular momentum.
  bool acts_on_surfaces = false;
};

/// A group's system, and what its parts are in the scene.
struct AssembledGroup {
  GroupSystem system;
  std::vector<BodyIndex> rigid, deformable;                     ///< of the system's blocks
  std::vector<ContactIndex> contacts;                           ///< of its rows
  std::vector<std::pair<MaterialPoint, MaterialPoint>> points;  ///< of its rows: where they act on A and B
  /// By row, m/s, world axes: the velocity with which a point is asked to come back to where it is held; empty: none is.
  std::vector<Vec3> recovery;
  std::vector<Vec3> drift;  ///< by row, metres: of an attachment, what is left to recovery on positions; empty: nothing
  double meeting = 0.0;     ///< s, when two whom nothing else touches meet in flight; 0: none do

  /// What a solution over the blocks says of each body of `group`.
  std::vector<BodyVector> by_body(const CollisionGroup& group, const std::vector<Vec3>& linear,
                                  const std::vector<Vec3>& angular, const std::vector<VecX>& nodes) const;
};

/// The group's system at the bodies' free velocities (row_bound.hpp says what contacts ask for); an attachment asks
/// J v = -(x_A - x_B)/Δt, a slide the same along its normal. Contacts that nothing can respond to (of held nodes with an immovable body) are left out.
AssembledGroup assemble(const AssemblyInput& input, const CollisionGroup& group);

}  // namespace impinge
