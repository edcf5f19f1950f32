// A tetrahedral body's state: where its nodes are, how fast they move, which of them are held.
#pragma once

#include "engine/bodies/fem_assembly.hpp"

namespace impinge {

/// Rayleigh damping: the force −(alpha M + beta K) v.
struct RayleighDamping {
  double alpha = 0.0;  ///< 1/s
  double beta = 0.0;   ///< s
};

class DeformableBody {
 public:
  /// At rest in its rest shape, no node held.
  explicit DeformableBody(FemAssembly assembly);

  FemAssembly fem;
  RayleighDamping damping;
  std::string name;

  // node by node x, y, z
  VecX position;                    ///< m
  VecX velocity;                    ///< m/s; of a held node: what it is moved with
  VecX acceleration;                ///< m/s²; kept by integrators that need it (newmark)
  bool acceleration_known = false;  ///< false: such an integrator computes it from the forces first
  VecX external_force;              ///< N, beside gravity; zero unless someone sets it

  int nodes() const { return fem.nodes(); }
  int free_nodes() const { return static_cast<int>(free_node_.size()); }
  /// Unknowns: three a node that isn't held.
  int dofs() const { return 3 * free_nodes(); }

  /// Holds these nodes (and no others): their degrees of freedom leave the system. They keep their velocity's part zero
  /// until set_held_velocity. Throws InternalError on an index out of range.
  void hold(std::span<const int> nodes);
  const Vec3& rest_position(int node) const { return fem.rest().vertices[node]; }  ///< metres
  bool is_held(int node) const { return free_index_[node] < 0; }
  /// Velocity that a held node is moved with in the coming sub-steps, m/s.
  void set_held_velocity(int node, const Vec3& velocity);
  const VecX& held_velocity() const { return held_velocity_; }

  /// Index among the free nodes, or −1 for a held one.
  const std::vector<int>& free_index() const { return free_index_; }
  const std::vector<int>& free_node() const { return free_node_; }
  /// Pattern over the free nodes, and where each of its blocks comes from in fem.pattern().
  const std::shared_ptr<const BlockPattern>& free_pattern() const { return free_pattern_; }
  const std::vector<int>& free_source() const { return free_source_; }
  /// The parts of a vector over all nodes that belong to free ones, and back into `all` (held parts are left).
  VecX gather_free(const VecX& all) const;
  void scatter_free(const VecX& free, VecX& all) const;

  double kinetic_energy() const;                       ///< J
  double potential_energy(const Vec3& gravity) const;  ///< −Σ m g·x, J
  double elastic_energy() { return fem.energy(position); }
  Vec3 momentum() const;          ///< kg m/s
  Vec3 angular_momentum() const;  ///< about the origin, kg m²/s
  Vec3 center_of_mass() const;
  /// Smallest J = det F over the elements; <= 0 where one is inverted.
  double smallest_volume_ratio() const;

 private:
  std::vector<int> free_index_, free_node_, free_source_;
  std::shared_ptr<const BlockPattern> free_pattern_;
  VecX held_velocity_;
};

}  // namespace impinge
