// W between joints is filled wherever they share a body: a hub of a thousand pendulums. So the bodies stay in the system, in
// units in which their masses are 1: (1, Jᵀ; J, −ε), quasi-definite, which has a factorization in any order.
#include "engine/response/joint_system.hpp"

#include <Eigen/Eigenvalues>

namespace impinge {
namespace {

// What loops hold together no better than this they don't hold: the root of what is rounding. Each block is 1.
constexpr double kLoose = 1e-8;

using Rows6 = Eigen::Matrix<double, Eigen::Dynamic, 6>;

Mat3 root(const Mat3& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Mat3> eigen(symmetric);
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal() *
         eigen.eigenvectors().transpose();
}

}  // namespace

JointSystem::JointSystem(const GroupSystem& group, std::vector<JointBlock> blocks)
    : blocks_(std::move(blocks)), place_(group.contacts.size(), -1) {
  if (blocks_.empty()) return;
  for (const JointBlock& block : blocks_)
    for (const JointBlock::Row& row : block.rows) place_[row.contact] = 0;
  for (std::size_t i = 0; i < place_.size(); ++i)
    if (place_[i] == 0) place_[i] = static_cast<int>(contacts_.size()), contacts_.push_back(i);

  std::vector<int> known(group.rigid.size(), -1);  // by body of the group: of the system, those that are joined only
  std::vector<Mat3> roots;
  for (const JointBlock& block : blocks_)
    for (const int body : {block.a, block.b}) {
      if (body < 0 || known[static_cast<std::size_t>(body)] >= 0) continue;
      known[static_cast<std::size_t>(body)] = static_cast<int>(roots.size());
      roots.push_back(root(group.rigid[static_cast<std::size_t>(body)].inverse_inertia));
    }
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::Index unknowns = 0;
  for (const JointBlock& block : blocks_) {
    begin_.push_back(unknowns);
    for (const bool is_a : {true, false}) {
      const int body = is_a ? block.a : block.b;
      if (body < 0) continue;
      const auto at = static_cast<std::size_t>(body), column = static_cast<std::size_t>(known[at]);
      Rows6 rows(static_cast<Eigen::Index>(block.rows.size()), 6);
      for (std::size_t r = 0; r < block.rows.size(); ++r) {
        const ContactRows& of = group.contacts[block.rows[r].contact];
        const Vec3 d = (is_a ? 1.0 : -1.0) * block.rows[r].direction(of),
                   arm = (is_a ? block.rows[r].at_a(of) : block.rows[r].at_b(of)).arm;
        rows.row(static_cast<Eigen::Index>(r)) << std::sqrt(group.rigid[at].inverse_mass) * d.transpose(),
            (roots[column] * arm.cross(d)).transpose();
      }
      const Rows6 own = block.basis.transpose() * rows;
      for (Eigen::Index r = 0; r < own.rows(); ++r)
        for (Eigen::Index c = 0; c < 6; ++c)
          entries.emplace_back(unknowns + r, 6 * static_cast<Eigen::Index>(column) + c, own(r, c));
    }
    unknowns += block.basis.cols();
  }
  const auto bodies = static_cast<Eigen::Index>(6 * roots.size());
  rows_.resize(unknowns, bodies);
  rows_.setFromTriplets(entries.begin(), entries.end());

  std::vector<Eigen::Triplet<double>> lower;
  for (Eigen::Index i = 0; i < bodies; ++i) lower.emplace_back(i, i, 1.0);
  for (Eigen::Index i = 0; i < unknowns; ++i) lower.emplace_back(bodies + i, bodies + i, -kLoose);
  for (const auto& entry : entries) lower.emplace_back(bodies + entry.row(), entry.col(), entry.value());
  Eigen::SparseMatrix<double> system(bodies + unknowns, bodies + unknowns);
  system.setFromTriplets(lower.begin(), lower.end());
  factors_.compute(system);
}

/// (J Jᵀ + ε)⁻¹ u.
VecX JointSystem::solved(const VecX& u) const {
  VecX both = VecX::Zero(rows_.cols() + rows_.rows());
  both.tail(u.size()) = -u;
  return factors_.solve(both).tail(u.size());
}

std::vector<Vec3> JointSystem::answer(const std::vector<Vec3>& u) const {
  std::vector<Vec3> impulses(contacts_.size(), Vec3::Zero());
  if (blocks_.empty()) return impulses;
  VecX wanted(rows_.rows());
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const JointBlock& block = blocks_[b];
    VecX of_rows(static_cast<Eigen::Index>(block.rows.size()));
    for (std::size_t r = 0; r < block.rows.size(); ++r)
      of_rows[static_cast<Eigen::Index>(r)] =
          -u[static_cast<std::size_t>(place_[block.rows[r].contact])][block.rows[r].k];
    wanted.segment(begin_[b], block.basis.cols()) = block.basis.transpose() * of_rows;
  }
  // what no impulse makes any difference to is 0 after the second time, and not its 1/ε-fold
  const VecX once = solved(wanted), found = solved(rows_ * (rows_.transpose() * once));
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const JointBlock& block = blocks_[b];
    const VecX of_rows = block.basis * found.segment(begin_[b], block.basis.cols());
    for (std::size_t r = 0; r < block.rows.size(); ++r)
      impulses[static_cast<std::size_t>(place_[block.rows[r].contact])][block.rows[r].k] =
          of_rows[static_cast<Eigen::Index>(r)];
  }
  return impulses;
}

}  // namespace impinge
