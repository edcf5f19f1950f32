// A sparse factor by supernodes against dense ones; its supernodes found by a symbolic elimination with sets.
#include "engine/algebra/supernodal_factor.hpp"

#include <Eigen/Cholesky>
#include <catch2/catch.hpp>
#include <mutex>
#include <numeric>
#include <set>

#include "engine/algebra/supernodal_gram.hpp"
#include "engine/core/parallel.hpp"
#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

using Sparse = Eigen::SparseMatrix<double>;

/// Points of a grid of `side`³, each joined with those beside it, three unknowns a point; `grids` that don't touch.
Sparse grid_matrix(int side, int grids, std::uint64_t seed) {
  Random random(seed);
  const int points = side * side * side * grids;
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<double> diagonal(static_cast<std::size_t>(3 * points), 1.0);
  const auto join = [&](int p, int q) {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const double x = random.sym();
        entries.emplace_back(3 * std::max(p, q) + i, 3 * std::min(p, q) + j, x);
        diagonal[static_cast<std::size_t>(3 * p + i)] += std::abs(x);
        diagonal[static_cast<std::size_t>(3 * q + j)] += std::abs(x);
      }
  };
  for (int p = 0; p < points; ++p) {
    const int x = p % side, y = p / side % side, z = p / side / side % side;
    if (x > 0) join(p, p - 1);
    if (y > 0) join(p, p - side);
    if (z > 0) join(p, p - side * side);
  }
  for (int i = 0; i < 3 * points; ++i) entries.emplace_back(i, i, 2.0 * diagonal[static_cast<std::size_t>(i)]);
  Sparse lower(3 * points, 3 * points);
  lower.setFromTriplets(entries.begin(), entries.end());
  return lower;
}

MatX full(const Sparse& lower) { return MatX(Sparse(lower.selfadjointView<Eigen::Lower>())); }

/// Each grid by bisection: of unknowns, those in the middle last.
void bisect(std::vector<int> points, int side, std::vector<int>& order) {
  if (points.size() <= 4) {
    order.insert(order.end(), points.begin(), points.end());
    return;
  }
  const auto coordinate = [&](int p, int axis) {
    return axis == 0 ? p % side : axis == 1 ? p / side % side : p / side / side;
  };
  int axis = 0, widest = -1, middle = 0;
  for (int k = 0; k < 3; ++k) {
    int least = 1 << 30, most = 0;
    for (const int p : points) least = std::min(least, coordinate(p, k)), most = std::max(most, coordinate(p, k));
    if (most - least > widest) axis = k, widest = most - least, middle = (least + most) / 2;
  }
  std::vector<int> low, high, between;
  for (const int p : points) {
    const int at = coordinate(p, axis);
    (at < middle ? low : at > middle ? high : between).push_back(p);
  }
  bisect(low, side, order);
  bisect(high, side, order);
  order.insert(order.end(), between.begin(), between.end());
}

Supernodes supernodes_of(const Sparse& lower, int side, std::size_t widest) {
  const int n = static_cast<int>(lower.cols());
  std::vector<int> points(static_cast<std::size_t>(n / 3)), by_point, order;
  std::iota(points.begin(), points.end(), 0);
  bisect(points, side, by_point);
  for (const int p : by_point)
    for (int d = 0; d < 3; ++d) order.push_back(3 * p + d);
  std::vector<int> place(order.size());
  for (int i = 0; i < n; ++i) place[static_cast<std::size_t>(order[static_cast<std::size_t>(i)])] = i;
  std::vector<std::set<int>> rows(order.size());
  for (int j = 0; j < n; ++j)
    for (Sparse::InnerIterator it(lower, j); it; ++it) {
      const int a = place[static_cast<std::size_t>(it.row())], b = place[static_cast<std::size_t>(j)];
      rows[static_cast<std::size_t>(std::min(a, b))].insert(std::max(a, b));
    }
  for (std::set<int>& column : rows)
    if (column.size() > 1)
      rows[static_cast<std::size_t>(*std::next(column.begin()))].insert(std::next(column.begin()), column.end());
  // one column joins the last if it has the same rows below
  std::vector<int> first, begin{0}, all;
  for (int j = 0; j < n; ++j) {
    const auto& own = rows[static_cast<std::size_t>(j)];
    const bool joins = j > 0 && rows[static_cast<std::size_t>(j) - 1].size() == own.size() + 1 &&
                       rows[static_cast<std::size_t>(j) - 1].count(j) > 0 &&
                       static_cast<std::size_t>(j - first.back()) < widest;
    if (joins) continue;
    first.push_back(j);
    all.insert(all.end(), own.begin(), own.end());
    begin.push_back(static_cast<int>(all.size()));
  }
  first.push_back(n);
  return {first, begin, all, order};
}

}  // namespace

