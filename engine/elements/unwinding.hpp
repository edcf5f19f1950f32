// Lets a tangled mesh come undone.
//
// Where a mesh is wound round itself (geometry/tet_winding.hpp) an energy that resists inversion holds the tangle
// together: no motion unwinds it but through inverted elements. So while an inner edge is wound wrongly, or an element
// inverted, the elements round it answer as Ψ = μ ‖F − R‖² with one rotation R for all that hang together, instead of
// as their own material. That is convex, so it has no tangled minimum; and as R is the rotation nearest to their mean
// F, it makes no torque. It differs from co-rotational elasticity in that R is shared: with a rotation for each element
// tangles do have minima (1 in 15 cubes of 2³ cells thrown about, 1 in 100 of 3³).
//
// What is unwound depends on the positions at the start of a step only, so a run that is resumed does the same.
#pragma once

#include "engine/geometry/tets/tet_winding.hpp"
#include "engine/materials/material.hpp"

namespace impinge {

class Unwinding {
 public:
  /// Looks at x (node by node x, y, z). `may`: for each element, whether it is to be let go; `elements` those of
  /// `rest`, of which `parts` in a row are let go together. Returns how many are let go until the next call.
  int find(const TetMesh& rest, const std::vector<TetRest>& elements, const std::vector<char>& may, const VecX& x,
           int parts = 1);
  void clear() { patch_.clear(); }

  bool lets_go(std::size_t element) const { return !patch_.empty() && patch_[element] >= 0; }

  // an element that is let go: energy, J; energy and force; these and stiffness. mu: Pa
  double energy(const TetRest& rest, const Corners& x, std::size_t element, double mu) const;
  void force(const TetRest& rest, const Corners& x, std::size_t element, double mu, ElementResponse& out) const;
  void response(const TetRest& rest, const Corners& x, std::size_t element, double mu, ElementResponse& out) const;

 private:
  std::vector<char> tangled_nodes(const TetMesh& rest, const std::vector<TetRest>& elements, const VecX& x);

  TetWinding winding_;       // made on first use
  std::vector<int> patch_;   // of each element, or −1; empty if none is let go
  std::vector<Mat3> frame_;  // R of each patch
};

}  // namespace impinge
