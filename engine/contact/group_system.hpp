// One collision group as a system of equations: A by body, J by contact, the free velocity v* and the rows' bounds.
#pragma once

#include <memory>

#include "engine/bodies/material_point.hpp"
#include "engine/bodies/system_block.hpp"
#include "engine/contact/contact_scale.hpp"
#include "engine/contact/row_kind.hpp"

namespace impinge {

/// One body of a contact: a rigid body by its lever arm, a deformable one by the nodes that carry the point, or
/// neither: a body without freedom, whose motion is in ContactRows::surface.
struct ContactSide {
  int rigid = -1;                 ///< index into GroupSystem::rigid
  int deformable = -1;            ///< index into GroupSystem::deformable
  Vec3 arm = Vec3::Zero();        ///< rigid: from the centre of mass to the common point
  std::vector<NodeWeight> nodes;  ///< deformable; held nodes are left out
  Vec3 driven = Vec3::Zero();     ///< what prescribed motion is of the point's velocity, m/s
};

/// Rows (n, t1, t2) of J for one contact. Two rigid bodies act at one common point, or impulses would not keep angular
/// momentum. A row is [ d^T (r_A x d)^T -d^T -(r_B x d)^T ] for each direction d [Haapaoja16 Eq. 4.11]; for a
/// deformable body it is w_j d^T at each node j.
struct ContactRows {
  RowKind kind = RowKind::contact;
  ContactSide a, b;
  Mat3 directions = Mat3::Zero();  ///< rows n^T, t1^T, t2^T
  /// what prescribed motion (bodies without freedom, held nodes) adds to J v, along the rows
  Vec3 surface = Vec3::Zero();
  double gap = 0.0;              ///< g0, metres
  double bound = 0.0;            ///< J v >= bound along n, m/s
  double turning = 0.0;          ///< <= 0: how much less than J v says the gap grows, because bodies turn, metres
  Vec3 rolling = Vec3::Zero();   ///< part of surface: what J v leaves out because the place that rolls there moves on
  double friction = 0.0;         ///< 0: a contact without tangential rows
  double restitution = 0.0;      ///< e of the pair; where this is an impact the bound holds its bounce already
  double velocity_before = 0.0;  ///< J v along n before the sub-step, m/s: what a bounce is a part of
  /// How late in the sub-step an impact is that gives something back, s; 0: with velocities of the end nobody asks.
  double impact = 0.0;
  ContactScale scale;  ///< of the two bodies
  bool has_one_row() const { return kind == RowKind::sliding || (kind == RowKind::contact && friction == 0.0); }
};

struct GroupSystem {
  std::vector<RigidBlock> rigid;
  std::vector<DeformableBlock> deformable;
  std::vector<ContactRows> contacts;
  std::vector<Vec3> lambda;                                  ///< in: where to start; out: impulses (n, t1, t2), N·s
  std::vector<Vec3> delta_velocity, delta_angular_velocity;  ///< out: Δv = A⁻¹ J^T λ by rigid body
  std::vector<VecX> deformable_delta;                        ///< out: the same by deformable body, over its free nodes
  /// Out, or empty: velocities beside v* + Δv by which positions move in this sub-step and no later one, by rigid body,
  /// in groups without deformable ones: of responses that tell recovery from overlap and motion apart.
  std::vector<Vec3> position_velocity, position_angular_velocity;
  /// What the same contacts are to start from next time, as λ, where the response has something better; empty: from λ.
  std::vector<Vec3> next_start;
  /// W = J A⁻¹ J^T, 1/kg, once a response has assembled it. Copies share it; whoever changes A, directions, arms or
  /// nodes resets it. Velocities, bounds, kinds and friction are free to change; the solvers keep their factorizations
  /// with it.
  std::shared_ptr<const MatX> assembled;
  /// The same of A⁻¹ between the nodes that contacts touch, by deformable body.
  std::shared_ptr<const std::vector<MatX>> between_nodes;

  /// J v of contact i for the bodies' velocities, with or without the Δv.
  Vec3 contact_velocity(std::size_t i, bool with_delta) const;
  /// J Δq(v)/Δt of contact i with the Δv: how fast the gap changes over the sub-step.
  Vec3 displacement_velocity(std::size_t i) const;
  /// The same of the point of one deformable side, world axes.
  Vec3 displacement_velocity(const ContactSide& side) const;
  /// J^T λ on the free nodes of one deformable body, kg·m/s.
  VecX deformable_impulse(int body, const std::vector<Vec3>& impulses) const;
  /// Zero Δv of the right sizes.
  void clear_delta();
  /// The same bodies without some contacts (`out`, by contact: 1), and with no answer yet.
  GroupSystem without(const std::vector<char>& out) const;
};

}  // namespace impinge
