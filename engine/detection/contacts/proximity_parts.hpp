// The three sources of proximity contacts of one mesh-mesh body pair, and what they share.
#pragma once

#include <utility>

#include "engine/detection/contacts/surface_view.hpp"

namespace impinge {

/// One body pair with its triangle pairs and what is asked of it.
struct ProximityQuery {
  SurfaceView a, b;
  std::span<const TrianglePair> triangles;
  bool crosses = false;  ///< a triangle pair intersects
  /// Metres; how deep an overlap may be to be taken at face value: as far as the triangle pairs reach, or farther where
  /// they cross.
  double margin = 0.0;
  /// Metres: what edges overlap by that are in front of one another. Where nothing crosses that is rounding, however far
  /// apart the two may be that are looked at.
  double deepest = 0.0;
  double activation = 0.0;  ///< metres
  double time_step = 0.0;   ///< seconds
  /// Features closer than this count as touching, metres: the direction between them is noise and their normals decide.
  double touch = 0.0;
  bool is_self() const { return a.body() == b.body(); }
};

// cosine between the normals of two contacts of one vertex from which on they constrain the same direction (18 degrees)
inline constexpr double kSameSide = 0.95;

/// Contacts of the vertices of a against the surface of b, and of the vertices of b against that of a.
void append_vertex_contacts(const ProximityQuery& query, std::vector<Collision>& contacts);
/// Contacts of two edges that cross.
void append_edge_contacts(const ProximityQuery& query, std::vector<Collision>& contacts);
/// For each intersecting triangle pair that none of `contacts` pushes apart: the shortest way to separate the two
/// triangles.
void append_overlap_contacts(const ProximityQuery& query, std::vector<Collision>& contacts);

/// The direction, from b towards a, in which the surfaces round two touching features separate: of the normals of their
/// faces the one that all edges of a rise along and all edges of b fall along, or the mean of several equals. The
/// second value is the steepest slope against it, as a sine: near 0 the direction separates, negative it does not.
std::pair<Vec3, double> separating_direction(const SurfaceView& a, const SurfaceFeature& fa, const SurfaceView& b,
                                             const SurfaceFeature& fb);

/// Of the contacts of one vertex whose normals constrain the same side (kSameSide), keeps the one with the gap nearest
/// to 0. Contacts without a vertex stay. Leaves the contacts sorted by feature.
void keep_one_a_side(std::vector<Collision>& contacts);
/// `contact` as it is with the bodies exchanged.
Collision exchanged(Collision contact);
/// Keeps the first contact of each feature key, sorted by key.
void sort_by_feature(std::vector<Collision>& contacts);

}  // namespace impinge
