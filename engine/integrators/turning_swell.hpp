// How far linearly implicit Euler swells a body that turns.
//
// x₁ = x₀ + h v₁ with v₁ = ω × r leads every point along its tangent, farther out by r (ω h)²/2, and forces see it only in the
// sub-step after, against the stiffness h (h + β) K that A has: a stiff body that turns freely keeps the strain
// e = ω² h (h + β)/2 across its axis, whatever its stiffness, and the elastic energy ∫ 2 (μ + λ) e². Angular momentum
// is kept so, which the schemes that end without this strain lose, by (ω h)² of it in a sub-step.
#pragma once

#include <optional>

namespace impinge {

class DeformableBody;

struct TurningSwell {
  double turn = 0.0;    ///< in a sub-step, radians
  double strain = 0.0;  ///< e
  double energy = 0.0;  ///< J
};

/// Of a body as it turns now, in sub-steps of h seconds; none where something holds its nodes.
std::optional<TurningSwell> turning_swell(const DeformableBody& body, double h);

}  // namespace impinge
