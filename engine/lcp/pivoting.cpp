// Lemke's complementary pivoting: the exact answer of a linear complementarity problem in finitely many steps, for
// small problems without friction or with the friction pyramid. The reference that other solvers are held against.
//
// A contact with a pyramid is five complementary pairs [Stewart00]: with s_k = λ_k + mu λ_n >= 0 and u_k = v_k - w_k,
//   0 <= λ_n ⊥ u_n >= 0,   0 <= s_k ⊥ v_k = u_k + w_k >= 0,   0 <= w_k ⊥ 2 mu λ_n - s_k >= 0   (k = 1, 2).
// With W positive definite the matrix is copositive, so Lemke's method ends with a solution [CottlePangStone92, 4.4];
// ties in the ratio test are broken lexicographically, so it can't cycle. The tableau only finds which variables are
// basic: the answer is then solved for afresh with the problem's own numbers.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "engine/core/interrupt.hpp"
#include "engine/lcp/gauss_seidel_sweep.hpp"

namespace impinge {
namespace {

constexpr std::size_t kMostRows = 300;

/// z >= 0, M z + q >= 0, complementary, and how λ follows from z: λ = T z.
struct LinearProblem {
  MatX m, t;
  VecX q;
};

LinearProblem linear_problem(const ConeProblem& problem) {
  const MatX w = problem.w->dense();
  const auto n = static_cast<Eigen::Index>(problem.q.size());
  Eigen::Index size = 0;
  for (const double mu : problem.mu) size += mu == 0.0 ? 1 : 5;
  LinearProblem p{MatX::Zero(size, size), MatX::Zero(3 * n, size), VecX::Zero(size)};
  Eigen::Index at = 0;
  for (Eigen::Index i = 0; i < n; ++i) {  // λ by z: n, s1, s2, w1, w2
    p.t(3 * i, at) = 1.0;
    if (problem.mu[i] == 0.0) {
      ++at;
      continue;
    }
    for (Eigen::Index k = 1; k <= 2; ++k) {
      p.t(3 * i + k, at) = -problem.mu[i];
      p.t(3 * i + k, at + k) = 1.0;
    }
    at += 5;
  }
  const MatX wt = w * p.t;
  at = 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const bool friction = problem.mu[i] != 0.0;
    for (Eigen::Index k = 0; k < (friction ? 3 : 1); ++k) {
      p.m.row(at + k) = wt.row(3 * i + k);
      p.q[at + k] = problem.q[i][k];
    }
    for (Eigen::Index k = 1; friction && k <= 2; ++k) {
      p.m(at + k, at + 2 + k) += 1.0;
      p.m(at + 2 + k, at) = 2.0 * problem.mu[i];
      p.m(at + 2 + k, at + k) = -1.0;
    }
    at += friction ? 5 : 1;
  }
  return p;
}

/// Rows w = q + M z + z0 d with w basic at first; variable j < size is w_j, size + j is z_j, 2 size is z0.
class Tableau {
 public:
  explicit Tableau(const LinearProblem& p) : size_(p.q.size()), rows_(size_, 2 * size_ + 2), basis_(size_) {
    rows_.leftCols(size_).setIdentity();
    rows_.middleCols(size_, size_) = -p.m;
    rows_.col(2 * size_).setConstant(-1.0);
    rows_.col(2 * size_ + 1) = p.q;
    for (Eigen::Index i = 0; i < size_; ++i) basis_[i] = i;
  }

  LcpResult run(int max_iterations) {
    Eigen::Index row = 0;
    for (Eigen::Index i = 1; i < size_; ++i)
      if (value(i) < value(row)) row = i;
    if (value(row) >= 0.0) return {0, StopReason::converged};
    Eigen::Index entering = 2 * size_;
    for (int pivots = 1; pivots <= max_iterations; ++pivots) {
      check_interrupt();
      const Eigen::Index leaving = basis_[row];
      pivot(row, entering);
      if (leaving == 2 * size_) return {pivots, StopReason::converged};
      entering = leaving < size_ ? leaving + size_ : leaving - size_;
      row = leaving_row(entering);
      if (row < 0) return {pivots, StopReason::stagnated};  // a ray: no solution on this path
    }
    return {max_iterations, StopReason::iteration_cap};
  }

