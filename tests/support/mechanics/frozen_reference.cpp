#include "tests/support/mechanics/frozen_reference.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

#include "engine/response/operators/assembled_delassus.hpp"

namespace impinge::test {
namespace {

using Sparse = Eigen::SparseMatrix<double>;
using Triplets = std::vector<Eigen::Triplet<double>>;

/// First unknown of each deformable body; rigid ones come first, six each. The last entry is the number of unknowns.
std::vector<int> offsets(const FrozenGroup& group) {
  std::vector<int> first = {6 * static_cast<int>(group.system.rigid.size())};
  for (const BlockMatrix& a : group.matrices) first.push_back(first.back() + a.rows());
  return first;
}

void put(Triplets& list, int row, int column, const Mat3& block) {
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) list.emplace_back(row + r, column + c, block(r, c));
}

Triplets entries_of_a(const FrozenGroup& group) {
  Triplets list;
  for (int b = 0; b < static_cast<int>(group.system.rigid.size()); ++b) {
    put(list, 6 * b, 6 * b, Mat3(Mat3::Identity() / group.system.rigid[b].inverse_mass));
    put(list, 6 * b + 3, 6 * b + 3, group.system.rigid[b].inverse_inertia.inverse());
  }
  const auto first = offsets(group);
  for (std::size_t s = 0; s < group.matrices.size(); ++s) {
    const BlockPattern& p = *group.matrices[s].pattern;
    for (int i = 0; i < p.rows; ++i)
      for (int k = p.begin[i]; k < p.begin[i + 1]; ++k)
        put(list, first[s] + 3 * i, first[s] + 3 * p.column[k], group.matrices[s].values[k]);
  }
  return list;
}

/// J with three rows a contact.
Sparse jacobian(const FrozenGroup& group) {
  Triplets list;
  const auto first = offsets(group);
  for (int i = 0; i < static_cast<int>(group.system.contacts.size()); ++i) {
    const ContactRows& rows = group.system.contacts[i];
    for (const auto& [side, sign] : {std::pair(&rows.a, 1.0), std::pair(&rows.b, -1.0)}) {
      if (side->rigid >= 0) {
        put(list, 3 * i, 6 * side->rigid, sign * rows.directions);
        Mat3 arm;
        for (int k = 0; k < 3; ++k) arm.row(k) = sign * side->arm.cross(rows.directions.row(k).transpose()).transpose();
        put(list, 3 * i, 6 * side->rigid + 3, arm);
      }
      for (const NodeWeight& n : side->nodes)
        put(list, 3 * i, first[side->deformable] + 3 * n.node, sign * n.weight * rows.directions);
    }
  }
  Sparse j(static_cast<int>(3 * group.system.contacts.size()), first.back());
  j.setFromTriplets(list.begin(), list.end());
  return j;
}

/// The columns of J^T that touch unknowns [from, from + count), dense.
MatX columns_on(const Sparse& j, int from, int count) { return MatX(j.middleCols(from, count)).transpose(); }

}  // namespace

FrozenStep frozen_of(const GroupSystem& group) {
  FrozenStep step;
  step.scene = "test", step.time_step = 0.01;
  step.groups.push_back(freeze(group));
  return step;
}

FrozenStep without_friction(FrozenStep step) {
  for (FrozenGroup& group : step.groups) {
    for (ContactRows& rows : group.system.contacts) rows.friction = 0.0;
    std::fill(group.system.lambda.begin(), group.system.lambda.end(), Vec3(Vec3::Zero()));
  }
  return step;
}

