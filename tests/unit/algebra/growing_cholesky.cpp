// L Lᵀ that gains and loses rows, against one made afresh.
#include "engine/algebra/growing_cholesky.hpp"

#include <catch2/catch.hpp>

#include <vector>

#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

TEST_CASE("a factor that gains and loses rows solves as one that is made afresh does") {
  Random random(31);
  constexpr int n = 40;
  MatX g(n, n);
  for (Eigen::Index i = 0; i < g.size(); ++i) g.data()[i] = random.sym();
  const MatX a = g * g.transpose() + 0.1 * MatX::Identity(n, n);
  GrowingCholesky factor;
  std::vector<int> rows, others(n);
  for (int i = 0; i < n; ++i) others[i] = i;
  for (int step = 0; step < 2000; ++step) {
    const auto k = static_cast<Eigen::Index>(rows.size());
    if (!others.empty() && (rows.empty() || random.below(5) < 3)) {
      const auto at = static_cast<std::size_t>(random.below(static_cast<int>(others.size())));
      VecX column(k);
      for (Eigen::Index i = 0; i < k; ++i) column[i] = a(rows[i], others[at]);
      const VecX row = factor.forward(column);
      factor.add(row, a(others[at], others[at]) - row.squaredNorm());
      rows.push_back(others[at]);
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(at));
    } else {
      const auto at = static_cast<std::size_t>(random.below(static_cast<int>(rows.size())));
      factor.remove(static_cast<Eigen::Index>(at));
      others.push_back(rows[at]);
      rows.erase(rows.begin() + static_cast<std::ptrdiff_t>(at));
    }
    REQUIRE(factor.size() == static_cast<Eigen::Index>(rows.size()));
    if (rows.empty()) continue;
    VecX b(static_cast<Eigen::Index>(rows.size()));
    for (double& x : b) x = random.sym();
    const VecX x = factor.backward(factor.forward(b));
    const MatX part = a(rows, rows);
    REQUIRE((part * x - b).norm() < 1e-10 * (part.norm() * x.norm() + b.norm()));
  }
}
