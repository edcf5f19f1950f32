// The linear systems of Newton's methods here: (A W + B) x = b with A and B block diagonal by contact. There are two
// ways: over the rows in contact, or, where all bodies are rigid, over the bodies' velocities.
#pragma once

#include <memory>
#include <span>

#include "engine/lcp/cone_problem.hpp"

namespace impinge {

class NewtonSystem {
 public:
  virtual ~NewtonSystem() = default;
  /// Takes the numbers; kept[i] says that contact i has rows of its own, otherwise A_i = 0 and B_i = 1.
  virtual void factorize(std::span<const Mat3> a, std::span<const Mat3> b, const std::vector<char>& kept) = 0;
  /// x = (A W + B)⁻¹ b; not finite where the matrix is singular.
  virtual void solve(const VecX& b, VecX& x) const = 0;
};

/// W is written out: 3 rows a contact, of which those that a method knows already are taken out before the LU, dense or,
/// where W is large and mostly zero, sparse. Changes the operator's present λ.
std::unique_ptr<NewtonSystem> newton_system_of_rows(const ConeProblem& problem);

/// x = B⁻¹ (b - A J s) with (M + Jᵀ B⁻¹ A J) s = Jᵀ B⁻¹ b: 6 rows a body. B must be regular where kept.
std::unique_ptr<NewtonSystem> newton_system_of_bodies(const BodySpace& bodies);

}  // namespace impinge
