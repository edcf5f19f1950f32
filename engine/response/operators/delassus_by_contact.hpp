// The Delassus operator W = J A⁻¹ J^T asked for contact by contact, for responses that go from contact to contact. Rigid bodies and lumped nodes keep their Δv up to date; a deformable body whose A couples nodes is seen
// through its part of W, which one factorization gives.
#pragma once

#include <functional>
#include <span>

#include "engine/contact/group_system.hpp"

namespace impinge {

class DelassusByContact {
 public:
  /// Throws DivergenceError where A is not positive definite. Starts from group.lambda (entries of rows that aren't
  /// there must be 0).
  explicit DelassusByContact(GroupSystem& group);

  /// W_ii, 1/kg. Zero where both sides are held.
  const Mat3& diagonal(std::size_t i) const { return diagonal_[i]; }
  /// W_ij, 1/kg.
  Mat3 between(std::size_t i, std::size_t j) const;
  /// D_i with blockdiag(D) ⪰ W: what contact i answers with when all contacts act at once. A rigid body counts once for
  /// each of its contacts, which shares its mass among them [Tonge12]; a coupled body by the row sums of its part of W.
  const Mat3& split_diagonal(std::size_t i) const { return split_[i]; }
  /// J (v* + Δv) of contact i, m/s.
  Vec3 velocity(std::size_t i) const;
  /// λ_i += delta, and what follows from it.
  void change(std::size_t i, const Vec3& delta);
  /// The largest natural map of the rows with these bounds, m/s: what the judge will find. Not of rows that an impact
  /// gave an impulse of its own to, N s.
  double natural_residual(std::span<const double> bound, std::span<const double> impact = {}) const;
  /// Δv = A⁻¹ J^T λ of all bodies, afresh from group.lambda. False if a system couldn't be solved.
  bool finish();
  /// finish(), a look at the group, and on. Nothing without an observer.
  void show(const std::function<void(const GroupSystem&)>& observe);

 private:
  struct Coupled {
    std::vector<std::size_t> contacts;  // those that the body is part of
    MatX w;                             // 3 contacts x 3 contacts
  };
  void add_impulse(std::size_t i, const Vec3& delta);
  void add_coupled(int body);

  GroupSystem& group_;
  bool solved_ = true;
  std::vector<std::vector<Mat3>> node_inverse_;  // of lumped bodies; empty for coupled ones
  std::vector<Coupled> coupled_;                 // by deformable body
  std::vector<std::array<int, 2>> place_;        // of a contact in coupled_ of its sides' bodies, or -1
  std::vector<Vec3> coupled_velocity_;           // what coupled bodies add to J Δv
  std::vector<Mat3> diagonal_, split_;
};

/// One contact's answer to u = J v - bound at its present λ: the normal impulse is accumulated and clamped [Catto05],
/// then the tangential one relaxed by the largest eigenvalue of its block and put back into the disc |λ_t| <= mu λ_n.
/// Where this changes nothing, Coulomb's law holds exactly: the cone, not a pyramid. `mobility` is W_ii or an upper
/// bound of it.
Vec3 relaxed_impulse(const ContactRows& rows, const Mat3& mobility, Vec3 u, Vec3 lambda);

/// The tangential half of it, for responses with a normal law of their own. u: after the normal impulse.
void relax_friction(const Mat3& mobility, const Vec3& u, double friction, Vec3& lambda);

}  // namespace impinge