  /// z of the basis, from the problem's own numbers.
  VecX solution(const LinearProblem& p) const {
    MatX a(size_, size_);
    for (Eigen::Index i = 0; i < size_; ++i) {
      const Eigen::Index v = basis_[i];
      if (v < size_)
        a.col(i) = VecX::Unit(size_, v);
      else if (v < 2 * size_)
        a.col(i) = -p.m.col(v - size_);
      else
        a.col(i).setConstant(-1.0);
    }
    const Eigen::PartialPivLU<MatX> lu(a);
    VecX x = lu.solve(p.q);
    x += lu.solve(p.q - a * x);
    VecX z = VecX::Zero(size_);
    for (Eigen::Index i = 0; i < size_; ++i)
      if (basis_[i] >= size_ && basis_[i] < 2 * size_) z[basis_[i] - size_] = x[i];
    return z;
  }

 private:
  double value(Eigen::Index row) const { return rows_(row, 2 * size_ + 1); }

  void pivot(Eigen::Index row, Eigen::Index column) {
    rows_.row(row) /= rows_(row, column);
    const VecX factor = rows_.col(column);
    const Eigen::RowVectorXd source = rows_.row(row);
    for (Eigen::Index c = 0; c < rows_.cols(); ++c) {
      if (source[c] == 0.0) continue;
      const double own = rows_(row, c);
      rows_.col(c) -= source[c] * factor;
      rows_(row, c) = own;
    }
    basis_[row] = column;
  }

  /// The row whose variable reaches 0 first as `column` grows; of several the lexicographically least. z0 leaves if it
  /// can.
  Eigen::Index leaving_row(Eigen::Index column) const {
    const double smallest = 1e-11 * rows_.col(column).cwiseAbs().maxCoeff();
    Eigen::Index best = -1;
    for (Eigen::Index i = 0; i < size_; ++i) {
      if (!(rows_(i, column) > smallest)) continue;
      if (best < 0 || less(i, best, column)) best = i;
    }
    return best;
  }

  bool less(Eigen::Index l, Eigen::Index r, Eigen::Index column) const {
    const double a = value(l) / rows_(l, column), b = value(r) / rows_(r, column);
    if (std::abs(a - b) > 1e-13 * (std::abs(a) + std::abs(b))) return a < b;
    if (basis_[l] == 2 * size_) return true;
    if (basis_[r] == 2 * size_) return false;
    for (Eigen::Index c = 0; c < size_; ++c) {
      const double x = rows_(l, c) / rows_(l, column), y = rows_(r, c) / rows_(r, column);
      if (x != y) return x < y;
    }
    return false;
  }

  Eigen::Index size_;
  MatX rows_;
  std::vector<Eigen::Index> basis_;
};

class Pivoting : public LcpSolver {
 public:
  int reference_rank() const override { return 2; }
  LcpResult solve(const ConeProblem& problem, const LcpSettings& settings, std::vector<Vec3>& lambda) const override {
    if (problem.q.empty()) return {};
    if (!applies(problem).empty()) return {0, StopReason::refused};
    const auto relative = [&](const std::vector<Vec3>& at) {
      std::vector<Vec3> u;
      problem.w->begin(at);
      velocities(problem, u);
      const double residual = relative_residual(problem, u, at, settings.measure);
      if (settings.history != nullptr) settings.history->push_back(residual);
      return residual;
    };
    if (relative(lambda) <= settings.tolerance) return {0, StopReason::converged};
    const LinearProblem p = linear_problem(problem);
    Tableau tableau(p);
    LcpResult result = tableau.run(settings.max_iterations);
    if (result.reason == StopReason::iteration_cap) return result;
    const VecX found = p.t * tableau.solution(p);
    if (found.allFinite())
      for (std::size_t i = 0; i < lambda.size(); ++i)
        lambda[i] = project(found.segment<3>(3 * static_cast<Eigen::Index>(i)), problem.mu[i], problem.law);
    result.reason = relative(lambda) <= settings.tolerance ? StopReason::converged : StopReason::stagnated;
    return result;
  }

  std::string applies(const ConeProblem& problem) const override {
    for (std::size_t i = 0; i < problem.q.size(); ++i)
      if (problem.kind_of(i) != RowKind::contact)
        return "attachments and sliding constraints are equations; it solves complementarity only";
    if (problem.law == FrictionLaw::cone &&
        std::any_of(problem.mu.begin(), problem.mu.end(), [](double mu) { return mu != 0.0; }))
      return "a friction cone is not linear; it solves problems without friction or with the pyramid";
    const std::size_t rows = rows_of(problem).size();
    if (rows > kMostRows)
      return std::to_string(rows) + " rows; it is a reference for up to " + std::to_string(kMostRows);
    return "";
  }
};

}  // namespace

Entry<LcpSolver> pivoting_solver() {
  return entry<LcpSolver, Pivoting>("pivoting",
                                    "Lemke's method, the exact reference: small problems, no friction or the pyramid");
}

}  // namespace impinge
