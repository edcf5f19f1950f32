// Tetrahedra of ten nodes and quadratic shape functions whose dilatation is taken at their centre.
//
// Linear tetrahedra lock twice: they can't bend (a constant strain each), and towards ν = 1/2 there are more elements
// that must keep their volume than nodes to do it with. Quadratic ones bend; and taking λ at one point, the centre, not
// at the four of μ, leaves one volume an element to keep (constant pressure: P2/P0 in mixed form [Hughes00 §4.4]).
// Compared on a cantilever before this was written (tests/README.md): averaged nodal pressures, face-, edge- and
// node-based smoothing, edges for shear with nodes for volume. At ν = 0.499 and 20 cells the best is 5 % off, with a
// pattern as wide, and too soft where the others are too stiff.
//
// A body of such elements is the mesh of their parts (geometry/quadratic_tets): its surface, contacts and attachments
// are carried by these, with linear weights, so a row of J has the nodes of one small tetrahedron. Only energy, force,
// stiffness and mass are the ten nodes'.
//
// At a point with weights w the gradient is F = Σ_k y_k g_kᵀ with the gradients g_k of the four corners and y = x B(w):
// a linear tetrahedron whose corners are sums of the ten nodes. So every material works as it is; forces and stiffness
// go back by B.
#pragma once

#include "engine/elements/element_sums.hpp"
#include "engine/elements/unwinding.hpp"
#include "engine/geometry/tets/quadratic_tets.hpp"

namespace impinge {

using QuadraticAnswer = ElementAnswer<10>;

/// A point of an element as materials take it.
struct ElementPoint {
  TetRest rest;  ///< volume: what the point stands for
  Corners x;
};

class QuadraticElements {
 public:
  /// cut: see cut_at_midpoints. fraction: how much of each of its parts is filled, the same of all eight of an element.
  QuadraticElements(const TetMesh& cut, std::span<const double> fraction);

  int count() const { return static_cast<int>(nodes_.size()); }
  const QuadraticTet& nodes(int element) const { return nodes_[element]; }
  std::span<const QuadraticTet> all_nodes() const { return nodes_; }
  double volume(int element) const { return rest_[element].volume; }  ///< m³, filled
  BlockPattern pattern(int nodes) const;

  /// Mass of the pair of nodes a, b in ρ V: consistent, or 0 beside the diagonal and on it the consistent one's
  /// diagonal in proportion (row sums would give corners a negative mass) [Hinton76].
  static double mass(int a, int b, bool lumped);

  // x: over the nodes of the body. An element that `unwinding` lets go (it counts parts) answers as that says, with the
  // modulus mu, Pa
  double energy(int element, const Material& material, const VecX& x, const Unwinding& unwinding, double mu) const;
  void force(int element, const Material& material, const VecX& x, const Unwinding& unwinding, double mu,
             QuadraticAnswer& out) const;
  void mean_force(int element, const Material& material, const VecX& x0, const VecX& x1, const Unwinding& unwinding,
                  double mu, QuadraticAnswer& out) const;
  void response(int element, const Material& material, const VecX& x, Tangent tangent, const Unwinding& unwinding,
                double mu, QuadraticAnswer& out) const;

  /// What carries the stress in part `part` of the cut mesh: shear at the middle of the part, dilatation at that of its
  /// element.
  std::array<ElementPoint, 2> stress_points(const TetMesh& cut, int part, const VecX& x) const;

 private:
  std::vector<QuadraticTet> nodes_;
  std::vector<TetRest> rest_;  // of the whole element by its corners
};

}  // namespace impinge
