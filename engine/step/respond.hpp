// Stages 9 and 10 of a sub-step: the system of each group, the response, and what follows from the impulses.
#pragma once

#include "engine/bodies/time_integration.hpp"
#include "engine/step/solve_watcher.hpp"
#include "engine/step/sub_step.hpp"

namespace impinge {

/// What the groups are solved by.
struct Solving {
  const Response& response;
  const LcpSolver& lcp;
  ResponseContext context;
  const ContactSettings& contact;
  const DeformableIntegrator& integrator;
  double gravity;  ///< that automatic thresholds go by, m/s²
  VelocityTime velocities = VelocityTime::end;
  double drift_time = 0.0;                  ///< as SubStep has it
  const ReboundShares* rebounds = nullptr;  ///< as SubStep has them
  bool freezes = false;                     ///< the groups are wanted as they were handed to the response
  bool keeps_rows = false;                  ///< what rows gave to bodies is wanted
  /// Contacts may still be added: large groups are solved as GroupResult::is_provisional has it.
  bool is_provisional = false;
  /// By body, with the velocities of the answer before: large groups are told what turning takes by these.
  std::span<const Collider> expected = {};
  SolveWatcher* watcher = nullptr;
};

/// Groups are independent, so threads share them. What of several is thrown is what the lowest group throws. Results by
/// group; those of groups that `is_known` has (empty: none) are left as they are, and those that were
/// provisional and are solved again are there.
void respond(Bodies& bodies, const ContactList& contacts, std::span<const Vec3> start,
             std::span<const CollisionGroup> groups, const std::vector<char>& is_known, const Solving& how,
             std::vector<GroupResult>& results, StageTimes& times);

/// One group. Of the bodies, those of the group may have A and b taken anew (Newton schemes); nothing else changes.
/// `iterations`: that its answer took, if it was solved before.
GroupResult respond_to_group(Bodies& bodies, const AssemblyInput& input, const CollisionGroup& group, GroupIndex index,
                             const Solving& how, int iterations = 0);

}  // namespace impinge
