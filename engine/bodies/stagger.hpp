// What a rigid body keeps between sub-steps where its velocity is that of their middle (VelocityTime::middle): positions
// and velocities are half a sub-step apart then, and whoever looks between two sub-steps is shown a velocity that is led on
// to the time of the positions. The lead is taken off again before the next sub-step: it moves nobody.
#pragma once

#include "engine/core/types.hpp"

namespace impinge {

class ByteReader;
class ByteWriter;

struct Stagger {
  Vec3 lead = Vec3::Zero();       ///< of the body's velocity, m/s
  Vec3 spin_lead = Vec3::Zero();  ///< of its angular momentum, kg·m²/s
  /// What impulses made of both in the last sub-step, by the second: an acceleration where the next agrees with it, and a
  /// blow or the end of a slide where it does not.
  Vec3 rate = Vec3::Zero(), spin_rate = Vec3::Zero();

  /// The parts of two rates that are the same: of opposite ones nothing, else the smaller one.
  static Vec3 agreed(const Vec3& last, const Vec3& now);
  void save(ByteWriter& out) const;
  static Stagger restore(ByteReader& in);
};

}  // namespace impinge
