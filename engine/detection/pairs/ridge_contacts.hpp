// An edge on an edge that runs the same way, as two cards that lean against each other have it.
#pragma once

#include "engine/detection/pairs/contact_sink.hpp"
#include "engine/geometry/convex/convex_polyhedron.hpp"

namespace impinge {

struct PlacedPolyhedron {
  const ConvexPolyhedron& solid;
  Pose pose;
};

/// The contacts of two polyhedra of which nothing touches but a ridge of each, along their common length; none if
/// something else does. A face that meets there is no better than another, and which of them is the nearest is a matter of
/// rounding: the normal is the middle of all that the two ridges allow. `toward_first` is a direction in which the two
/// are nearest or overlap least, unit. `first` and `second` are the sink's.
std::vector<Candidate> ridge_contacts(const ContactSink& sink, const PlacedPolyhedron& first,
                                      const PlacedPolyhedron& second, const Vec3& toward_first);

/// How near two ridges have to be to be one place, metres; of solids of these sizes (diagonals of their boxes).
double ridge_tolerance(double size_first, double size_second);

}  // namespace impinge
