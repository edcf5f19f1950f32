#include "engine/contact/contact_settings.hpp"

namespace impinge {
namespace {

const Words<ContactPoints> kPoints = {{ContactPoints::intersection, "intersection"},
                                      {ContactPoints::proximity, "proximity"}};
const Words<PushOut> kPushOut = {{PushOut::split, "split"}, {PushOut::velocity, "velocity"}};
const Words<Reduction> kReduction = {{Reduction::none, "none"}, {Reduction::patch, "patch"}};

}  // namespace

std::string_view name_of(ContactPoints points) { return word_of(kPoints, points); }

void ContactSettings::declare(const Rows& rows) {
  rows.add("points", points, kPoints,
           "Where contacts come from: triangles that intersect already, or features closer than "
           "activation_distance.");
  rows.add("activation_distance", activation_distance, {0.0, 1e3, true}, "m",
           "Features closer than this are contacts (proximity); auto: 0.0024 of the smaller body's size.");
  rows.add("friction", friction, {0.0, 100.0}, "",
           "Coulomb coefficient of bodies that name none; a pair has the geometric mean.");
  rows.add("restitution", restitution, {0.0, 1.0}, "", "Restitution of bodies that name none; a pair has the larger.");
  rows.add("restitution_threshold", restitution_threshold, {0.0, 1e3, true}, "m/s",
           "Slower impacts do not bounce; auto: 0.0049 √(g·size) of the smaller body that moves freely.");
  rows.add("max_push_out", max_push_out, {0.0, 1e6, true}, "m/s",
           "Fastest recovery from overlap that exists already; auto: 0.65 √(g·size) of the body.");
  rows.add("push_out", push_out, kPushOut,
           "Recovery from overlap changes positions only (split), or velocities too, as in the seed (velocity).");
  rows.add("warm_start", warm_start, "Whether a contact starts from its impulse of the last sub-step.");
  rows.add(
      "reduction", reduction, kReduction,
      "Which proximity contacts respond: all that were found (none), or of each patch of one normal those that can "
      "come to carry, and between faces that deform no crossing of edges that their corners cover (patch).");
  rows.add("most_contacts", most_contacts, {4, 1000000}, "",
           "Two rigid bodies with more contacts after reduction are reduced by coarser patches, up to normals of 45 "
           "degrees; what that misses comes back by second_looks.");
  rows.add("turning_solves", turning_solves, {0, 100}, "",
           "How often rigid bodies are solved again where they come nearer to each other by turning than their "
           "velocities say: links, hooks, pins in holes; and whether rows are told what rolls or stands on its tip. "
           "0: never.");
  rows.add("second_looks", second_looks, {0, 100}, "",
           "How often contacts are sought again in a sub-step with the velocities that the response gave "
           "them: what was dropped and is wanted after all, what it drives together that fell side by side, and where "
           "bodies that deform end in others. 0: never.");
  rows.add("successive_impacts", successive_impacts, {0, 1000}, "",
           "How often a sub-step is cut between impacts of rigid bodies of which one leads to the next, so that each "
           "rebounds; of pairs that return a tenth of their energy or more. 0: never.");
}

}  // namespace impinge
