// W = Bᵀ A⁻¹ B from a supernodal factor, by half solves.
#pragma once

#include "engine/algebra/linear_solver.hpp"
#include "engine/algebra/supernodal_factor.hpp"

namespace impinge {

/// W comes out exactly symmetric.
void supernodal_gram(const SupernodalFactor& l, const SparseColumns& b, MatX& w);

}  // namespace impinge
