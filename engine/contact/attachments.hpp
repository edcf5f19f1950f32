// Attachments in a world: each end is a point of a body, or of the world. What slides is held across its line, plane or
// surface only: one bilateral row a normal, so a line is two planes.
#pragma once

#include "engine/bodies/attachment.hpp"
#include "engine/bodies/bodies.hpp"

namespace impinge {

struct AttachmentEnd {
  BodyIndex body;       ///< none: the world
  MaterialPoint point;  ///< of the body; of the world: `local` is where it is
  Vec3 position(const Bodies& bodies) const;
};

/// What one attachment, or one of the two normals of a line, asks for.
struct Attachment {
  std::string name;
  AttachmentEnd a, b;  ///< b of a slide: a point of the line or plane; of a surface: the body alone
  AttachmentKind kind = AttachmentKind::point;
  Vec3 normal = Vec3::Zero(), other_normal = Vec3::Zero();  ///< of line (both) and plane, as B carries them
  int number = 0;                                           ///< of the attachment in the scene's order
};

/// Where an attachment holds A's point at the bodies' present places.
struct AttachmentHold {
  Vec3 point_a = Vec3::Zero();  ///< of A
  Vec3 point_b = Vec3::Zero();  ///< where it should be: what is nearest of the line, plane or surface
  MaterialPoint at_b;           ///< the material there
  Vec3 normal = Vec3::Zero();   ///< of a slide: unit, across what it slides on
  Vec3 axis = Vec3::Zero();     ///< unit: along the line, or the normal; zero of a point
};
AttachmentHold hold_of(const Attachment& attachment, const Bodies& bodies);

/// One, or of a line two, of the same number. The bodies are in their places at the start. Throws InputError (without a
/// place) for names that aren't there, and where neither end can move.
std::vector<Attachment> make_attachment(const AttachmentDescription& description, const Bodies& bodies, int number);

/// The part of a motion of `time_step` seconds in which what is held in one point and spins can be followed straight: such a
/// body's axis goes round its angular momentum, and rows that see it where the motion begins drive a gyroscope off its pin
/// where it goes round by more than a radian or two. At least 1/32; 1: nothing spins so fast. Rigid bodies; what is held
/// in two points keeps its axis.
double share_of_spins(std::span<const Attachment> attachments, const Bodies& bodies, double time_step);

}  // namespace impinge
