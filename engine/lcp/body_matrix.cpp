#include "engine/lcp/body_matrix.hpp"

#include <Eigen/LU>
#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>

#include "engine/algebra/dense_product.hpp"
#include "engine/core/interrupt.hpp"
#include "engine/core/parallel.hpp"

namespace impinge {
namespace {

using SixByThree = std::array<BodySpace::Six, 3>;

constexpr int kWidest = 8;      // columns of a panel
constexpr double kZeros = 0.1;  // of a panel's entries at most
constexpr int kFew = 6;         // rows below that are not worth a panel's packing
constexpr int kStrip = 8;       // bodies' columns a task: some 100 µs where many are below

/// G J.
SixByThree weigh(const Mat3& g, const SixByThree& j) {
  SixByThree weighed;
  for (int r = 0; r < 3; ++r) weighed[r] = g(r, 0) * j[0] + g(r, 1) * j[1] + g(r, 2) * j[2];
  return weighed;
}

/// block += Jᵀ H, column by column.
void add_product(const SixByThree& j, const SixByThree& h, BodyMatrix::Block& block) {
  for (int c = 0; c < 6; ++c) block.col(c) += h[0][c] * j[0] + h[1][c] * j[1] + h[2][c] * j[2];
}

bool couples(const std::array<BodySpace::Side, 2>& sides) {
  return sides[0].body >= 0 && sides[1].body >= 0 && sides[0].body != sides[1].body;
}

}  // namespace

BodyMatrix::BodyMatrix(const BodySpace& bodies) : bodies_(bodies) {
  find_order();
  std::vector<std::vector<int>> below = find_fill();
  put_panels_together(below);
  find_panels(below);
  start_.assign(1, 0);
  for (const std::vector<int>& rows : below) {
    row_.insert(row_.end(), rows.begin(), rows.end());
    start_.push_back(static_cast<int>(row_.size()));
  }
  find_places();
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
std::vector<std::vector<int>> BodyMatrix::find_fill() const {
  const std::size_t count = position_.size();
  std::vector<std::vector<int>> rows(count);
  for (const auto& sides : bodies_.sides) {
    if (!couples(sides)) continue;
    const auto [low, high] = std::minmax(position_[sides[0].body], position_[sides[1].body]);
    rows[low].push_back(high);
  }
  for (std::size_t k = 0; k < count; ++k) {
    check_interrupt();
    std::sort(rows[k].begin(), rows[k].end());
    rows[k].erase(std::unique(rows[k].begin(), rows[k].end()), rows[k].end());
    if (rows[k].empty()) continue;
    std::vector<int>& next = rows[rows[k].front()];
    next.insert(next.end(), rows[k].begin() + 1, rows[k].end());
  }
  return rows;
}

/// Puts each column right after those that are eliminated into it (a postorder of the elimination tree): the same fill,
/// and columns of like rows are neighbours.
void BodyMatrix::put_panels_together(std::vector<std::vector<int>>& below) {
  const int count = static_cast<int>(below.size());
  std::vector<int> child(count, -1), sibling(count, -1), place(count), roots, path;
  for (int k = count - 1; k >= 0; --k) {
    if (below[k].empty()) {
      roots.push_back(k);
    } else {
      const int parent = below[k].front();
      sibling[k] = child[parent], child[parent] = k;
    }
  }
  int next = 0;
  for (const int root : roots) {
    path.push_back(root);
    while (!path.empty()) {
      const int k = path.back(), first = child[k];
      if (first >= 0) {
        child[k] = sibling[first];
        path.push_back(first);
      } else {
        place[k] = next++;
        path.pop_back();
      }
    }
  }
  for (int& position : position_) position = place[position];
  std::vector<std::vector<int>> moved(count);
  for (int k = 0; k < count; ++k) {
    for (int& row : below[k]) row = place[row];
    std::sort(below[k].begin(), below[k].end());
    moved[place[k]] = std::move(below[k]);
  }
  below = std::move(moved);
}

/// Neighbours of which each has nearly the rows of the next, and that one besides: they get all of them, zeros included.
void BodyMatrix::find_panels(std::vector<std::vector<int>>& below) {
  const int count = static_cast<int>(below.size());
  for (int end = count; end > 0;) {
    const std::size_t rest = below[end - 1].size();
    int first = end - 1;
    std::size_t entries = rest, zeros = 0;
    for (; first > 0 && end - first < kWidest; --first) {
      const std::vector<int>& rows = below[first - 1];
      const std::size_t wanted = rest + static_cast<std::size_t>(end - first);
      if (rows.empty() || rows.front() != first) break;
      entries += wanted, zeros += wanted - rows.size();
      if (static_cast<double>(zeros) > kZeros * static_cast<double>(entries)) break;
      std::vector<int>& all = below[first - 1];
      all.assign(1, first);
      all.insert(all.end(), below[first].begin(), below[first].end());
    }
    panel_.push_back(first);
    end = first;
  }
  std::reverse(panel_.begin(), panel_.end());
  panel_.push_back(count);
}

void BodyMatrix::find_places() {
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
    const SixByThree of_a = weigh(g[i], a.row), of_b = weigh(g[i], b.row);
    if (a.body >= 0) add_product(a.row, of_a, diagonal_[position_[a.body]]);
    if (b.body >= 0) add_product(b.row, of_b, diagonal_[position_[b.body]]);
    if (a.body >= 0 && a.body == b.body) {
      add_product(a.row, of_b, diagonal_[position_[a.body]]);
      add_product(b.row, of_a, diagonal_[position_[a.body]]);
    } else if (const Place& place = places_[i]; place.entry >= 0) {
      Block& lower = lower_[place.entry];
      Block& upper = upper_[place.entry];
      add_product(place.first_is_row ? a.row : b.row, place.first_is_row ? of_b : of_a, lower);
      add_product(place.first_is_row ? of_a : of_b, place.first_is_row ? b.row : a.row, upper);
    }
  }
}

void BodyMatrix::factorize(std::span<const Mat3> g) {
  assemble(g);
  for (std::size_t i = 0; i + 1 < panel_.size(); ++i) {
    check_interrupt();
    const int first = panel_[i], end = panel_[i + 1];
    const bool is_dense = start_[end] - start_[end - 1] >= kFew;
    for (int k = first; k < end; ++k) eliminate(k, is_dense ? end : static_cast<int>(position_.size()));
    if (is_dense) eliminate_panel(first, end);
  }
}

/// Takes column k out of the columns before `end`.
void BodyMatrix::eliminate(int k, int end) {
  diagonal_[k] = diagonal_[k].partialPivLu().inverse().eval();
  for (int p = start_[k]; p < start_[k + 1]; ++p) lower_[p] = (lower_[p] * diagonal_[k]).eval();
  for (int p = start_[k]; p < start_[k + 1] && row_[p] < end; ++p) {
    diagonal_[row_[p]].noalias() -= lower_[p] * upper_[p].transpose();
    int at = start_[row_[p]];  // the rows after p are all in that column too, in the same order
    for (int r = p + 1; r < start_[k + 1]; ++r, ++at) {
      while (row_[at] != row_[r]) ++at;
      lower_[at].noalias() -= lower_[r] * upper_[p].transpose();
      upper_[at].noalias() -= upper_[r] * lower_[p].transpose();
    }
  }
}

/// Takes the columns [first, end) out of those after them at once, by dense products of kStrip columns.
void BodyMatrix::eliminate_panel(int first, int end) {
  const int width = 6 * (end - first), count = start_[end] - start_[end - 1];
  const auto entry = [&](int k, int row) { return start_[first + k + 1] - count + row; };
  MatX lower(6 * count, width), upper(6 * count, width);  // upper: transposed, as upper_ is
  for (int row = 0; row < count; ++row)
    for (int k = 0; k < end - first; ++k) {
      lower.block<6, 6>(6 * row, 6 * k) = lower_[entry(k, row)];
      upper.block<6, 6>(6 * row, 6 * k) = upper_[entry(k, row)];
    }
  parallel_for((count + kStrip - 1) / kStrip, 1, [&](std::size_t strip) {
    const int left = kStrip * static_cast<int>(strip), columns = std::min(kStrip, count - left), rows = count - left;
    const auto less = [&](const MatX& a, const MatX& b) {
      const MatX right = b.middleRows(6 * left, 6 * columns).transpose();
      MatX change = MatX::Zero(6 * rows, 6 * columns);
      subtract_product({&a(6 * left, 0), 6 * count}, {right.data(), width}, change.data(), 6 * rows, 6 * rows,
                       6 * columns, width);
      return change;
    };
    const MatX of_lower = less(lower, upper), of_upper = less(upper, lower);
    for (int c = 0; c < columns; ++c) {
      const int target = row_[entry(0, left + c)];
      diagonal_[target] += of_lower.block<6, 6>(6 * c, 6 * c);
      int at = start_[target];
      for (int row = c + 1; row < rows; ++row, ++at) {
        while (row_[at] != row_[entry(0, left + row)]) ++at;
        lower_[at] += of_lower.block<6, 6>(6 * row, 6 * c);
        upper_[at] += of_upper.block<6, 6>(6 * row, 6 * c);
      }
    }
  });
}

void BodyMatrix::solve(VecX& x) const {
  using Six = Eigen::Matrix<double, 6, 1>;
  const int count = static_cast<int>(position_.size());
  std::vector<Six> y(count);
  for (int b = 0; b < count; ++b) y[position_[b]] = x.segment<6>(6 * b);
  for (int k = 0; k < count; ++k)
    for (int p = start_[k]; p < start_[k + 1]; ++p) y[row_[p]].noalias() -= lower_[p] * y[k];
  for (int k = count - 1; k >= 0; --k) {
    for (int p = start_[k]; p < start_[k + 1]; ++p) y[k].noalias() -= upper_[p].transpose() * y[row_[p]];
    y[k] = (diagonal_[k] * y[k]).eval();
  }
  for (int b = 0; b < count; ++b) x.segment<6>(6 * b) = y[position_[b]];
}

}  // namespace impinge
