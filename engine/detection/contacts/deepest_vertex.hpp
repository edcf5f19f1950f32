// How deep two meshes lie in one another where they stand, whatever the response believed they would do.
#pragma once

#include <optional>

#include <limits>
#include "engine/detection/collider.hpp"

#include "engine/detection/collision.hpp"

namespace impinge {

struct MeshOverlap {
  bool crosses = false;  ///< a triangle of the one meets one of the other
  /// The vertex of either closed surface that lies deepest inside the other, against the point of that surface nearest
  /// to it: gap = -depth, the normal along the way out. Nothing where only edges cross.
  std::optional<Collision> deepest;
  std::optional<Collision> edge;  ///< the same of a place between the ends of an edge, where that is deeper
};

/// Of two meshes where they stand; `triangles`: of this pair, at least all that cross. Inside is by the nearest
/// feature's normal [Baerentzen05]; vertices are reached from triangles that cross, so that what lies wholly inside is
/// not found. `least_of_edges`: edges are looked at for what is deeper than that, metres (deepest_edge.hpp).
MeshOverlap find_overlap(std::span<const Collider> colliders, const BodyPair& pair,
                         std::span<const TrianglePair> triangles,
                         double least_of_edges = std::numeric_limits<double>::infinity());

}  // namespace impinge
