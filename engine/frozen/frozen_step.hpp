// One sub-step stopped before its response: the system of every group, where its contacts are, what the run was set to,
// and what it made of it. Plain data that owns all it refers to.
#pragma once

#include "engine/core/index.hpp"
#include "engine/response/response.hpp"

namespace impinge {

/// Where a contact (or attachment) is. World coordinates at the instant of detection.
struct FrozenContact {
  BodyIndex body_a, body_b;              ///< scene order; none: the world (attachments)
  TriangleIndex triangle_a, triangle_b;  ///< none: an exact shape, or an attachment
  Vec3 point_a = Vec3::Zero(), point_b = Vec3::Zero();
  std::uint64_t feature = 0;  ///< what the contact is remembered by from step to step
};

/// λ and Δv of a group, as a response leaves them in a GroupSystem.
struct GroupAnswer {
  std::vector<Vec3> lambda, delta_velocity, delta_angular_velocity;
  std::vector<VecX> deformable_delta;
};

bool is_finite(const GroupAnswer& answer);

struct FrozenGroup {
  /// λ: where the run started; the soft blocks' `a` and `solver` are null (see thaw)
  GroupSystem system;
  std::vector<BlockMatrix> matrices;                       ///< A by deformable body
  std::vector<BodyIndex> rigid_bodies, deformable_bodies;  ///< in the system's order
  std::vector<FrozenContact> geometry;  ///< by contact of the system; its normal is the system's first direction
  GroupAnswer answer;                   ///< the run's
};

struct FrozenStep {
  std::string scene;                   ///< name of its file
  int frame = 0;                       ///< its last sub-step
  double time = 0.0, time_step = 0.0;  ///< s, at the sub-step's start; Δt
  Vec3 gravity = Vec3::Zero();         ///< m/s²
  std::vector<RowText> settings;       ///< every parameter of the model by path, those of methods too
  LinearSolverChoice linear_solver;    ///< of A, as the settings have it
  std::vector<std::string> bodies;     ///< names, scene order
  std::vector<FrozenGroup> groups;

  std::size_t contacts() const;
  /// The value of a setting as text, "" for a path that isn't there.
  std::string_view setting(std::string_view path) const;
  /// Whether A is block diagonal in every deformable body.
  bool is_block_diagonal() const;
};

/// A group ready to be solved: the system refers to the frozen matrices, which must outlive it, and to solvers of its
/// own, whose factorizations are not made yet.
struct ThawedGroup {
  GroupSystem system;
  std::vector<std::unique_ptr<LinearSolver>> solvers;
};

/// Copies the system, matrices included.
FrozenGroup freeze(const GroupSystem& system);
ThawedGroup thaw(const FrozenGroup& group, const LinearSolverChoice& linear_solver);

/// x^T A y over all bodies of the group, J: twice the kinetic (and, by the integrator, elastic) energy of a change of
/// velocity.
double energy_product(const FrozenGroup& group, const GroupAnswer& x, const GroupAnswer& y);
/// ‖Δv_x - Δv_y‖_A.
double energy_distance(const FrozenGroup& group, const GroupAnswer& x, const GroupAnswer& y);

}  // namespace impinge
