// Attachments in a world: each end is a point of a body, or of the world.
#pragma once

#include "engine/bodies/attachment.hpp"
#include "engine/bodies/bodies.hpp"

namespace impinge {

struct AttachmentEnd {
  BodyIndex body;       ///< none: the world
  MaterialPoint point;  ///< of the body; of the world: `local` is where it is
  Vec3 position(const Bodies& bodies) const;
};

struct Attachment {
  std::string name;
  AttachmentEnd a, b;
};

/// The bodies are in their places at the start. Throws InputError (without a place) for names that aren't there, and
/// where neither end can move.
Attachment make_attachment(const AttachmentDescription& description, const Bodies& bodies);

}  // namespace impinge
