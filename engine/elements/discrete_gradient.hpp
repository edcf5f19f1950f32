// A force for a step from one place to another that does the work by which the energy falls, and makes no torque.
//
// In F the force at the middle does that to third order. What is left is made up along the change of C = FᵀF: with the
// mean C̄ = (C₀ + C₁)/2, S = 2 ∂Ψ/∂C(C̄) and ΔC = C₁ − C₀ the stress
//   P = (F₀ + F₁)/2 · (S + c ΔC),   c = 2 (Ψ₁ − Ψ₀ − S : ΔC/2)/|ΔC|²
// has P : (F₁ − F₀) = Ψ₁ − Ψ₀, and P (F₀ + F₁)ᵀ is symmetric [Gonzalez00, SimoTarnow92]. A turn alone changes no C, so it
// is no strain, however far it goes. C does not know what is inverted; there the same is done in F, which keeps energy.
#pragma once

#include "engine/materials/material.hpp"

namespace impinge {

/// Energy at x1 and that force; the stiffness of `out` is left as it was.
void discrete_gradient(const Material& material, const TetRest& rest, const Corners& x0, const Corners& x1,
                       ElementResponse& out);

}  // namespace impinge
