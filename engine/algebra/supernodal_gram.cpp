// With Y = L⁻¹ P B, Bᵀ A⁻¹ B = Yᵀ Y: half of the triangular solves, and symmetric by itself. Y is never stored. The
// supernodes are taken from the leaves to the root as in the factorization: each gathers the parts of B in its own rows
// and what its children have left for it, solves for its rows of Y, adds their products to W and hands the rest on. A
// supernode works on those columns of B only that reach it, which is where sparse columns save: a contact on the surface
// touches one path from a leaf to the root.
#include "engine/algebra/supernodal_gram.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "engine/algebra/dense_cholesky.hpp"
#include "engine/core/interrupt.hpp"
#include "engine/core/parallel.hpp"

namespace impinge {
namespace {

constexpr int kColumnsOfB = 96;  // of B, in one supernode

std::size_t nth(int i) { return static_cast<std::size_t>(i); }

struct Entry3 {
  int place, column;
  double value;
};

/// B's entries by their row's place in the factor.
std::vector<Entry3> entries_by_place(const Supernodes& nodes, const SparseColumns& b) {
  std::vector<Entry3> entries;
  entries.reserve(static_cast<std::size_t>(b.nonZeros()));
  for (int j = 0; j < b.outerSize(); ++j)
    for (SparseColumns::InnerIterator it(b, j); it; ++it)
      entries.push_back({nodes.place()[static_cast<std::size_t>(it.row())], j, it.value()});
  std::stable_sort(entries.begin(), entries.end(), [](const Entry3& p, const Entry3& q) { return p.place < q.place; });
  return entries;
}

/// Where each of `some` stands in `all`; both ascend.
std::vector<int> places_in(const std::vector<int>& all, const std::vector<int>& some) {
  std::vector<int> places;
  places.reserve(some.size());
  int place = 0;
  for (const int c : some) {
    while (all[nth(place)] != c) ++place;
    places.push_back(place);
  }
  return places;
}

class Gram {
 public:
  Gram(const SupernodalFactor& l, const SparseColumns& b)
      : l_(l), nodes_(l.nodes()), entries_(entries_by_place(nodes_, b)) {
    begin_.assign(nth(nodes_.count()) + 1, entries_.size());
    for (std::size_t e = entries_.size(); e-- > 0;) begin_[nth(nodes_.node_of(entries_[e].place))] = e;
    for (int s = nodes_.count() - 1; s >= 0; --s) begin_[nth(s)] = std::min(begin_[nth(s)], begin_[nth(s) + 1]);
    find_columns(b.cols());
    fronts_.resize(nth(nodes_.count()));
    sums_.resize(nth(nodes_.tasks()));
  }

  /// w: zero.
  void find(MatX& w) {
    nodes_.run([&](int task) {
      Sum& sum = sums_[nth(task)];
      begin(task, sum);
      for (const int node : nodes_.nodes(task)) visit(node, sum);
    });
    std::vector<int> all(static_cast<std::size_t>(w.cols()));
    std::iota(all.begin(), all.end(), 0);
    for (const int task : nodes_.last_tasks()) take(sums_[nth(task)], all, w);
    w.triangularView<Eigen::Lower>() = -w;
    w.triangularView<Eigen::StrictlyUpper>() = w.transpose();
  }

 private:
  /// −W of the columns that reach a task's nodes, as far as it and those below have found it; its lower triangle.
  struct Sum {
    std::vector<int> columns;
    MatX values;
  };

  void begin(int task, Sum& sum) {
    for (const int node : nodes_.nodes(task))
      sum.columns.insert(sum.columns.end(), columns_[nth(node)].begin(), columns_[nth(node)].end());
    for (const int below : nodes_.tasks_below(task))
      sum.columns.insert(sum.columns.end(), sums_[nth(below)].columns.begin(), sums_[nth(below)].columns.end());
    std::sort(sum.columns.begin(), sum.columns.end());
    sum.columns.erase(std::unique(sum.columns.begin(), sum.columns.end()), sum.columns.end());
    const auto count = static_cast<Eigen::Index>(sum.columns.size());
    sum.values.setZero(count, count);
    for (const int below : nodes_.tasks_below(task)) take(sums_[nth(below)], sum.columns, sum.values);
  }

