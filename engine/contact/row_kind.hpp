// What the rows of a contact ask for: the complementarity of a real contact, or an equation.
#pragma once

#include <cstdint>

namespace impinge {

enum class RowKind : std::uint8_t {
  contact,     ///< Signorini's condition and Coulomb's law: K_mu ∋ λ ⊥ u_hat ∈ K_mu*
  attachment,  ///< u = 0, λ free: two points that stay together
  sliding      ///< u_n = 0, λ_n free, no tangential rows: a point that stays on a plane or surface
};

}  // namespace impinge
