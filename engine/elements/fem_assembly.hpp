// A tetrahedral body's energy, forces, stiffness and mass, summed over its elements into a pattern that is made once.
// Elements are the tetrahedra of its mesh, or quadratic ones that are eight of these each (bodies/quadratic_elements).
//
// Elements are evaluated in parallel, each into its own slot; nodes and blocks then add up what concerns them in order
// of elements. So the sums don't depend on the number of threads. (Colouring needs no slots but at least 24 passes, the
// number of tetrahedra round a node, each with poor locality.)
#pragma once

#include <memory>

#include "engine/elements/element_kind.hpp"
#include "engine/elements/element_sums.hpp"
#include "engine/elements/unwinding.hpp"
#include "engine/geometry/tets/tet_mesh.hpp"
#include "engine/materials/material.hpp"

namespace impinge {

class QuadraticElements;
struct ElementPoint;

enum class MassKind { lumped, consistent };

/// What some of a body's tetrahedra are made of.
struct FemMaterial {
  std::shared_ptr<const Material> elastic;
  double density = 1000.0;  ///< kg/m³
};

class FemAssembly {
 public:
  /// rest: checked by check_tet_mesh. element_material: index into `materials` of each tetrahedron, or empty for all 0.
  /// fraction: how much of each tetrahedron is filled, in (0, 1], or empty for all 1; it weighs mass and stiffness.
  /// Quadratic elements: `rest` is a mesh that was cut (geometry/quadratic_tets), the eight parts of each are alike.
  FemAssembly(TetMesh rest, std::vector<FemMaterial> materials, MassKind mass, std::vector<int> element_material = {},
              std::vector<double> fraction = {}, ElementKind kind = ElementKind::linear);

  ElementKind element_kind() const { return quadratic_ ? ElementKind::quadratic : ElementKind::linear; }
  const TetMesh& rest() const { return rest_; }
  int nodes() const { return static_cast<int>(rest_.vertices.size()); }
  /// The tetrahedra of rest().
  const std::vector<TetRest>& elements() const { return elements_; }
  const Material& material(int element) const { return *materials_[element_material_[element]].elastic; }
  const std::shared_ptr<const BlockPattern>& pattern() const { return pattern_; }
  /// Where the stress of tetrahedron `tet` of rest() comes from: the sum over these points of the material's answers.
  std::vector<ElementPoint> stress_points(int tet, const VecX& x) const;
  /// Exchanges a material between steps; its index is that of the constructor's list. Mass follows the density.
  void set_material(int index, FemMaterial material);

  /// Looks at x for tangles and lets the elements round them go, those whose material unwinds() (bodies/unwinding.hpp).
  /// That stays so until the next call; integrators call it when they open a step. Returns how many elements it are.
  int release_tangles(const VecX& x);

  // positions x, forces f: node by node x, y, z; metres, newtons
  /// Elastic energy, J.
  double energy(const VecX& x);
  /// Elastic force f = −∂energy/∂x; returns the energy.
  double forces(const VecX& x, VecX& f);
  /// The force of a step from x0 to x1 that does the work by which the energy falls (discrete_gradient.hpp); returns the
  /// energy at x1.
  double mean_forces(const VecX& x0, const VecX& x1, VecX& f);
  /// The same as forces(), and the stiffness −∂f/∂x (or the stand-in that `tangent` names) into k, whose pattern is pattern().
  double stiffness(const VecX& x, Tangent tangent, VecX& f, BlockMatrix& k);

  /// By what strain rates are damped at x, into k: the stiffness that stiffness() has found there just before, which x is
  /// handed again, without the motions of elements as rigid ones (rigid_motions.hpp). Materials that take a turn for
  /// a strain take it for one here, too.
  void damping_stiffness(const VecX& x, BlockMatrix& k);

  /// Mass of each node, kg: row sums of the mass matrix, what gravity acts on. Linear elements: a quarter of each
  /// tetrahedron round it, whichever the matrix. Consistent quadratic ones: below zero at corners.
  const std::vector<double>& node_mass() const { return node_mass_; }
  /// The chosen mass matrix: one number a block of the pattern, kg (the block is that times the identity).
  const std::vector<double>& block_mass() const { return block_mass_; }
  MassKind mass_kind() const { return mass_kind_; }
  double total_mass() const;
  /// y = M x.
  void multiply_mass(const VecX& x, VecX& y) const;

 private:
  void make_mass();
  Corners corners(const VecX& x, int element) const;
  void gather_forces(VecX& f) const;
  void make_linear_mass();
  void make_quadratic_mass();
  double total_energy() const;

  TetMesh rest_;
  std::vector<FemMaterial> materials_;
  std::vector<int> element_material_;
  std::vector<TetRest> elements_;
  MassKind mass_kind_;
  std::shared_ptr<const BlockPattern> pattern_;
  std::vector<double> node_mass_, block_mass_;

  // one of the two
  ElementSums<4> sums_;
  std::vector<ElementResponse> slot_;
  std::shared_ptr<const QuadraticElements> quadratic_;
  ElementSums<10> quadratic_sums_;
  std::vector<ElementAnswer<10>> quadratic_slot_;
  Unwinding unwinding_;
};

}  // namespace impinge
