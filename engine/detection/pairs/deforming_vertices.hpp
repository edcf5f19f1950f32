// The vertices of a deforming mesh against a curved solid. What a rigid surface touches it touches where it is nearest;
// of a surface that gives way the neighbours of that place are pressed on by themselves, and each is a contact.
#pragma once

#include "engine/detection/pairs/contact_sink.hpp"

namespace impinge {

/// Whether the sink's shapes are a curved convex solid and a mesh that deforms.
bool has_deforming_vertices(const ContactSink& sink);
/// Adds each vertex that faces the solid and has no contact yet.
void add_deforming_vertices(ContactSink& sink);

}  // namespace impinge
