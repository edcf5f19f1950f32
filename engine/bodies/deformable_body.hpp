// A deformable body: tetrahedra whose nodes move, some of them held, and the surface embedded in them that collides and
// is drawn. Its state, its geometry and its sub-step; the elements' sums are FemAssembly's, the schemes integrators/'s.
#pragma once

#include "engine/bodies/body.hpp"
#include "engine/bodies/deformable_step.hpp"
#include "engine/bodies/held_region.hpp"
#include "engine/elements/fem_assembly.hpp"
#include "engine/geometry/tets/embedding.hpp"

namespace impinge {

/// Rayleigh damping: the force −(alpha M + beta K) v.
struct RayleighDamping {
  double alpha = 0.0;  ///< 1/s
  double beta = 0.0;   ///< s
};

class DeformableBody final : public Body {
 public:
  /// At rest in its rest shape, no node held; with no surface, nothing can touch it.
  explicit DeformableBody(FemAssembly assembly);

  FemAssembly fem;
  std::shared_ptr<Material> material;  ///< the one that fem's elements refer to, if its rows may change
  std::string model;                   ///< the material's name
  RayleighDamping damping;
  Embedding embedding;  ///< of the surface's vertices
  Pose placed;          ///< where its file's axes were put at the start

  // state, node by node x, y, z
  VecX position;                    ///< m
  VecX velocity;                    ///< m/s; of a held node: what it is moved with
  VecX acceleration;                ///< m/s²; kept by integrators that need it (newmark)
  bool acceleration_known = false;  ///< false: such an integrator computes it from the forces first
  VecX external_force;              ///< N, beside gravity; zero unless someone sets it

  int nodes() const { return fem.nodes(); }
  int free_nodes() const { return static_cast<int>(free_node_.size()); }
  /// Unknowns: three a node that isn't held.
  int dofs() const override { return 3 * free_nodes(); }
  /// Smallest J = det F over the elements; <= 0 where one is inverted.
  double smallest_volume_ratio() const;

  // held nodes
  std::vector<HeldRegion> held;
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
  /// `free` with the prescribed velocities of held nodes, over all nodes.
  VecX with_held(const VecX& free) const;

  // energy and momentum
  double kinetic_energy() const;                       ///< J
  double potential_energy(const Vec3& gravity) const;  ///< −Σ m g·x, J
  double elastic_energy() { return fem.energy(position); }
  Vec3 momentum() const;          ///< kg m/s
  Vec3 angular_momentum() const;  ///< about the origin, kg m²/s
  Balance balance(const Vec3& gravity) override;

  // as a body
  BodyKind kind() const override { return BodyKind::deformable; }
  bool has_freedom() const override { return !deleted; }
  bool is_moving() const override { return !asleep && !deleted; }
  bool can_touch_itself() const override { return self_collision && !deleted; }
  Twist twist() const override { return {center_velocity_, Vec3::Zero()}; }
  std::span<const Vec3> vertex_velocities() const override { return surface_velocity_; }
  double fastest_point() const override;
  Vec3 center_of_mass() const override;
  Pose file_pose() const override { return {pose.rotation, center_of_mass()}; }
  void update_world_vertices() override;
  /// Of the surface, which is moved as a whole by `velocity` until the first sub-step says more.
  void set_center_velocity(const Vec3& velocity);

  // a sub-step
  const VecX& lead() const { return lead_; }  ///< over all nodes, as RigidBody::stagger says; empty: none
  const DeformableStep& open_step() const { return step_; }  ///< until the next find_free_velocity
  void drive(double time, double h, double share) override;
  void open_sub_step() override;
  void find_free_velocity(const TimeIntegration& how) override;
  SystemBlock system_block() const override;
  CarriedPoint carry(const MaterialPoint& point, const Vec3& at) const override;
  double relinearize(const DeformableIntegrator& integrator, const VecX& change, const VecX& impulse) override;
  void solve_again() override;
  /// Moves all nodes of v alike, so that the sum of A v over them is that of b; v and b over the free nodes. `mass_factor`:
  /// what A counts its mass by; whatever else A holds knows no such motion. How it moves as a whole needs no solve where
  /// nothing holds it, and what an iteration leaves of that balance would be momentum lost.
  void keep_momentum(double mass_factor, const VecX& b, VecX& v) const;
  void surface_at_end(const BodyVector* change, std::vector<Vec3>& vertices) const override;
  void change_velocity(const BodyVector& change, bool is_blow) override;
  void advance(const TimeIntegration& how, double end) override;
  void displace(const BodyVector& by) override;
  void stay(ByteReader& start) override;
  void check_finite() const override;
  void come_to_rest() override;
  void catch_up() override { lag = 0.0, lead_.resize(0); }

  // points
  MaterialPoint surface_point(TriangleIndex triangle, const Vec3& world) const override;
  MaterialPoint inner_point(const Vec3& world) const override;
  Vec3 position_of(const MaterialPoint& point) const override;
  Vec3 material_normal(const MaterialPoint& point, const Vec3& world) const override;
  Vec3 world_normal(const MaterialPoint& point, const Vec3& material) const override;
  MaterialPoint point_beside(const MaterialPoint& point, const Vec3& world) const override;

  /// The point of its tetrahedra that is nearest.
  MaterialPoint nearest_point(const Vec3& world) const;
  MaterialPoint own_point(const Vec3& own) const override;
  Vec3 own_coordinates(const Vec3& world) const override;
  /// Nodes and weights of a point within a tetrahedron.
  std::array<NodeWeight, 4> nodes_of(const MaterialPoint& point) const;

  void push(const Vec3& impulse, const std::optional<Vec3>& at) override;
  /// The nodes keep their velocities, so it can't be turned.
  void shift(const Vec3& by, const Mat3& turn) override;

  void save(ByteWriter& out) const override;
  void restore(ByteReader& in) override;

 private:
  /// Solvers of A, analyzed with free_pattern(). A copy of the body makes its own.
  struct Solvers {
    Solvers() = default;
    Solvers(const Solvers&) {}
    Solvers(Solvers&&) = default;
    std::optional<LinearSolverChoice> made_with;
    std::shared_ptr<const BlockPattern> pattern;
    std::unique_ptr<LinearSolver> iterative;  ///< for the one right-hand side of v*
    std::unique_ptr<LinearSolver> direct;     ///< for the many of contact
  };

  void choose_solvers(const LinearSolverChoice& wanted);
  void check_solved() const;
  void find_displacement_velocity();
  void lead_on(const Vec3& changed);
  static MaterialPoint nearest_point(const Vec3& x, const TetMesh& mesh);
  std::vector<NodeWeight> carrying_nodes(const MaterialPoint& point) const;
  Mat3 edges_of(int tet) const;

  std::vector<int> free_index_, free_node_, free_source_;
  std::shared_ptr<const BlockPattern> free_pattern_;
  VecX held_velocity_;
  Vec3 center_velocity_ = Vec3::Zero();  ///< m/s, at the end of the last sub-step

  VecX lead_;  ///< of `velocity`, m/s, where it lags (stagger.hpp); empty: none

  // the open sub-step
  DeformableStep step_;
  Solvers solvers_;
  bool is_explicit_ = false;            ///< its scheme's A is M
  bool touched_ = false;                ///< contact or attachments gave it an impulse
  VecX velocity_before_;                ///< over all nodes, m/s
  VecX displacement_velocity_;          ///< (s v* + d)/Δt over all nodes, m/s: what contact and detection see
  std::vector<Vec3> surface_velocity_;  ///< the same of the surface's vertices
};

}  // namespace impinge
