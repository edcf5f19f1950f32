// Stage 1 of a frame: what somebody does to a body between two frames.
#pragma once

#include <optional>
#include <string>

#include "engine/core/types.hpp"

namespace impinge {

struct Act {
  enum Verb {
    pull,     ///< by a damped spring, from now on (bodies/pull.hpp)
    release,  ///< no longer
    push,     ///< gives it an impulse
    move,     ///< puts it elsewhere; its velocities stay
    remove,   ///< it takes no part from now on
    add       ///< brings an absent body to life: World::act does it
  };
  Verb verb = pull;
  std::string body;
  /// Of pull: where to, world, metres; of push: N·s; of move: by, metres; of add: where its file's origin is, metres.
  Vec3 vector = Vec3::Zero();
  std::optional<Vec3> point = {};  ///< of pull: on the body, its own coordinates; of push: world, none: centre of mass
  double stiffness = 0.0;          ///< of pull, N/m; 0: by the body's mass
  Vec3 axis = Vec3::Zero();        ///< of move and add: what it is turned about, of any length
  double degrees = 0.0;            ///< and by how much
  std::string like = {};           ///< of add: the body that it is a copy of
  Vec3 velocity = Vec3::Zero();    ///< of add, m/s
};

/// What a body is turned by; the identity for an act without an axis.
Mat3 turn_of(const Act& act);

class Bodies;
class ContactCache;
class Sleeping;

/// Does it, if it is no add, to the body of that name, which is there; all but remove want one that has freedom (or had,
/// and is deleted: nothing comes of it). Who sleeps and is touched by it wakes.
void act_on(Bodies& bodies, const Act& act, double frame_time, Sleeping& sleeping, ContactCache& cache);

}  // namespace impinge
