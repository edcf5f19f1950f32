// The friction cone K_mu and what one contact can solve exactly. Coulomb's cone is { (n, t) : |t| <= mu n }. The
// pyramid { |t1| <= mu n, |t2| <= mu n } is what linear complementarity can express: a law of its own, stronger by up
// to √2 across the corners. Both obey the same complementarity, K ∋ λ ⊥ u_hat ∈ K*, so what is written with the
// projection and the shift below serves either.
#pragma once

#include <cmath>

#include "engine/core/types.hpp"

namespace impinge {

enum class FrictionLaw { cone, pyramid };

/// Nearest point of K_mu to z = (n, t1, t2). mu = 0: the ray t = 0, n >= 0.
Vec3 project_to_cone(const Vec3& z, double mu);

/// Nearest point of the pyramid to z.
Vec3 project_to_pyramid(const Vec3& z, double mu);

inline Vec3 project(const Vec3& z, double mu, FrictionLaw law) {
  return law == FrictionLaw::cone ? project_to_cone(z, mu) : project_to_pyramid(z, mu);
}

/// Nearest point of the dual cone K_mu* = { (n, t) : n >= mu |t| } to z.
Vec3 project_to_dual_cone(const Vec3& z, double mu);

/// u_hat = u + mu |u_T| n: with it Coulomb's law is the complementarity K_mu ∋ λ ⊥ u_hat ∈ K_mu* [DeSaxce98].
inline Vec3 de_saxce(const Vec3& u, double mu) { return {u.x() + mu * std::hypot(u.y(), u.z()), u.y(), u.z()}; }

/// The same for either law: the shift is mu times what a unit normal impulse dissipates, |u_T| or |u_1| + |u_2|.
inline Vec3 de_saxce(const Vec3& u, double mu, FrictionLaw law) {
  return law == FrictionLaw::cone ? de_saxce(u, mu)
                                  : Vec3(u.x() + mu * (std::abs(u.y()) + std::abs(u.z())), u.y(), u.z());
}

/// How far λ lies outside its cone, as a tangential impulse: max(0, |λ_t| - mu λ_n) (the pyramid: of the larger side).
double cone_violation(const Vec3& lambda, double mu, FrictionLaw law);

/// Solves one contact exactly: λ with u = W λ + b, K_mu ∋ λ ⊥ u_hat ∈ K_mu*, W symmetric positive definite 3 x 3.
/// Take-off (λ = 0), stick (u = 0) or slip (u_n = 0, λ_t = -mu λ_n u_t/|u_t|, by a safeguarded one-dimensional search).
Vec3 solve_one_contact(const Mat3& w, const Vec3& b, double mu);

}  // namespace impinge
