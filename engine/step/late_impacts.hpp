// What acts within a sub-step and not from its start on: what rebounds, where velocities are those of the middle
// (VelocityTime::middle), and two that meet in flight, where they are those of the end.
#pragma once

#include <optional>

#include "engine/contact/assemble.hpp"

namespace impinge {

/// By rigid body, metres and radians.
struct LateImpacts {
  std::vector<Vec3> linear, angular;
};

/// x₁ = x₀ + Δt v₁ has every impulse act from the start of the sub-step on. A rebound acts for what is left of it when its
/// gap has closed: this is what the bodies are to be put back by, Σ −t A⁻¹ J^T λ. Where that would end as an overlap with
/// what else they touch, a part of it. None: nothing rebounds, or something of the group deforms.
std::optional<LateImpacts> late_impacts(const GroupSystem& solved, double time_step);

/// By body of a solved group: 1 where a contact stops it, or turns it round, that closed faster than what rests there.
std::vector<char> struck_bodies(const AssembledGroup& group, const CollisionGroup& of, const ContactList& contacts,
                                const ContactSettings& settings);

/// The group without the contacts of that meeting, and with no answer yet.
GroupSystem without_meeting(const GroupSystem& system);

/// Changes of angular velocity of bodies as they will have turned by then, as changes for their attitude now that change
/// their angular momentum by as much.
std::vector<Vec3> spins_as_they_stand(const Bodies& bodies, const AssembledGroup& group, std::vector<Vec3> changes);

/// x₁ = x₀ + t v₀ + (Δt − t) v₁, and turns likewise: what the bodies are to be put elsewhere by after Δt v₁. `before`: the
/// group without the meeting, solved.
LateImpacts ways_until_meeting(const Bodies& bodies, const AssembledGroup& group, const GroupSystem& before,
                               double time_step);

}  // namespace impinge
