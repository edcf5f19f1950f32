#include "engine/response/operators/assembled_delassus.hpp"

#include <algorithm>

#include "engine/core/interrupt.hpp"
#include "engine/core/parallel.hpp"
#include "engine/response/operators/touched_nodes.hpp"

namespace impinge {
namespace {

constexpr std::size_t kRowsPerTask = 1024;  // of W's product with a vector

/// Which contacts a body takes part in, and on which side.
struct Part {
  int contact;
  const ContactSide* side;
  double sign;
};

template <class Wanted>
std::vector<Part> parts_of(const GroupSystem& group, Wanted wanted) {
  std::vector<Part> parts;
  for (int i = 0; i < static_cast<int>(group.contacts.size()); ++i) {
    if (wanted(group.contacts[i].a)) parts.push_back({i, &group.contacts[i].a, 1.0});
    if (wanted(group.contacts[i].b)) parts.push_back({i, &group.contacts[i].b, -1.0});
  }
  return parts;
}

void add_rigid(const GroupSystem& group, MatX& w) {
  for (int b = 0; b < static_cast<int>(group.rigid.size()); ++b) {
    const RigidBlock& block = group.rigid[b];
    const std::vector<Part> parts = parts_of(group, [&](const ContactSide& s) { return s.rigid == b; });
    std::vector<Mat3> arms;
    for (const Part& p : parts) {
      Mat3 arm;
      for (int k = 0; k < 3; ++k)
        arm.row(k) = p.sign * p.side->arm.cross(group.contacts[p.contact].directions.row(k).transpose()).transpose();
      arms.push_back(arm);
    }
    for (std::size_t i = 0; i < parts.size(); ++i) {
      check_interrupt();
      for (std::size_t j = 0; j < parts.size(); ++j)
        w.block<3, 3>(3 * parts[i].contact, 3 * parts[j].contact) +=
            parts[i].sign * parts[j].sign * block.inverse_mass * group.contacts[parts[i].contact].directions *
                group.contacts[parts[j].contact].directions.transpose() +
            arms[i] * block.inverse_inertia * arms[j].transpose();
    }
  }
}

/// W by columns of J^T: three a contact.
void add_by_contact(const GroupSystem& group, const DeformableBlock& block, const std::vector<Part>& parts, MatX& w) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t j = 0; j < parts.size(); ++j)
    for (const NodeWeight& n : parts[j].side->nodes)
      for (int d = 0; d < 3; ++d)
        for (int k = 0; k < 3; ++k)
          entries.emplace_back(3 * n.node + k, static_cast<int>(3 * j) + d,
                               parts[j].sign * n.weight * group.contacts[parts[j].contact].directions(d, k));
  SparseColumns columns(block.velocity.size(), static_cast<Eigen::Index>(3 * parts.size()));
  columns.setFromTriplets(entries.begin(), entries.end());
  const MatX part = gram_of(block, columns);
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (std::size_t j = 0; j < parts.size(); ++j)
      w.block<3, 3>(3 * parts[i].contact, 3 * parts[j].contact) +=
          part.block<3, 3>(static_cast<Eigen::Index>(3 * i), static_cast<Eigen::Index>(3 * j));
}

/// W by columns of unit impulses: three a touched node, and then J on both sides.
void add_by_node(const GroupSystem& group, const DeformableBlock& block, const std::vector<Part>& parts,
                 const std::vector<int>& nodes, MatX& w) {
  std::vector<int> row(block.velocity.size() / 3, -1);
  for (std::size_t k = 0; k < nodes.size(); ++k) row[nodes[k]] = static_cast<int>(3 * k);
  const MatX inverse = inverse_between(block, nodes);
  const Eigen::Index m = inverse.rows();
  MatX sum(m, 3), column(m, 3);
  for (const Part& p : parts) {
    check_interrupt();
    sum.setZero();
    for (const NodeWeight& n : p.side->nodes) sum += (p.sign * n.weight) * inverse.middleCols<3>(row[n.node]);
    column.noalias() = sum * group.contacts[p.contact].directions.transpose();
    for (const Part& to : parts) {
      Mat3 at = Mat3::Zero();
      for (const NodeWeight& n : to.side->nodes) at += n.weight * column.middleRows<3>(row[n.node]);
      w.block<3, 3>(3 * to.contact, 3 * p.contact) += to.sign * group.contacts[to.contact].directions * at;
    }
  }
}

