#include "engine/contact/contact_settings.hpp"

namespace impinge {
namespace {

const Words<ContactPoints> kPoints = {{ContactPoints::intersection, "intersection"},
                                      {ContactPoints::proximity, "proximity"}};
const Words<PushOut> kPushOut = {{PushOut::split, "split"}, {PushOut::velocity, "velocity"}};

}  // namespace

std::string_view name_of(ContactPoints points) { return word_of(kPoints, points); }

void ContactSettings::declare(const Rows& rows) {
  rows.add("points", points, kPoints,
           "Where contacts come from: triangles that intersect already, or features closer than "
           "activation_distance.");
  rows.add("activation_distance", activation_distance, {0.0, 1e3, true}, "m",
           "Features closer than this are contacts (proximity).");
  rows.add("friction", friction, {0.0, 100.0}, "",
           "Coulomb coefficient of bodies that name none; a pair has the geometric mean.");
  rows.add("restitution", restitution, {0.0, 1.0}, "", "Restitution of bodies that name none; a pair has the larger.");
  rows.add("restitution_threshold", restitution_threshold, {0.0, 1e3, true}, "m/s", "Slower impacts do not bounce.");
  rows.add("max_push_out", max_push_out, {0.0, 1e6, true}, "m/s", "Fastest recovery from overlap that exists already.");
  rows.add("push_out", push_out, kPushOut,
           "Recovery from overlap changes positions only (split), or velocities too, as in the seed (velocity).");
  rows.add("warm_start", warm_start, "Whether a contact starts from its impulse of the last sub-step.");
}

}  // namespace impinge
