// The complementarity problem as data: all that a solver in this folder sees.
//   u = W λ + q,   K_mu ∋ λ_i  ⊥  u_i + mu_i |u_iT| n ∈ K_mu*   for each contact i.
// Attachments and sliding constraints are equations in the same system: u = 0, or u_n = 0, with λ free.
// Contacts without friction (mu = 0) have one row, 0 <= λ_n ⊥ u_n >= 0; their tangential entries are never touched.
#pragma once

#include "engine/contact/row_kind.hpp"
#include "engine/core/types.hpp"

namespace impinge {

/// The Delassus operator W = J A⁻¹ J^T, symmetric positive semidefinite, in 3 x 3 blocks, 1/kg. It may be stored as a matrix or as
/// factors; a Gauss-Seidel sweep needs rows and changes, so an operator keeps J A⁻¹ J^T λ up to date between them.
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
};

struct ConeProblem {
  Delassus* w = nullptr;
  std::vector<Vec3> q;     ///< m/s
  std::vector<double> mu;  ///< per contact
  std::vector<RowKind> kind;  ///< per contact; empty: all RowKind::contact
  RowKind kind_of(std::size_t i) const { return kind.empty() ? RowKind::contact : kind[i]; }
  /// Whether contact i has its normal row only.
  bool has_one_row(std::size_t i) const { return kind_of(i) == RowKind::sliding || (kind_of(i) == RowKind::contact && mu[i] == 0.0); }
};

}  // namespace impinge
