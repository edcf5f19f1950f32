// Alart and Curnier's equations with their kinks rounded off over a width: max(0, z_n) becomes
// s(z_n) = (z_n + √(z_n² + 4 w²)) / 2, so λ_n ρ u_n = w² [ChenHarker93], and the nearest point of the disc
// z_t b / s'(b, |z_t|) with s' a rounded maximum and b = mu s(z_n). They have derivatives everywhere, and none of their
// contacts is ever quite open, closed, stuck or sliding.
#pragma once

#include "engine/lcp/alart_curnier.hpp"

namespace impinge {

/// Of contact i with its u and λ; `width` > 0 in m/s, of which ρ makes an impulse. Equations are as they were.
AlartCurnier smoothed_alart_curnier(const ConeProblem& problem, std::size_t i, const Vec3& u, const Vec3& lambda,
                                    const Vec2& rho, double width);

/// `value` alone.
Vec3 smoothed_alart_curnier_value(const ConeProblem& problem, std::size_t i, const Vec3& u, const Vec3& lambda,
                                  const Vec2& rho, double width);

}  // namespace impinge
