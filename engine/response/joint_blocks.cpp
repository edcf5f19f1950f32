#include "engine/response/joint_blocks.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <map>

namespace impinge {
namespace {

// of W: what rows of a joint hold together no better than this they don't hold
constexpr double kNoHold = 1e-9;

void find_basis(const GroupSystem& group, JointBlock& block) {
  const auto count = static_cast<Eigen::Index>(block.rows.size());
  MatX w = MatX::Zero(count, count);
  for (const bool is_a : {true, false}) {
    const int body = is_a ? block.a : block.b;
    if (body < 0) continue;
    const RigidBlock& of = group.rigid[static_cast<std::size_t>(body)];
    Eigen::Matrix3Xd directions(3, count), moments(3, count);
    for (Eigen::Index r = 0; r < count; ++r) {
      const JointBlock::Row& row = block.rows[static_cast<std::size_t>(r)];
      const ContactRows& contact = group.contacts[row.contact];
      directions.col(r) = row.direction(contact);
      moments.col(r) = (is_a ? row.at_a(contact) : row.at_b(contact)).arm.cross(row.direction(contact));
    }
    w += of.inverse_mass * directions.transpose() * directions + moments.transpose() * (of.inverse_inertia * moments);
  }
  block.basis = basis_of(w);
}

}  // namespace

MatX basis_of(const MatX& w) {
  const Eigen::SelfAdjointEigenSolver<MatX> eigen(w);
  const VecX& values = eigen.eigenvalues();  // they rise
  const Eigen::Index count = values.size();
  Eigen::Index rank = 0;
  while (rank < count && values[count - 1 - rank] > kNoHold * values[count - 1]) ++rank;
  return eigen.eigenvectors().rightCols(rank) * values.tail(rank).cwiseSqrt().cwiseInverse().asDiagonal();
}

std::vector<JointBlock> joint_blocks(const GroupSystem& group) {
  std::vector<JointBlock> blocks;
  std::map<std::pair<int, int>, std::size_t> known;
  for (std::size_t i = 0; i < group.contacts.size(); ++i) {
    const ContactRows& of = group.contacts[i];
    if (of.kind == RowKind::contact || of.a.deformable >= 0 || of.b.deformable >= 0) continue;
    const auto [at, is_new] = known.try_emplace(std::minmax(of.a.rigid, of.b.rigid), blocks.size());
    if (is_new) blocks.push_back({of.a.rigid, of.b.rigid});
    JointBlock& block = blocks[at->second];
    if (of.kind == RowKind::attachment) block.holds_points = true;
    for (int k = 0; k < (of.has_one_row() ? 1 : 3); ++k)
      block.rows.push_back({i, k, of.a.rigid == block.a ? 1.0 : -1.0});
  }
  for (JointBlock& block : blocks) find_basis(group, block);
  return blocks;
}

}  // namespace impinge
