// Narrow phase between meshes: which triangles touch. Pairs with an exact shape go to primitive.hpp instead.
#pragma once

#include "engine/core/method.hpp"
#include "engine/core/registry.hpp"
#include "engine/detection/collider.hpp"
#include "engine/detection/collision.hpp"

namespace impinge {

class NarrowPhase : public Method {
 public:
  /// All triangle pairs of the given mesh-mesh body pairs (a == b: self-collision, triangles that share a vertex left
  /// out) whose distance is <= the pair's margin, sorted and unique, into `found`; `intersecting` tells those that
  /// share a point. Every implementation returns exactly what brute_force does, bit for bit, for any thread count.
  virtual void find(std::span<const Collider> colliders, std::span<const BodyPair> pairs,
                    std::vector<TrianglePair>& found) = 0;
  /// Whether every motion is looked at for surfaces that pass, however slow it is (step/motion_guard.hpp).
  virtual bool watches_every_motion() const { return false; }
  /// Whether nothing is spared: what the others are held against.
  virtual bool tests_every_pair() const { return false; }
};

const Registry<NarrowPhase>& narrow_phases();

}  // namespace impinge
