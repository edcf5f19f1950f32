// A damped spring from a point of a body to a place in the world: what a hand that drags a body does.
#pragma once

#include "engine/bodies/material_point.hpp"

namespace impinge {

class ByteReader;
class ByteWriter;

struct Pull {
  MaterialPoint point;         ///< of the body; of a deformable one: in a tetrahedron
  Vec3 target = Vec3::Zero();  ///< world, metres
  double stiffness = 0.0;      ///< N/m
  double damping = 0.0;        ///< N s/m, of the point's velocity

  /// N, on the point where it is `at` and moves with `velocity`.
  Vec3 force(const Vec3& at, const Vec3& velocity) const { return stiffness * (target - at) - damping * velocity; }
  /// The change of its impulse over a sub-step of h seconds by a change of the point's velocity that lasts through it,
  /// kg. Whoever solves for the velocity at the end with this on the left is stable for any stiffness.
  double mass(double h) const { return mass(h, h); }
  /// The same where its force acts for `kick` seconds of the h in which the point moves.
  double mass(double kick, double h) const { return kick * (damping + h * stiffness); }

  void save(ByteWriter& out) const;
  static Pull restore(ByteReader& in);
};

/// Critically damped where it moves the whole of `mass`, kg.
double critical_damping(double stiffness, double mass);

/// What a pull has where nobody says otherwise, N/m: a body of `mass` kg comes after the hand with the time constant of
/// four frames. Sub-steps are no longer than a frame, so they resolve that motion whatever they are.
double default_stiffness(double mass, double frame_time);

}  // namespace impinge
