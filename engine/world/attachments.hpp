// Attachments in a world: each end is a point of a rigid body, of a deformable body's tetrahedron, or of the world.
#pragma once

#include <span>

#include "engine/bodies/attachment.hpp"
#include "engine/bodies/body_names.hpp"
#include "engine/bodies/rigid_body.hpp"

namespace impinge {

struct AttachmentEnd {
  int body = -1;               ///< -1: the world
  int tet = -1;                ///< of a deformable body
  Vec4 weight = Vec4::Zero();  ///< of the tetrahedron's nodes
  Vec3 local = Vec3::Zero();   ///< rigid: in the body's frame; world: where it is
  Vec3 position(std::span<const RigidBody> bodies) const;
};

struct Attachment {
  std::string name;
  AttachmentEnd a, b;
};

/// The bodies are in their places at the start. Throws InputError (without a place) for names that aren't there, and
/// where neither end can move.
Attachment make_attachment(const AttachmentDescription& description, std::span<const RigidBody> bodies,
                           const BodyNames& names);

}  // namespace impinge
