// W = Bᵀ A⁻¹ B from CHOLMOD's supernodal factor, by half solves.
#pragma once
#ifdef IMPINGE_CHOLMOD

#include <cholmod.h>

#include "engine/algebra/linear_solver.hpp"

namespace impinge {

/// l: supernodal L with L Lᵀ = P A Pᵀ. W comes out exactly symmetric.
void supernodal_gram(const cholmod_factor& l, const SparseColumns& b, MatX& w);

}  // namespace impinge
#endif
