// A polyhedron against a mesh: its contacts are those of two meshes, with the polyhedron's own frame as the search
// structure. It still counts as an exact shape: triangle -1, features of the polyhedron.
#pragma once

#include <functional>

#include "engine/detection/pairs/contact_sink.hpp"
#include "engine/detection/pairs/touched_triangles.hpp"
#include "engine/geometry/oriented_box.hpp"

namespace impinge {

struct PolyhedronView {
  OrientedBox frame;             ///< a box round it, along its own axes
  TouchingSolid touching;        ///< the polyhedron itself
  const SurfaceMesh* surface;    ///< its triangles
  std::function<int(int)> face;  ///< the face that a triangle is part of
  /// Moves a candidate's first point, found on a triangle of the face that its first feature names, to where it lies on
  /// the face as a whole. Returns whether its second point lies beside the face instead of over or under it.
  std::function<bool(Candidate&)> place_on_face;
};

/// The sink's first shape is the polyhedron, the second the mesh.
void polyhedron_against_mesh(ContactSink& sink, const PolyhedronView& solid);

/// A convex solid whose centre (world) is inside a mesh that its surface is not near: out along the shortest way from
/// the centre. Returns whether it was.
bool add_enclosed(ContactSink& sink, const Vec3& center, const std::function<double(const Vec3&)>& reach_against);

}  // namespace impinge
