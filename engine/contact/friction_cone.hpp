// The Coulomb cone K_mu = { (n, t) : |t| <= mu n } and what one contact can solve exactly.
#pragma once

#include <cmath>

#include "engine/core/types.hpp"

namespace impinge {

/// Nearest point of K_mu to z = (n, t1, t2). mu = 0: the ray t = 0, n >= 0.
Vec3 project_to_cone(const Vec3& z, double mu);

/// Nearest point of the dual cone K_mu* = { (n, t) : n >= mu |t| } to z.
Vec3 project_to_dual_cone(const Vec3& z, double mu);

/// u_hat = u + mu |u_T| n: with it Coulomb's law is the complementarity K_mu ∋ λ ⊥ u_hat ∈ K_mu* [deSaxce98].
inline Vec3 de_saxce(const Vec3& u, double mu) { return {u.x() + mu * std::hypot(u.y(), u.z()), u.y(), u.z()}; }

/// Solves one contact exactly: λ with u = W λ + b, K_mu ∋ λ ⊥ u_hat ∈ K_mu*, W symmetric positive definite 3 x 3.
/// Take-off (λ = 0), stick (u = 0) or slip (u_n = 0, λ_t = -mu λ_n u_t/|u_t|, by a safeguarded one-dimensional search).
Vec3 solve_one_contact(const Mat3& w, const Vec3& b, double mu);

}  // namespace impinge