  static void take(Sum& from, const std::vector<int>& columns, MatX& to) {
    add(from.values, places_in(columns, from.columns), to);
    from = {};
  }

  void find_columns(Eigen::Index count) {
    columns_.resize(nth(nodes_.count()));
    std::vector<int> seen_by(static_cast<std::size_t>(count), -1);
    for (int s = 0; s < nodes_.count(); ++s) {
      std::vector<int>& columns = columns_[nth(s)];
      const auto add = [&](int c) {
        if (std::exchange(seen_by[nth(c)], s) != s) columns.push_back(c);
      };
      for (std::size_t e = begin_[nth(s)]; e < begin_[nth(s) + 1]; ++e) add(entries_[e].column);
      for (const int child : nodes_.children(s))
        for (const int c : columns_[nth(child)]) add(c);
      std::sort(columns.begin(), columns.end());
    }
  }

  /// A row for each of its columns of B, a column for each row of the supernode.
  void gather(int s, MatX& front) {
    const std::vector<int>& columns = columns_[nth(s)];
    front.setZero(static_cast<Eigen::Index>(columns.size()), nodes_.height(s));
    for (std::size_t e = begin_[nth(s)]; e < begin_[nth(s) + 1]; ++e) {
      const auto row = std::lower_bound(columns.begin(), columns.end(), entries_[e].column) - columns.begin();
      front(row, entries_[e].place - nodes_.first(s)) += entries_[e].value;
    }
    for (const int child : nodes_.children(s)) {
      MatX& part = fronts_[nth(child)];
      if (part.rows() > 0) {
        const std::vector<int> places = places_in(columns, columns_[nth(child)]);
        const std::span<const int> rows = nodes_.rows_of_parent(child);
        for (std::size_t j = 0; j < rows.size(); ++j) {
          const double* const in = part.col(nodes_.width(child) + static_cast<Eigen::Index>(j)).data();
          double* const out = front.col(rows[j]).data();
          for (std::size_t i = 0; i < places.size(); ++i) out[places[i]] += in[i];
        }
      }
      part = {};
    }
  }

  void visit(int s, Sum& sum) {
    const int active = static_cast<int>(columns_[nth(s)].size());
    if (active == 0) return;
    check_interrupt();
    MatX& front = fronts_[nth(s)];
    gather(s, front);
    const DenseColumns l = l_.columns(s);
    const int width = nodes_.width(s), below = nodes_.below(s);
    parallel_for(nth((active + kColumnsOfB - 1) / kColumnsOfB), 1, [&](std::size_t task) {
      const int first = static_cast<int>(task) * kColumnsOfB, count = std::min(kColumnsOfB, active - first);
      double* const rows = front.data() + first;
      solve_rows(l, width, rows, active, count);
      subtract_transposed({rows, active}, {l.first + width, l.stride},
                          rows + static_cast<std::ptrdiff_t>(width) * active, active, count, below, width);
    });
    if (columns_[nth(s)].size() == sum.columns.size()) {
      subtract_square({front.data(), active}, sum.values.data(), active, active, active, width);
      return;
    }
    MatX product = MatX::Zero(active, active);
    subtract_square({front.data(), active}, product.data(), active, active, active, width);
    add(product, places_in(sum.columns, columns_[nth(s)]), sum.values);
  }

  static void add(const MatX& lower, const std::vector<int>& places, MatX& to) {
    for (Eigen::Index j = 0; j < lower.cols(); ++j)
      for (Eigen::Index i = j; i < lower.rows(); ++i)
        to(places[static_cast<std::size_t>(i)], places[static_cast<std::size_t>(j)]) += lower(i, j);
  }

  const SupernodalFactor& l_;
  const Supernodes& nodes_;
  std::vector<Entry3> entries_;
  std::vector<std::size_t> begin_;         // of each node's entries
  std::vector<std::vector<int>> columns_;  // of B, that reach each node
  std::vector<MatX> fronts_;
  std::vector<Sum> sums_;  // of each task
};

}  // namespace

void supernodal_gram(const SupernodalFactor& l, const SparseColumns& b, MatX& w) {
  w.setZero(b.cols(), b.cols());
  if (b.cols() > 0) Gram(l, b).find(w);
}

}  // namespace impinge
