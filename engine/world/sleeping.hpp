// Groups at rest sleep: they keep their poses to the last bit and cost nothing until something touches or changes them.
#pragma once

#include <span>

#include "engine/bodies/rigid_body.hpp"
#include "engine/contact/collision_groups.hpp"
#include "engine/detection/collision.hpp"

namespace impinge {

class ByteReader;
class ByteWriter;

class Sleeping {
 public:
  /// Counts resting time and puts groups to sleep in which every body has rested long enough. `supports` are the
  /// (dynamic body, scripted body) contacts of this sub-step: who moves wakes what rests on it. A body that touches
  /// nothing never sleeps.
  void update(std::span<RigidBody> bodies, std::span<const CollisionGroup> groups,
              std::span<const std::pair<int, int>> supports, double speed, double time, double time_step);
  /// Wakes the islands of sleeping bodies that a collision touches, or whose scripted support moves. True if any woke.
  bool wake_touched(std::span<RigidBody> bodies, std::span<const std::pair<int, int>> touching);
  bool wake_moved_supports(std::span<RigidBody> bodies);
  void wake_all(std::span<RigidBody> bodies);

  void save(ByteWriter& out) const;
  void restore(ByteReader& in);

 private:
  static bool wake_island(std::span<RigidBody> bodies, int island);
  std::vector<std::pair<int, int>> supports_;  // (island, scripted body)
};

}  // namespace impinge
