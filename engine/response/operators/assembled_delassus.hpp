// W = J A⁻¹ J^T of a group with deformable bodies, as a dense matrix. A⁻¹ is never formed: one factorization a body
// serves all its right-hand sides, and A is block diagonal by body, so bodies meet in W only through J. [Haapaoja16
// §4.1.3]
#pragma once

#include "engine/contact/group_system.hpp"
#include "engine/lcp/cone_problem.hpp"

namespace impinge {

class AssembledDelassus : public Delassus {
 public:
  /// Takes group.assembled if there is one, or makes it: factorizes A of every deformable body of the group; throws
  /// DivergenceError where A is not positive definite.
  explicit AssembledDelassus(GroupSystem& group);

  std::size_t contacts() const override { return diagonal_.size(); }
  const Mat3& diagonal(std::size_t i) const override { return diagonal_[i]; }
  void begin(const std::vector<Vec3>& lambda) override;
  Vec3 row(std::size_t i, bool normal_only) const override;
  void change(std::size_t i, const Vec3& delta, bool normal_only) override;
  MatX dense() override { return *w_; }
  const MatX& matrix() const { return *w_; }

 private:
  void add_columns(std::size_t i, const Vec3& x, Eigen::Index first, Eigen::Index count);

  std::shared_ptr<const MatX> w_;  // 3 contacts x 3 contacts, symmetric
  VecX product_;                   // W λ
  std::vector<Mat3> diagonal_;
};

/// Δv = A⁻¹ J^T λ of the group, with the factorizations that W was made with.
void apply_impulses(GroupSystem& group);

}  // namespace impinge
