// Stages 5 and 6 of a sub-step: from bodies to collisions, broad phase first. Sleeping bodies cost nothing here until
// something that moves touches them.
#pragma once

#include "engine/bodies/rigid_body.hpp"
#include "engine/core/profile.hpp"
#include "engine/detection/broadphase/broad_phase.hpp"
#include "engine/detection/collider.hpp"
#include "engine/detection/triangles/narrow_phase.hpp"
#include "engine/world/parameters.hpp"

namespace impinge {

class Detection {
 public:
  /// Fills pairs, triangle_pairs and collisions from the bodies' poses, free velocities and the parameters.
  /// time_step: of the sub-step that follows, seconds.
  void run(std::span<const RigidBody> bodies, const Parameters& parameters, double time_step, StageTimes& times);

  std::vector<BodyPair> pairs;               ///< sorted
  std::vector<TrianglePair> triangle_pairs;  ///< sorted; of mesh-mesh pairs
  std::vector<Collision> collisions;         ///< in pair order

 private:
  void find_pairs(std::span<const RigidBody> bodies, const Parameters& parameters, double time_step);
  void find_collisions(const Parameters& parameters, double time_step);

  std::vector<Collider> colliders_;
  std::vector<Aabb> boxes_;
  std::vector<BoxPair> box_pairs_;
  std::vector<std::vector<Collision>> found_;  // one slot a pair, so that threads don't share
};

}  // namespace impinge
