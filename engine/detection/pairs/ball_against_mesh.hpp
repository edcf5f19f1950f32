// A ball against a mesh: the contacts of a sphere, of a capsule's caps, and the way out of a body that is deep inside.
#pragma once

#include <optional>
#include <span>

#include "engine/detection/contacts/surface_view.hpp"
#include "engine/detection/pairs/contact_sink.hpp"

namespace impinge {

/// A ball of the sink's first shape and the name its contacts have there.
struct Ball {
  Vec3 center = Vec3::Zero();
  double radius = 0.0;
  Feature kind = Feature::shape;
  int index = 0;
  Vec3 rest = Vec3::Zero();  ///< from the centre to where the rest of its body is; zero: nowhere
};

/// The middle one of the directions at right angles to an axis from which no surface is seen that leaves a point along
/// `star`, unit; none if there is none, and if the surface is flat there.
std::optional<Vec3> way_across(const Vec3& axis, std::span<const Vec3> star);

/// Adds the contacts of a ball with the mesh that is the sink's second shape. A centre outside gives one contact for
/// each local minimum of its distance to the surface (a ball on a tessellated plane has one, wherever it rolls); a
/// centre inside gives one, out through the nearest point. Returns whether the centre is inside.
bool add_ball_contacts(ContactSink& sink, const SurfaceView& mesh, const Ball& ball);

/// The shortest way out of the mesh that is the sink's second shape for a point x, as a contact of a ball without radius
/// that is in no sink; none if x is outside. Whether x is near the surface doesn't matter.
std::optional<Collision> way_out(const ContactSink& sink, const SurfaceView& mesh, const Vec3& x);

}  // namespace impinge
