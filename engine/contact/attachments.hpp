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

/// The part of a motion of `time_step` seconds in which what is held in points and turns can be followed straight. Points
/// that go round on arms leave each other where their bodies turn far: a whip, a pendulum of few sub-steps a period, a
/// light chain with a heavy end came apart from a fraction of a radian on. And what spins on one point has an axis that goes
/// round its angular momentum: rows that see it where the motion begins drove a gyroscope off its pin from a radian or two
/// on. At least 1/32; 1: nothing turns so fast. Rigid bodies.
double share_of_turns(std::span<const Attachment> attachments, const Bodies& bodies, double time_step);

/// How far the points of an attachment are from each other at most, of the arms that their bodies have there.
double most_apart(std::span<const Attachment> attachments, const Bodies& bodies);

}  // namespace impinge
