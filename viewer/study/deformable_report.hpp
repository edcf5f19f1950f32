// What impinge info and impinge check say of deformable bodies.
#pragma once

#include "viewer/controller/session.hpp"

namespace impinge {

/// A few lines for each deformable body; nothing where there is none.
void print_deformable_bodies(const Session& session);

/// Bytes of the body's nodes, elements and stiffness pattern, about.
std::size_t memory_of(const DeformableBody& body);

}  // namespace impinge
