// With few contacts it isn't the law that keeps the sweeps from ending but the body: impulse that reaches all of a
// stiff one takes as many steps as its A is badly conditioned, and every contact that changes its mind begins them
// anew. Here they are made once a row: y_r = A⁻¹ J_r^T by conjugate gradients, W = J (y_1 ...), which is symmetrised,
// and Δv = Σ λ_r y_r. What the columns lack in accuracy is taken into q and solved for again: each round gains as much
// as they have.
#include "engine/response/delassus_columns.hpp"

#include <algorithm>

#include "engine/core/interrupt.hpp"
#include "engine/lcp/block_sparse_delassus.hpp"

namespace impinge {
namespace {

constexpr double kColumn = 1e-7;  // ‖r‖ over ‖b‖ of a column
constexpr int kRounds = 8;

struct Columns {
  std::vector<int> rows;  // as rows_of()
  std::vector<VecX> y;    // A⁻¹ J_r^T
};

std::vector<BlockSparseDelassus::Block> blocks_of(const GroupOperator& a, const Columns& columns, int contacts) {
  MatX w = MatX::Zero(3 * contacts, 3 * contacts);
  for (std::size_t k = 0; k < columns.rows.size(); ++k) {
    check_interrupt();
    for (int i = 0; i < contacts; ++i)
      w.block<3, 1>(3 * i, columns.rows[k]) = a.row(static_cast<std::size_t>(i), columns.y[k]);
  }
  std::vector<BlockSparseDelassus::Block> blocks;
  for (int i = 0; i < contacts; ++i)
    for (int j = 0; j < contacts; ++j)
      blocks.push_back({i, j, 0.5 * (w.block<3, 3>(3 * i, 3 * j) + w.block<3, 3>(3 * j, 3 * i).transpose())});
  return blocks;
}

VecX impulse(const GroupOperator& a, const std::vector<Vec3>& lambda) {
  VecX f = VecX::Zero(a.size());
  for (std::size_t i = 0; i < lambda.size(); ++i) a.add_impulse(i, lambda[i], f);
  return f;
}

}  // namespace

DelassusColumnsResult solve_by_delassus_columns(const GroupOperator& a, ConeProblem problem, const LcpSolver& solver,
                                                double tolerance, GroupSystem& group, VecX& x) {
  DelassusColumnsResult result;
  Columns columns{rows_of(problem), {}};
  for (const int r : columns.rows) {
    VecX b = VecX::Zero(a.size()), y = VecX::Zero(a.size());
    a.add_impulse(static_cast<std::size_t>(r / 3), Vec3::Unit(r % 3), b);
    if (!a.solve({}, b, kColumn, y)) return result;
    ++result.solves;
    columns.y.push_back(std::move(y));
  }
  BlockSparseDelassus w(group.contacts.size(), blocks_of(a, columns, static_cast<int>(group.contacts.size())));
  problem.w = &w;
  const std::vector<Vec3> q = problem.q;
  std::vector<Vec3> lambda = group.lambda;
  VecX v = VecX::Zero(a.size());
  for (int round = 0; round < kRounds && !result.converged; ++round) {
    LcpSettings settings;
    settings.tolerance = 0.1 * tolerance / velocity_scale(problem);
    result.iterations += solver.solve(problem, settings, lambda).iterations;
    const VecX f = impulse(a, lambda);
    if (round == 0)
      for (std::size_t k = 0; k < columns.rows.size(); ++k)
        v += lambda[static_cast<std::size_t>(columns.rows[k] / 3)][columns.rows[k] % 3] * columns.y[k];
    if (f.isZero(0.0)) v.setZero();
    double left = a.velocity_of(f - a.multiply(v));
    // the solve's norm is over all nodes, the tolerance for each: so tight that none is left out
    for (double accuracy = 1e-8; accuracy > 1e-14 && left > 0.3 * tolerance; accuracy *= 0.1, ++result.solves) {
      a.solve({}, f, accuracy, v);
      left = a.velocity_of(f - a.multiply(v));
    }
    if (left > tolerance) return result;
    double worst = 0.0;
    w.begin(lambda);
    for (std::size_t i = 0; i < lambda.size(); ++i) {
      const Vec3 u = a.row(i, v) + q[i];
      worst = std::max(worst, natural_map(problem.kind_of(i), a.block_mobility(i), u, lambda[i], problem.mu[i]));
      problem.q[i] = u - w.row(i, false);
    }
    result.converged = worst <= tolerance;
  }
  if (!result.converged) return result;
  group.lambda = std::move(lambda);
  x = std::move(v);
  return result;
}

}  // namespace impinge