void add_soft(const GroupSystem& group, int body, const std::vector<int>& nodes, MatX& w) {
  const DeformableBlock& block = group.deformable[body];
  const std::vector<Part> parts =
      parts_of(group, [&](const ContactSide& s) { return s.deformable == body && !s.nodes.empty(); });
  if (parts.empty()) return;
  check_interrupt();
  factorize(block);
  if (nodes.size() < parts.size())
    add_by_node(group, block, parts, nodes, w);
  else
    add_by_contact(group, block, parts, w);
}

std::shared_ptr<const MatX> assemble(const GroupSystem& group) {
  const auto n = static_cast<Eigen::Index>(3 * group.contacts.size());
  MatX w = MatX::Zero(n, n);
  add_rigid(group, w);
  const std::vector<std::vector<int>> nodes = touched_nodes(group);
  for (int s = 0; s < static_cast<int>(group.deformable.size()); ++s) add_soft(group, s, nodes[s], w);
  return std::make_shared<const MatX>(0.5 * (w + MatX(w.transpose())));
}

}  // namespace

AssembledDelassus::AssembledDelassus(GroupSystem& group) {
  if (!group.assembled) group.assembled = assemble(group);
  w_ = group.assembled;
  product_ = VecX::Zero(w_->rows());
  IMPINGE_ASSERT(w_->rows() == static_cast<Eigen::Index>(3 * group.contacts.size()));
  for (Eigen::Index i = 0; i < w_->rows(); i += 3) diagonal_.push_back(w_->block<3, 3>(i, i));
}

void AssembledDelassus::begin(const std::vector<Vec3>& lambda) {
  std::vector<std::size_t> act;  // most contacts that were found carry nothing
  for (std::size_t i = 0; i < lambda.size(); ++i)
    if (!lambda[i].isZero(0.0)) act.push_back(i);
  product_.setZero(w_->rows());
  const auto rows = static_cast<std::size_t>(w_->rows());
  parallel_for((rows + kRowsPerTask - 1) / kRowsPerTask, 1, [&](std::size_t task) {
    const auto first = static_cast<Eigen::Index>(task * kRowsPerTask);
    const Eigen::Index count = std::min<Eigen::Index>(kRowsPerTask, w_->rows() - first);
    for (const std::size_t i : act) add_columns(i, lambda[i], first, count);
  });
}

/// Rows `first` … of W's columns of contact i times x.
void AssembledDelassus::add_columns(std::size_t i, const Vec3& x, Eigen::Index first, Eigen::Index count) {
  const auto columns = w_->block(first, 3 * static_cast<Eigen::Index>(i), count, 3);
  product_.segment(first, count) += columns.col(0) * x.x() + columns.col(1) * x.y() + columns.col(2) * x.z();
}

Vec3 AssembledDelassus::row(std::size_t i, bool normal_only) const {
  const auto at = static_cast<Eigen::Index>(3 * i);
  if (normal_only) return {product_[at], 0.0, 0.0};
  return product_.segment<3>(at);
}

void AssembledDelassus::change(std::size_t i, const Vec3& delta, bool) { add_columns(i, delta, 0, w_->rows()); }

void apply_impulses(GroupSystem& group) {
  group.clear_delta();
  for (std::size_t i = 0; i < group.contacts.size(); ++i) {
    const Vec3 force = group.contacts[i].directions.transpose() * group.lambda[i];
    for (const auto& [side, sign] : {std::pair(&group.contacts[i].a, 1.0), std::pair(&group.contacts[i].b, -1.0)}) {
      if (side->rigid < 0) continue;
      const RigidBlock& block = group.rigid[side->rigid];
      group.delta_velocity[side->rigid] += sign * block.inverse_mass * force;
      group.delta_angular_velocity[side->rigid] += sign * (block.inverse_inertia * side->arm.cross(force));
    }
  }
  for (int s = 0; s < static_cast<int>(group.deformable.size()); ++s)
    group.deformable[s].solver->solve(group.deformable_impulse(s, group.lambda), group.deformable_delta[s]);
}

}  // namespace impinge
