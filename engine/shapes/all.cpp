// The list of shapes: one line each.
#include "engine/core/registry.hpp"
#include "engine/shapes/shape_entry.hpp"

namespace impinge {

const std::vector<ShapeEntry>& shape_entries() {
  static const std::vector<ShapeEntry> list = [] {
    std::vector<ShapeEntry> all;
    IMPINGE_LIST(all, plane_shape);
    IMPINGE_LIST(all, sphere_shape);
    IMPINGE_LIST(all, box_shape);
    IMPINGE_LIST(all, capsule_shape);
    IMPINGE_LIST(all, mesh_shape);
    IMPINGE_LIST(all, cylinder_shape);
    IMPINGE_LIST(all, cone_shape);
    IMPINGE_LIST(all, convex_hull_shape);
    IMPINGE_LIST(all, compound_shape);
    return all;
  }();
  return list;
}

std::string_view unit_of(ShapeKey::Kind kind) {
  switch (kind) {
    case ShapeKey::length:
      return "m, greater than 0";
    case ShapeKey::lengths:
      return "[x, y, z] in m, greater than 0";
    case ShapeKey::coordinate:
      return "m";
    case ShapeKey::direction:
      return "[x, y, z]";
    case ShapeKey::points:
      return "[[x, y, z], ...] in m";
    case ShapeKey::surface:
      return "a mesh file";
    case ShapeKey::parts:
      return "[{ shape = { ... }, position, rotation }, ...]";
  }
  return "";
}

int shape_type(std::string_view name) {
  const std::vector<ShapeEntry>& entries = shape_entries();
  for (std::size_t i = 0; i < entries.size(); ++i)
    if (entries[i].name == name) return static_cast<int>(i);
  throw InternalError("no line of engine/shapes/all.cpp names the shape '" + std::string(name) + "'");
}

SharedShape make_shape(std::string_view name, const ShapeValues& values) {
  const ShapeEntry& entry = shape_entries()[static_cast<std::size_t>(shape_type(name))];
  IMPINGE_ASSERT(entry.make != nullptr);
  try {
    return entry.make(values);
  } catch (const ShapeError& error) {
    throw InternalError(std::string(name) + " " + error.found + "; " + error.allowed + "; " + error.remedy);
  }
}

}  // namespace impinge
