// What acts within a sub-step and not from its start on: impacts of two bodies that meet in flight, and where velocities are
// those of the middle (VelocityTime::middle) what rebounds.
#pragma once

#include <optional>

#include "engine/contact/group_system.hpp"

namespace impinge {

/// By rigid body, metres and radians.
struct LateImpacts {
  std::vector<Vec3> linear, angular;
};

/// x₁ = x₀ + Δt v₁ has every impulse act from the start of the sub-step on. A rebound acts for what is left of it when its
/// gap has closed: this is what the bodies are to be put back by, Σ −t A⁻¹ J^T λ. Where that would end as an overlap with
/// what else they touch, a part of it. None: nothing rebounds, or something of the group deforms.
std::optional<LateImpacts> late_impacts(const GroupSystem& solved, double time_step);

}  // namespace impinge
