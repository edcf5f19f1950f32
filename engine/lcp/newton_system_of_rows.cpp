#include <Eigen/SparseCore>
#include <Eigen/SparseLU>
#include <limits>

#include "engine/algebra/dense_lu.hpp"
#include "engine/core/interrupt.hpp"
#include "engine/core/parallel.hpp"
#include "engine/lcp/newton_system.hpp"

namespace impinge {
namespace {

constexpr Eigen::Index kSparseRows = 300;  // below this a dense factorization is quicker whatever the pattern
constexpr std::size_t kColumnsPerTask = 64;
constexpr double kSparseFill = 0.15;  // share of W that is not 0

class SystemOfRows : public NewtonSystem {
 public:
  explicit SystemOfRows(const ConeProblem& problem) : rows_(rows_of(problem)), w_(problem.w->dense()) {
    const auto nonzero = static_cast<double>((w_.array() != 0.0).count());
    sparse_ = w_.rows() >= kSparseRows && nonzero < kSparseFill * static_cast<double>(w_.size());
  }

  void factorize(std::span<const Mat3> a, std::span<const Mat3> b, const std::vector<char>& kept) override {
    a_.assign(a.begin(), a.end());
    kept_.clear(), known_.clear();
    for (const int row : rows_) (kept[row / 3] ? kept_ : known_).push_back(row);
    const auto n = static_cast<Eigen::Index>(kept_.size());
    if (n == 0) return;
    // row r of A W + B: A_i mixes the rows of its own contact only
    const auto column_of = [&](int c, double* out) {
      for (std::size_t k = 0; k < kept_.size();) {
        const int i = kept_[k] / 3;
        const Vec3 w = w_.col(c).segment<3>(3 * i);
        for (; k < kept_.size() && kept_[k] / 3 == i; ++k) {
          const int row = kept_[k] % 3;
          *out++ = a[i](row, 0) * w.x() + a[i](row, 1) * w.y() + a[i](row, 2) * w.z() +
                   (i == c / 3 ? b[i](row, c % 3) : 0.0);
        }
      }
    };
    if (!sparse_) {
      MatX m(n, n);
      parallel_for(static_cast<std::size_t>(n), kColumnsPerTask,
                   [&](std::size_t c) { column_of(kept_[c], m.col(static_cast<Eigen::Index>(c)).data()); });
      dense_lu_.compute(std::move(m));
      return;
    }
    std::vector<Eigen::Triplet<double>> entries;
    VecX column(n);
    for (Eigen::Index c = 0; c < n; ++c) {
      check_interrupt();
      column_of(kept_[static_cast<std::size_t>(c)], column.data());
      for (Eigen::Index r = 0; r < n; ++r)
        if (column[r] != 0.0) entries.emplace_back(static_cast<int>(r), static_cast<int>(c), column[r]);
    }
    Eigen::SparseMatrix<double> m(n, n);
    m.setFromTriplets(entries.begin(), entries.end());
    sparse_lu_.compute(m);
    singular_ = sparse_lu_.info() != Eigen::Success;
  }

  void solve(const VecX& b, VecX& x) const override {
    x = VecX::Zero(b.size());
    for (const int row : known_) x[row] = b[row];
    const auto n = static_cast<Eigen::Index>(kept_.size());
    if (n == 0) return;
    VecX rest(n);
    VecX carried = VecX::Zero(b.size());
    for (const int row : known_)
      if (x[row] != 0.0) carried += x[row] * w_.col(row);
    for (Eigen::Index r = 0; r < n; ++r) {
      const int row = kept_[r], i = row / 3;
      rest[r] = b[row];
      if (!known_.empty())
        for (int k = 0; k < 3; ++k) rest[r] -= a_[i](row % 3, k) * carried[3 * i + k];
    }
    VecX y;
    if (!sparse_)
      y = dense_lu_.solve(rest);
    else if (singular_)
      y = VecX::Constant(n, std::numeric_limits<double>::quiet_NaN());
    else
      y = sparse_lu_.solve(rest);
    for (Eigen::Index r = 0; r < n; ++r) x[kept_[r]] = y[r];
  }

 private:
  std::vector<int> rows_;  // the scalar rows of the problem
  MatX w_;
  std::vector<Mat3> a_;
  std::vector<int> kept_, known_;  // scalar rows
  bool sparse_ = false, singular_ = false;
  DenseLu dense_lu_;
  Eigen::SparseLU<Eigen::SparseMatrix<double>, Eigen::COLAMDOrdering<int>> sparse_lu_;
};

}  // namespace

std::unique_ptr<NewtonSystem> newton_system_of_rows(const ConeProblem& problem) {
  return std::make_unique<SystemOfRows>(problem);
}

std::unique_ptr<NewtonSystem> newton_system(const ConeProblem& problem) {
  if (const BodySpace* bodies = problem.w->body_space()) return newton_system_of_bodies(*bodies);
  if (const NodeSpace* nodes = problem.w->node_space()) return newton_system_of_nodes(*nodes);
  return newton_system_of_rows(problem);
}

}  // namespace impinge
