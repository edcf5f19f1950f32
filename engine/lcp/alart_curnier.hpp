// Contact and friction as equations of λ and u, one contact at a time [AlartCurnier91]:
//   λ_n = max(0, z_n),  λ_t = nearest point to z_t of the disc (or square) of size mu max(0, z_n),  z = λ - ρ u.
// They hold exactly where the cone problem does; their derivative exists but for kinks, where either side's is taken.
#pragma once

#include "engine/lcp/cone_problem.hpp"

namespace impinge {

struct AlartCurnier {
  Vec3 value;            ///< what is left of the equations, N·s
  Mat3 by_u, by_lambda;  ///< derivatives of `value`
  bool open;             ///< z_n <= 0: the value is λ itself
};

/// ρ of the normal row and of the tangential ones, kg: the inverse of W_ii's diagonal.
Vec2 alart_curnier_scale(const ConeProblem& problem, std::size_t i);

/// Of contact i with its u and λ. Rows that are equations ask for ρ u = 0.
AlartCurnier alart_curnier(const ConeProblem& problem, std::size_t i, const Vec3& u, const Vec3& lambda,
                           const Vec2& rho);

/// `value` alone.
Vec3 alart_curnier_value(const ConeProblem& problem, std::size_t i, const Vec3& u, const Vec3& lambda, const Vec2& rho);

}  // namespace impinge
