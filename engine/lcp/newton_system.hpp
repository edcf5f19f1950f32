// The linear systems of Newton's methods here: (A W + B) x = b with A and B block diagonal by contact. There are
// three ways: over the rows in contact, where all bodies are rigid over the bodies' velocities, and over these and those
// of touched nodes.
#pragma once

#include <memory>
#include <span>

#include "engine/lcp/body_space.hpp"
#include "engine/lcp/cone_problem.hpp"
#include "engine/lcp/node_space.hpp"

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

/// Over velocities (system_of_velocities.hpp): 6 rows a body.
std::unique_ptr<NewtonSystem> newton_system_of_bodies(const BodySpace& bodies);

/// And 3 a touched node. Takes over a dense matrix of those.
std::unique_ptr<NewtonSystem> newton_system_of_nodes(const NodeSpace& space);

/// That of the problem's factors, of its rows where it has none.
std::unique_ptr<NewtonSystem> newton_system(const ConeProblem& problem);

}  // namespace impinge
