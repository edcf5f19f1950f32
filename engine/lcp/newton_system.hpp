// The linear systems of Newton's methods here: (A W + B) x = b with A and B block diagonal by contact. Rows that a
// method knows already (A's row is 0, B's the unit row) are taken out first, so contacts that are open cost nothing.
// The rest is factorized by LU, densely or, where W is large and mostly zero, sparsely.
#pragma once

#include <memory>
#include <span>

#include "engine/lcp/cone_problem.hpp"

namespace impinge {

class NewtonSystem {
 public:
  /// Writes W out, rows x columns of all contacts; changes the operator's present λ.
  explicit NewtonSystem(const ConeProblem& problem);
  ~NewtonSystem();

  /// W may be changed (scaled) before the first factorize.
  MatX& w() { return w_; }

  /// Takes the numbers; kept[i] says that contact i has rows of its own, otherwise A_i = 0 and B_i = 1.
  void factorize(std::span<const Mat3> a, std::span<const Mat3> b, const std::vector<char>& kept);
  /// x = (A W + B)⁻¹ b; not finite where the matrix is singular.
  void solve(const VecX& b, VecX& x) const;

 private:
  struct Factors;
  std::vector<int> rows_;  // the scalar rows of the problem
  MatX w_;
  std::vector<Mat3> a_;
  std::vector<int> kept_, known_;  // scalar rows
  bool sparse_ = false;
  std::unique_ptr<Factors> factors_;
};

}  // namespace impinge
