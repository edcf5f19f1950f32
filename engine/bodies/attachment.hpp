// Two bodies, or a body and the world, joined at a point: one that stays where it is on the other, or slides there.
#pragma once

#include <string>

#include "engine/core/types.hpp"

namespace impinge {

/// Where on body B (or in the world) A's point may be.
enum class AttachmentKind : std::uint8_t {
  point,   ///< where it is at the start
  line,    ///< anywhere on a line that B carries
  plane,   ///< anywhere in a plane that B carries
  surface  ///< anywhere on B's surface
};

struct AttachmentDescription {
  std::string name;
  std::string body_a, body_b;  ///< body_b empty: the world
  Vec3 point = Vec3::Zero();   ///< of both, world coordinates at the start, metres; on a surface: of A
  AttachmentKind kind = AttachmentKind::point;
  Vec3 axis = Vec3::Zero();  ///< along the line or across the plane, world coordinates at the start, of any length
  bool collide = true;       ///< false: the two bodies never touch
};

}  // namespace impinge
