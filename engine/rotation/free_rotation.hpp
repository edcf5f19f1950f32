// The exact rotation of a rigid body on which no torque acts.
#pragma once

#include "engine/geometry/mass_properties.hpp"

namespace impinge {

/// The rotation Q with R(t + time) = R(t) Q of a body that turns freely with the angular momentum `momentum` (its own
/// axes, kg·m²/s), `time` in s, not negative. Euler's equations are solved in Jacobi's elliptic functions [Jacobi49,
/// VanZon07], so there is no error but rounding, whatever the inertia and however far the body turns: momentum and
/// energy keep all digits but those that the attitude can't hold (energy: about 1e-16 √(largest / smallest moment) a
/// step). Throws DivergenceError, without a place, where the turn is not finite or beyond 1e9 radians.
Mat3 free_rotation(const PrincipalInertia& inertia, const Vec3& momentum, double time);

}  // namespace impinge