TEST_CASE("supernodes come in tasks that hold each once, and every task has what it needs below it") {
  for (const auto& [side, grids, widest] : {std::tuple(3, 1, 400u), {7, 1, 400u}, {7, 1, 12u}, {6, 3, 400u}}) {
    CAPTURE(side, grids, widest);
    const Supernodes nodes = supernodes_of(grid_matrix(side, grids, 41), side, widest);
    CHECK((side == 3 ? nodes.tasks() == 1 : nodes.tasks() > 3));
    std::vector<int> task_of(static_cast<std::size_t>(nodes.count()), -1);
    for (int t = 0; t < nodes.tasks(); ++t) {
      CHECK(std::is_sorted(nodes.nodes(t).begin(), nodes.nodes(t).end()));
      for (const int s : nodes.nodes(t)) {
        CHECK(task_of[static_cast<std::size_t>(s)] == -1);
        task_of[static_cast<std::size_t>(s)] = t;
      }
    }
    CHECK(std::count(task_of.begin(), task_of.end(), -1) == 0);
    for (int s = 0; s < nodes.count(); ++s)
      for (const int child : nodes.children(s)) {
        const int own = task_of[static_cast<std::size_t>(s)], other = task_of[static_cast<std::size_t>(child)];
        const std::vector<int>& below = nodes.tasks_below(own);
        CHECK((own == other || std::count(below.begin(), below.end(), other) == 1));
        const std::span<const int> places = nodes.rows_of_parent(child);
        for (int i = 0; i < nodes.below(child); ++i)
          CHECK(nodes.rows(child)[static_cast<std::size_t>(nodes.width(child) + i)] ==
                nodes.rows(s)[static_cast<std::size_t>(places[static_cast<std::size_t>(i)])]);
      }
    for (const int threads : {1, 2}) {
      set_thread_count(threads);
      std::mutex one;
      std::vector<bool> done(static_cast<std::size_t>(nodes.tasks()), false);
      nodes.run([&](int task) {
        const std::lock_guard<std::mutex> alone(one);
        for (const int below : nodes.tasks_below(task)) CHECK(done[static_cast<std::size_t>(below)]);
        CHECK_FALSE(done[static_cast<std::size_t>(task)]);
        done[static_cast<std::size_t>(task)] = true;
      });
      CHECK(std::count(done.begin(), done.end(), false) == 0);
    }
    set_thread_count(0);
  }
}

TEST_CASE("a factor by supernodes solves as a dense one does, and makes W, with the same bits on any threads") {
  for (const auto& [side, grids, widest] : {std::tuple(2, 1, 400u), {7, 1, 400u}, {7, 1, 5u}, {5, 3, 400u}}) {
    CAPTURE(side, grids, widest);
    const Sparse lower = grid_matrix(side, grids, 42);
    SupernodalFactor factor(supernodes_of(lower, side, widest), lower);
    const Eigen::LLT<MatX> truth(full(lower));
    Random random(43);
    const VecX b = VecX::NullaryExpr(lower.rows(), [&] { return random.sym(); });
    std::vector<Eigen::Triplet<double>> entries;
    for (int c = 0; c < 210; ++c)  // near one another, as contacts are
      for (int k = 0; k < 4; ++k)
        entries.emplace_back(
            static_cast<int>(std::min<double>(lower.rows() - 1, (0.4 * c / 210 + 0.1 * random.u()) * lower.rows())), c,
            random.sym());
    SparseColumns columns(lower.rows(), 210);
    columns.setFromTriplets(entries.begin(), entries.end());
    VecX first;
    MatX first_w;
    for (const int threads : {1, 2, 0}) {
      set_thread_count(threads);
      REQUIRE(factor.factorize(lower));
      VecX x(b.size());
      factor.solve(b, x);
      MatX w;
      supernodal_gram(factor, columns, w);
      if (threads == 1) first = x, first_w = w;
      CHECK(x == first);
      CHECK(w == first_w);
    }
    set_thread_count(0);
    CHECK((first - truth.solve(b)).norm() <= 1e-13 * first.norm());
    const MatX whole = MatX(columns).transpose() * truth.solve(MatX(columns));
    CHECK((first_w - whole).norm() <= 1e-13 * whole.norm());
    CHECK(first_w == first_w.transpose());
  }
}

TEST_CASE("a factor by supernodes says where a matrix is not positive definite, and goes on with the next") {
  Sparse lower = grid_matrix(7, 1, 44);
  SupernodalFactor factor(supernodes_of(lower, 7, 400u), lower);
  const Sparse good = lower;
  for (const int at : {0, 500, 1028}) {
    lower = good;
    lower.coeffRef(at, at) = -1.0;
    CHECK_FALSE(factor.factorize(lower));
    CHECK(factor.factorize(good));
    VecX x(good.rows());
    factor.solve(VecX::Ones(good.rows()), x);
    CHECK((full(good) * x - VecX::Ones(good.rows())).norm() <= 1e-12 * std::sqrt(good.rows()));
  }
}