GroupAnswer kkt_answer(const FrozenGroup& group) {
  const int m = static_cast<int>(group.system.contacts.size()), n = offsets(group).back();
  const Sparse j_all = jacobian(group);
  const Triplets of_a = entries_of_a(group);
  Sparse a(n, n), j(m, n);
  a.setFromTriplets(of_a.begin(), of_a.end());
  Triplets normal;
  VecX q(m);
  for (int c = 0; c < n; ++c)
    for (Sparse::InnerIterator it(j_all, c); it; ++it)
      if (it.row() % 3 == 0) normal.emplace_back(static_cast<int>(it.row()) / 3, c, it.value());
  j.setFromTriplets(normal.begin(), normal.end());
  for (int i = 0; i < m; ++i)
    q[i] = group.system.contact_velocity(static_cast<std::size_t>(i), false).x() - group.system.contacts[i].bound;

  // in velocities and in impulses that make such velocities, so that 1 is a natural size of both
  const double speed = std::max(q.cwiseAbs().maxCoeff(), 1e-300);
  const double impulse = speed * a.diagonal().mean();
  VecX x = VecX::Zero(n), lambda = VecX::Constant(m, impulse), s = VecX::Constant(m, speed);
  Eigen::SimplicialLDLT<Sparse> ldlt;
  for (int k = 0; k < 100; ++k) {
    const VecX momentum = a * x - j.transpose() * lambda, gap = j * x + q - s;
    const double mean = lambda.dot(s) / m;
    if (mean < 1e-22 * impulse * speed && gap.cwiseAbs().maxCoeff() < 1e-14 * speed) break;
    Triplets list = of_a;
    for (const auto& e : normal)
      list.emplace_back(n + e.row(), e.col(), e.value()), list.emplace_back(e.col(), n + e.row(), e.value());
    for (int i = 0; i < m; ++i) list.emplace_back(n + i, n + i, -s[i] / lambda[i]);
    Sparse kkt(n + m, n + m);
    kkt.setFromTriplets(list.begin(), list.end());
    if (k == 0) ldlt.analyzePattern(kkt);
    ldlt.factorize(kkt);
    VecX right(n + m);
    right.head(n) = -momentum;
    right.tail(m) = (0.1 * mean * lambda.cwiseInverse() - s) - gap;
    VecX step = ldlt.solve(right);
    step += ldlt.solve(VecX(right - kkt * step));
    const VecX dx = step.head(n), d_lambda = -step.tail(m), ds = j * dx + gap;
    double length = 1.0;
    for (int i = 0; i < m; ++i) {
      if (d_lambda[i] < 0.0) length = std::min(length, -0.995 * lambda[i] / d_lambda[i]);
      if (ds[i] < 0.0) length = std::min(length, -0.995 * s[i] / ds[i]);
    }
    if (!step.allFinite() || length < 1e-10) break;
    x += length * dx, lambda += length * d_lambda, s += length * ds;
  }

  GroupAnswer answer;
  for (int i = 0; i < m; ++i) answer.lambda.emplace_back(lambda[i], 0.0, 0.0);
  for (int b = 0; b < static_cast<int>(group.system.rigid.size()); ++b) {
    answer.delta_velocity.push_back(x.segment<3>(6 * b));
    answer.delta_angular_velocity.push_back(x.segment<3>(6 * b + 3));
  }
  const auto first = offsets(group);
  for (std::size_t b = 0; b < group.matrices.size(); ++b)
    answer.deformable_delta.push_back(x.segment(first[b], group.matrices[b].rows()));
  return answer;
}

MatX w_assembled(const FrozenGroup& group, const LinearSolverChoice& linear_solver) {
  ThawedGroup thawed = thaw(group, linear_solver);
  return AssembledDelassus(thawed.system).matrix();
}

MatX w_by_whole_solves(const FrozenGroup& group, const LinearSolverChoice& linear_solver) {
  const Sparse j = jacobian(group);
  MatX w = MatX::Zero(j.rows(), j.rows());
  for (std::size_t b = 0; b < group.system.rigid.size(); ++b) {
    const MatX columns = columns_on(j, 6 * static_cast<int>(b), 6);
    MatX solved = columns;
    solved.topRows(3) *= group.system.rigid[b].inverse_mass;
    solved.bottomRows(3) = group.system.rigid[b].inverse_inertia * columns.bottomRows(3);
    w += columns.transpose() * solved;
  }
  ThawedGroup thawed = thaw(group, linear_solver);
  const auto first = offsets(group);
  for (std::size_t s = 0; s < group.matrices.size(); ++s) {
    LinearSolver& solver = *thawed.solvers[s];
    solver.tolerance = 1e-15;
    solver.factorize(group.matrices[s]);
    MatX x;
    solver.solve_many(columns_on(j, first[s], group.matrices[s].rows()), x);
    w += j.middleCols(first[s], group.matrices[s].rows()) * x;
  }
  return w;
}

MatX w_by_dense_inverse(const FrozenGroup& group) {
  const Sparse j = jacobian(group);
  MatX w = MatX::Zero(j.rows(), j.rows());
  const Triplets of_a = entries_of_a(group);
  const auto add = [&](int from, int count) {
    if (count == 0) return;
    MatX a = MatX::Zero(count, count);
    for (const auto& e : of_a)
      if (e.row() >= from && e.row() < from + count) a(e.row() - from, e.col() - from) += e.value();
    const MatX inverse = Eigen::LLT<MatX>(a).solve(MatX(MatX::Identity(count, count)));
    const Sparse part = j.middleCols(from, count);
    w += part * MatX(inverse * MatX(part.transpose()));
  };
  add(0, 6 * static_cast<int>(group.system.rigid.size()));
  const auto first = offsets(group);
  for (std::size_t s = 0; s < group.matrices.size(); ++s) add(first[s], group.matrices[s].rows());
  return w;
}

}  // namespace impinge::test
