// The complementarity problem as data: all that a solver in this folder sees.
//   u = W λ + q,   K_mu ∋ λ_i  ⊥  u_i + mu_i |u_iT| n ∈ K_mu*   for each contact i.
// Attachments and sliding constraints are equations in the same system: u = 0, or u_n = 0, with λ free.
// Contacts without friction (mu = 0) have one row, 0 <= λ_n ⊥ u_n >= 0; their tangential entries are never touched.
#pragma once

#include "engine/contact/friction_cone.hpp"
#include "engine/contact/row_kind.hpp"
#include "engine/core/types.hpp"

namespace impinge {

struct BodySpace;
struct NodeSpace;

/// The Delassus operator W = J A⁻¹ J^T, symmetric positive semidefinite, in 3 x 3 blocks, 1/kg. It may be stored as a
/// matrix or as factors; a Gauss-Seidel sweep needs rows and changes, so an operator keeps J A⁻¹ J^T λ up to date
/// between them.
class Delassus {
 public:
  virtual ~Delassus() = default;
  virtual std::size_t contacts() const = 0;
  virtual const Mat3& diagonal(std::size_t i) const = 0;
  /// Starts from λ (contacts entries).
  virtual void begin(const std::vector<Vec3>& lambda) = 0;
  /// (W λ)_i for the present λ. With normal_only just the first entry is filled.
  virtual Vec3 row(std::size_t i, bool normal_only) const = 0;
  /// λ_i += delta.
  virtual void change(std::size_t i, const Vec3& delta, bool normal_only) = 0;

  // Whole products and copies, for methods that go by more than one contact at a time. By default they are made of the
  // functions above; an operator that can do better overrides them.

  /// Whether a sweep costs as much as there are contacts, not its square.
  virtual bool has_factors() const { return false; }
  /// The factors where all bodies are rigid, else null; they live as long as this.
  virtual const BodySpace* body_space() { return nullptr; }
  /// The factors of a group with deformable bodies whose contacts touch few nodes, else null; as long.
  virtual const NodeSpace* node_space() { return nullptr; }
  /// y = W x. The present λ becomes x.
  virtual void apply(const std::vector<Vec3>& x, std::vector<Vec3>& y);
  /// W written out, 3 contacts x 3 contacts. Changes the present λ.
  virtual MatX dense();
};

struct ConeProblem {
  Delassus* w = nullptr;
  std::vector<Vec3> q;        ///< m/s
  std::vector<double> mu;     ///< per contact
  std::vector<RowKind> kind;  ///< per contact; empty: all RowKind::contact
  FrictionLaw law = FrictionLaw::cone;

  RowKind kind_of(std::size_t i) const { return kind.empty() ? RowKind::contact : kind[i]; }
  /// Whether contact i has its normal row only.
  bool has_one_row(std::size_t i) const {
    return kind_of(i) == RowKind::sliding || (kind_of(i) == RowKind::contact && mu[i] == 0.0);
  }
  /// Whether an impulse of contact i can't move anything: both bodies are held.
  bool is_held(std::size_t i) const {
    return !(has_one_row(i) ? w->diagonal(i)(0, 0) > 0.0 : w->diagonal(i).trace() > 0.0);
  }

  /// The nearest λ_i to z that contact i allows: its cone, or where λ is free all of its rows.
  Vec3 nearest(std::size_t i, const Vec3& z) const;
  /// What is complementary to λ_i: û = u + mu |u_T| n of the rows that there are, or of an equation what must be 0.
  Vec3 dual(std::size_t i, const Vec3& u) const;
  /// How far λ_i is from what is allowed, N·s.
  double violation(std::size_t i, const Vec3& lambda) const;
};

/// The scalar rows that a problem has, contact by contact: index 3 i + k of row k of contact i; contacts of one row
/// have only k = 0.
std::vector<int> rows_of(const ConeProblem& problem);

}  // namespace impinge
