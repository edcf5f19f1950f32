// Groups at rest sleep: they keep their poses to the last bit and cost nothing until something touches or changes them.
#pragma once

#include <set>
#include <span>

#include "engine/bodies/bodies.hpp"
#include "engine/contact/collision_groups.hpp"
#include "engine/core/threshold.hpp"

namespace impinge {

class ByteReader;
class ByteWriter;

/// Two bodies that touch or are joined.
using BodyEnds = std::pair<BodyIndex, BodyIndex>;

/// When a body rests. Automatic: by √(g·size) and √(size/g) of the body.
struct RestThresholds {
  const Threshold& speed;  ///< m/s, of its fastest point
  const Threshold& time;   ///< s in a row
  double gravity;          ///< m/s²
};

class Sleeping {
 public:
  /// Counts resting time and puts groups to sleep in which every body has rested long enough. `supports` are the
  /// (dynamic body, scripted body) contacts of this sub-step: who moves wakes what rests on it. A body that touches
  /// nothing never sleeps, nor does one that is pulled, or being pushed out of another: `pushed`, by body, is how fast, m/s.
  void update(Bodies& bodies, std::span<const CollisionGroup> groups, std::span<const BodyEnds> supports,
              std::span<const double> pushed, const RestThresholds& rest, double time_step);
  /// Wakes the body, with its island if it sleeps.
  void wake(Bodies& bodies, BodyIndex body);
  /// Wakes the islands of sleeping bodies that a collision touches, or whose scripted support moves. Returns who woke,
  /// ascending.
  std::vector<BodyIndex> wake_touched(Bodies& bodies, std::span<const BodyEnds> touching);
  std::vector<BodyIndex> wake_moved_supports(Bodies& bodies);
  void wake_all(Bodies& bodies);

  void save(ByteWriter& out) const;
  void restore(ByteReader& in);

 private:
  static std::vector<BodyIndex> wake_islands(Bodies& bodies, const std::set<BodyIndex>& islands);
  std::vector<BodyEnds> supports_;  // (island, scripted body)
};

}  // namespace impinge
