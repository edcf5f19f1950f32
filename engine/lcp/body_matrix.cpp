#include "engine/lcp/body_matrix.hpp"

#include <Eigen/LU>
#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>

#include "engine/core/interrupt.hpp"

namespace impinge {
namespace {

using Rows = std::array<BodySpace::Six, 3>;

/// G J.
Rows weigh(const Mat3& g, const Rows& j) {
  Rows weighed;
  for (int r = 0; r < 3; ++r) weighed[r] = g(r, 0) * j[0] + g(r, 1) * j[1] + g(r, 2) * j[2];
  return weighed;
}

/// block += Jᵀ H, column by column.
void add_product(const Rows& j, const Rows& h, BodyMatrix::Block& block) {
  for (int c = 0; c < 6; ++c) block.col(c) += h[0][c] * j[0] + h[1][c] * j[1] + h[2][c] * j[2];
}

bool couples(const std::array<BodySpace::Side, 2>& sides) {
  return sides[0].body >= 0 && sides[1].body >= 0 && sides[0].body != sides[1].body;
}

}  // namespace

BodyMatrix::BodyMatrix(const BodySpace& bodies) : bodies_(bodies) {
  find_order();
  find_fill();
}

/// Bodies that touch few others first (minimum degree).
void BodyMatrix::find_order() {
  const int count = static_cast<int>(bodies_.mass.size());
  std::vector<Eigen::Triplet<double>> touching;
  for (const auto& sides : bodies_.sides)
    if (couples(sides)) {
      touching.emplace_back(sides[0].body, sides[1].body, 1.0);
      touching.emplace_back(sides[1].body, sides[0].body, 1.0);
    }
  Eigen::SparseMatrix<double> graph(count, count);
  graph.setFromTriplets(touching.begin(), touching.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int>()(graph, order);
  position_.resize(count);
  for (int i = 0; i < count; ++i) position_[order.indices()[i]] = i;
}

/// The pattern of L: a column has its own rows and those that the columns eliminated into it leave.
void BodyMatrix::find_fill() {
  const std::size_t count = position_.size();
  std::vector<std::vector<int>> below(count);
  for (const auto& sides : bodies_.sides) {
    if (!couples(sides)) continue;
    const auto [low, high] = std::minmax(position_[sides[0].body], position_[sides[1].body]);
    below[low].push_back(high);
  }
  const auto make_set = [](std::vector<int>& v) {
    std::sort(v.begin(), v.end());
    v.erase(std::unique(v.begin(), v.end()), v.end());
  };
  start_.assign(1, 0);
  for (std::size_t k = 0; k < count; ++k) {
    check_interrupt();
    make_set(below[k]);
    row_.insert(row_.end(), below[k].begin(), below[k].end());
    start_.push_back(static_cast<int>(row_.size()));
    if (below[k].empty()) continue;
    std::vector<int>& next = below[below[k].front()];
    next.insert(next.end(), below[k].begin() + 1, below[k].end());
    below[k] = {};
  }
  for (const auto& sides : bodies_.sides) {
    Place place;
    if (couples(sides)) {
      const int a = position_[sides[0].body], b = position_[sides[1].body];
      const auto [low, high] = std::minmax(a, b);
      const auto at = std::lower_bound(row_.begin() + start_[low], row_.begin() + start_[low + 1], high);
      place = {static_cast<int>(at - row_.begin()), a > b};
    }
    places_.push_back(place);
  }
}

void BodyMatrix::assemble(std::span<const Mat3> g) {
  diagonal_.assign(position_.size(), Block::Zero());
  lower_.assign(row_.size(), Block::Zero());
  upper_.assign(row_.size(), Block::Zero());
  for (std::size_t b = 0; b < position_.size(); ++b) {
    Block& own = diagonal_[position_[b]];
    own.topLeftCorner<3, 3>().diagonal().setConstant(bodies_.mass[b]);
    own.bottomRightCorner<3, 3>() = bodies_.inertia[b];
  }
  for (std::size_t i = 0; i < places_.size(); ++i) {
    if (g[i].isZero(0.0)) continue;
    const auto& [a, b] = bodies_.sides[i];
    const Rows of_a = weigh(g[i], a.row), of_b = weigh(g[i], b.row);
    if (a.body >= 0) add_product(a.row, of_a, diagonal_[position_[a.body]]);
    if (b.body >= 0) add_product(b.row, of_b, diagonal_[position_[b.body]]);
    if (a.body >= 0 && a.body == b.body) {
      add_product(a.row, of_b, diagonal_[position_[a.body]]);
      add_product(b.row, of_a, diagonal_[position_[a.body]]);
    } else if (const Place& place = places_[i]; place.entry >= 0) {
      Block& row_of_first = place.first_is_row ? lower_[place.entry] : upper_[place.entry];
      Block& row_of_second = place.first_is_row ? upper_[place.entry] : lower_[place.entry];
      add_product(a.row, of_b, row_of_first);
      add_product(b.row, of_a, row_of_second);
    }
  }
}

void BodyMatrix::factorize(std::span<const Mat3> g) {
  assemble(g);
  for (std::size_t k = 0; k < position_.size(); ++k) {
    if (k % 64 == 0) check_interrupt();
    diagonal_[k] = diagonal_[k].partialPivLu().inverse().eval();
    const int end = start_[k + 1];
    for (int p = start_[k]; p < end; ++p) {
      const int i = row_[p];
      lower_[p] = (lower_[p] * diagonal_[k]).eval();
      diagonal_[i].noalias() -= lower_[p] * upper_[p];
    }
    for (int p = start_[k]; p < end; ++p) {
      int at = start_[row_[p]];  // the rows after p are all in that column too, in the same order
      for (int r = p + 1; r < end; ++r, ++at) {
        while (row_[at] != row_[r]) ++at;
        lower_[at].noalias() -= lower_[r] * upper_[p];
        upper_[at].noalias() -= lower_[p] * upper_[r];
      }
    }
  }
}

void BodyMatrix::solve(VecX& x) const {
  using Six = Eigen::Matrix<double, 6, 1>;
  const int count = static_cast<int>(position_.size());
  std::vector<Six> y(count);
  for (int b = 0; b < count; ++b) y[position_[b]] = x.segment<6>(6 * b);
  for (int k = 0; k < count; ++k)
    for (int p = start_[k]; p < start_[k + 1]; ++p) y[row_[p]].noalias() -= lower_[p] * y[k];
  for (int k = count - 1; k >= 0; --k) {
    for (int p = start_[k]; p < start_[k + 1]; ++p) y[k].noalias() -= upper_[p] * y[row_[p]];
    y[k] = (diagonal_[k] * y[k]).eval();
  }
  for (int b = 0; b < count; ++b) x.segment<6>(6 * b) = y[position_[b]];
}

}  // namespace impinge
