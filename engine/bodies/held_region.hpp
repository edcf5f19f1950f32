// Nodes of a deformable body that are held, or moved along a given path.
#pragma once

#include "engine/bodies/motion.hpp"

namespace impinge {

/// Which nodes are held: world coordinates at the start.
struct NodeRegion {
  enum Kind { box, sphere, list } kind = box;
  Vec3 min = Vec3::Zero(), max = Vec3::Zero();  ///< box
  Vec3 center = Vec3::Zero();                   ///< sphere
  double radius = 0.0;
  std::vector<int> nodes;  ///< list
  /// how they are moved: displacement, and rotation about their middle; empty: not at all
  std::vector<MotionKey> motion;
  bool contains(int node, const Vec3& x) const;
};

/// Held nodes and where they go: x(t) = pivot + displacement + p(t) + R(t) (x(0) - pivot), p and R from key frames.
struct HeldRegion {
  std::vector<int> nodes;
  std::vector<Vec3> start;    ///< their positions at the start, world
  Vec3 pivot = Vec3::Zero();  ///< their mean at the start
  Motion motion;
  Vec3 displacement = Vec3::Zero();  ///< where a parameter has moved them so far, metres
  Vec3 wanted = Vec3::Zero();        ///< where it wants them at the end of the frame, metres
  Vec3 at(std::size_t k, double time) const;
  bool is_moved() const { return !motion.is_empty() || displacement != wanted || !displacement.isZero(0.0); }
};

}  // namespace impinge
