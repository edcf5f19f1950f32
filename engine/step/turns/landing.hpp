// What stands on some of its contacts while others come down: a polygon that rolls, a box that falls on its side. Rows act from
// the start of the sub-step on, and so would the ones that come down: the weight would be on them too early, and turn the body
// back, always that way. So what stands carries until then, and only the rest is solved with all of them.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "engine/contact/contact_settings.hpp"
#include "engine/contact/group_system.hpp"

namespace impinge {

/// What was carried until then: by row, N·s, and by rigid body. A part of what the standing contacts alone do, so that the
/// velocities it leads to are between the free ones and those, and have no more energy.
struct Landing {
  double share = 0.0;  ///< of what the standing contacts would give alone
  std::vector<Vec3> lambda, delta_velocity, delta_angular_velocity;

  /// The system as it is then: its velocities are those of then, and rows start from what is left for them.
  void begin(GroupSystem& system) const;
  /// Of that system, solved: one of the whole sub-step again, with all impulses.
  void close(GroupSystem& system) const;
};

/// Of a solved group of few rigid bodies, of which none rebounds. `carried_before`: by row, in the sub-step before.
/// `solve_standing`: solves the same system without the rows that come down, false where it can't. None: nothing that came
/// down carries, or nothing stood.
std::optional<Landing> find_landing(const GroupSystem& solved, std::span<const Vec3> carried_before,
                                    const ContactSettings& settings, double time_step,
                                    const std::function<bool(GroupSystem&)>& solve_standing);

}  // namespace impinge
