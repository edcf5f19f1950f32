#include "engine/algebra/supernodal_factor.hpp"

#include <algorithm>
#include <atomic>

#include "engine/algebra/dense_cholesky.hpp"
#include "engine/core/error.hpp"
#include "engine/core/interrupt.hpp"
#include "engine/core/parallel.hpp"

namespace impinge {
namespace {

constexpr Eigen::Index kColumnsPerTask = 32;  // right-hand sides

std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

SupernodalFactor::SupernodalFactor(Supernodes nodes, const Eigen::SparseMatrix<double>& lower)
    : nodes_(std::move(nodes)), values_(nodes_.values(nodes_.count())) {
  std::vector<std::vector<Source>> sources(at(nodes_.count()));
  const std::vector<int>& place = nodes_.place();
  for (int j = 0; j < lower.outerSize(); ++j)
    for (int k = lower.outerIndexPtr()[j]; k < lower.outerIndexPtr()[j + 1]; ++k) {
      const auto [column, row] = std::minmax(place[at(lower.innerIndexPtr()[k])], place[at(j)]);
      const int node = nodes_.node_of(column);
      const std::span<const int> rows = nodes_.rows(node);
      const auto found = std::lower_bound(rows.begin(), rows.end(), row);
      IMPINGE_ASSERT(found != rows.end() && *found == row);
      sources[at(node)].push_back(
          {k, (column - nodes_.first(node)) * nodes_.height(node) + static_cast<int>(found - rows.begin())});
    }
  source_begin_.push_back(0);
  for (const std::vector<Source>& of_node : sources) {
    sources_.insert(sources_.end(), of_node.begin(), of_node.end());
    source_begin_.push_back(sources_.size());
  }
}

DenseColumns SupernodalFactor::columns(int node) const {
  return {values_.data() + nodes_.values(node), nodes_.height(node)};
}

bool SupernodalFactor::factorize(const Eigen::SparseMatrix<double>& lower) {
  std::vector<MatX> left(at(nodes_.count()));
  std::atomic<bool> positive = true;
  nodes_.run([&](int task) {
    for (const int node : nodes_.nodes(task))
      if (positive && !factorize(node, lower, left)) positive = false;
  });
  return positive;
}

bool SupernodalFactor::factorize(int node, const Eigen::SparseMatrix<double>& lower, std::vector<MatX>& left) {
  check_interrupt();
  const int height = nodes_.height(node), width = nodes_.width(node), below = height - width;
  double* const values = values_.data() + nodes_.values(node);
  std::fill(values, values_.data() + nodes_.values(node + 1), 0.0);
  for (std::size_t k = source_begin_[at(node)]; k < source_begin_[at(node) + 1]; ++k)
    values[sources_[k].to] = lower.valuePtr()[sources_[k].from];
  MatX& rest = left[at(node)];
  rest.setZero(below, below);
  for (const int child : nodes_.children(node)) {
    MatX& part = left[at(child)];
    const std::span<const int> rows = nodes_.rows_of_parent(child);
    for (std::size_t j = 0; j < rows.size(); ++j) {
      const double* const in = part.col(static_cast<Eigen::Index>(j)).data();
      double* const out = rows[j] < width ? values + static_cast<std::ptrdiff_t>(rows[j]) * height
                                          : rest.data() + static_cast<std::ptrdiff_t>(rows[j] - width) * below - width;
      for (std::size_t i = j; i < rows.size(); ++i) out[rows[i]] += in[i];
    }
    part = {};
  }
  if (!factorize_columns(values, height, width)) return false;
  subtract_square({values + width, height}, rest.data(), below, below, below, width);
  return true;
}

void SupernodalFactor::solve(const VecX& b, VecX& x) const {
  x = b;
  solve_in_place(x);
}

void SupernodalFactor::solve(const MatX& b, MatX& x) const {
  x = b;
  const Eigen::Index tasks = (b.cols() + kColumnsPerTask - 1) / kColumnsPerTask;
  parallel_for(static_cast<std::size_t>(tasks), 1, [&](std::size_t task) {
    const auto first = static_cast<Eigen::Index>(task) * kColumnsPerTask;
    auto columns = x.middleCols(first, std::min(kColumnsPerTask, x.cols() - first));
    MatX part = columns;
    solve_in_place(part);
    columns = part;
  });
}

template <class Columns>
void SupernodalFactor::solve_in_place(Columns& x) const {
  const std::vector<int>& order = nodes_.order();
  Columns y(x.rows(), x.cols()), part;
  for (std::size_t i = 0; i < order.size(); ++i) y.row(static_cast<Eigen::Index>(i)) = x.row(order[i]);
  const auto panel = [&](int node) {
    return Eigen::Map<const MatX>(columns(node).first, nodes_.height(node), nodes_.width(node));
  };
  for (int s = 0; s < nodes_.count(); ++s) {
    const auto l = panel(s);
    const Eigen::Index w = l.cols(), below = l.rows() - w;
    auto own = y.middleRows(nodes_.first(s), w);
    l.topRows(w).template triangularView<Eigen::Lower>().solveInPlace(own);
    part.noalias() = l.bottomRows(below) * own;
    for (Eigen::Index i = 0; i < below; ++i) y.row(nodes_.rows(s)[static_cast<std::size_t>(w + i)]) -= part.row(i);
  }
  for (int s = nodes_.count() - 1; s >= 0; --s) {
    const auto l = panel(s);
    const Eigen::Index w = l.cols(), below = l.rows() - w;
    part.resize(below, x.cols());
    for (Eigen::Index i = 0; i < below; ++i) part.row(i) = y.row(nodes_.rows(s)[static_cast<std::size_t>(w + i)]);
    auto own = y.middleRows(nodes_.first(s), w);
    own.noalias() -= l.bottomRows(below).transpose() * part;
    l.topRows(w).template triangularView<Eigen::Lower>().transpose().solveInPlace(own);
  }
  for (std::size_t i = 0; i < order.size(); ++i) x.row(order[i]) = y.row(static_cast<Eigen::Index>(i));
}

}  // namespace impinge
