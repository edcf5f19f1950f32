// Solids whose surface is triangles, or can be.
#pragma once

#include "engine/shapes/shape.hpp"

namespace impinge {

/// Whether its triangles are its surface, and not a drawing of what is round, whose triangles are inside it.
inline bool is_faceted(const Shape& shape) {
  if (shape.mesh() != nullptr) return true;
  const ShapeForm form = shape.form();
  const auto* set = std::get_if<const ConvexSet*>(&form);
  return set != nullptr && (*set)->polyhedron() != nullptr;
}

}  // namespace impinge
