#include "engine/response/operators/node_delassus.hpp"

#include "engine/core/interrupt.hpp"
#include "engine/response/operators/rigid_space.hpp"
#include "engine/response/operators/touched_nodes.hpp"

namespace impinge {
namespace {

std::shared_ptr<const std::vector<MatX>> find_between_nodes(const GroupSystem& group,
                                                            const std::vector<std::vector<int>>& nodes) {
  std::vector<MatX> between(nodes.size());
  for (std::size_t s = 0; s < nodes.size(); ++s) {
    check_interrupt();
    if (nodes[s].empty()) continue;
    factorize(group.deformable[s]);
    between[s] = inverse_between(group.deformable[s], nodes[s]);
  }
  return std::make_shared<const std::vector<MatX>>(std::move(between));
}

}  // namespace

NodeDelassus::NodeDelassus(GroupSystem& group, const std::vector<std::vector<int>>& nodes) {
  if (!group.between_nodes) group.between_nodes = find_between_nodes(group, nodes);
  between_nodes_ = group.between_nodes;
  space_.bodies = rigid_space(group);
  find_touches(group, nodes);
  free_ = std::make_unique<InverseMasses>(space_.bodies);
  for (std::size_t i = 0; i < group.contacts.size(); ++i) diagonal_.push_back(block_of(i));
}

void NodeDelassus::find_touches(const GroupSystem& group, const std::vector<std::vector<int>>& nodes) {
  space_.touches.resize(group.contacts.size());
  for (std::size_t i = 0; i < group.contacts.size(); ++i)
    for (int k = 0; k < (group.contacts[i].has_one_row() ? 1 : 3); ++k)
      space_.touches[i].rows.row(k) = group.contacts[i].directions.row(k);
  for (std::size_t s = 0; s < nodes.size(); ++s) {
    if (nodes[s].empty()) continue;
    std::vector<int> place(static_cast<std::size_t>(group.deformable[s].velocity.size() / 3), -1);
    for (std::size_t k = 0; k < nodes[s].size(); ++k) place[nodes[s][k]] = space_.touched + static_cast<int>(k);
    for (std::size_t i = 0; i < group.contacts.size(); ++i)
      for (const auto& [side, sign] : {std::pair(&group.contacts[i].a, 1.0), std::pair(&group.contacts[i].b, -1.0)})
        if (side->deformable == static_cast<int>(s))
          for (const NodeWeight& n : side->nodes) space_.touches[i].nodes.push_back({place[n.node], sign * n.weight});
    space_.parts.push_back({space_.touched, &(*between_nodes_)[s]});
    space_.touched += static_cast<int>(nodes[s].size());
    part_of_.resize(static_cast<std::size_t>(space_.touched), static_cast<int>(space_.parts.size()) - 1);
  }
}

/// J_i K⁻¹ J_iᵀ.
Mat3 NodeDelassus::block_of(std::size_t i) const {
  Mat3 block = Mat3::Zero();
  for (const BodySpace::Side& side : space_.bodies.sides[i]) {
    if (side.body < 0) continue;
    for (int k = 0; k < 3; ++k) {
      const BodySpace::Six v = free_->of(side.body, side.row[k]);
      for (int r = 0; r < 3; ++r) block(r, k) += side.row[r].dot(v);
    }
  }
  const NodeSpace::Touch& touch = space_.touches[i];
  for (const NodeSpace::Touch::Node& row : touch.nodes)
    for (const NodeSpace::Touch::Node& column : touch.nodes) {
      if (part_of_[row.place] != part_of_[column.place]) continue;
      const NodeSpace::Part& part = space_.parts[part_of_[row.place]];
      const Mat3 between = part.inverse->block<3, 3>(3 * (row.place - part.first), 3 * (column.place - part.first));
      block += row.weight * column.weight * (touch.rows * between * touch.rows.transpose());
    }
  return 0.5 * (block + block.transpose());
}

void NodeDelassus::begin(const std::vector<Vec3>& lambda) {
  velocity_ = space_.no_velocities();
  for (std::size_t i = 0; i < lambda.size(); ++i)
    if (!lambda[i].isZero(0.0)) space_.push(i, lambda[i], velocity_);
  space_.free_velocities(*free_, velocity_);
}

Vec3 NodeDelassus::row(std::size_t i, bool normal_only) const {
  const Vec3 u = space_.relative(i, velocity_);
  return normal_only ? Vec3(u.x(), 0.0, 0.0) : u;
}

void NodeDelassus::change(std::size_t i, const Vec3& delta, bool) {
  for (const BodySpace::Side& side : space_.bodies.sides[i]) {
    if (side.body < 0) continue;
    const BodySpace::Six impulse = delta.x() * side.row[0] + delta.y() * side.row[1] + delta.z() * side.row[2];
    velocity_.segment<6>(6 * side.body) += free_->of(side.body, impulse);
  }
  const NodeSpace::Touch& touch = space_.touches[i];
  const Vec3 force = touch.rows.transpose() * delta;
  for (const NodeSpace::Touch::Node& n : touch.nodes) {
    const NodeSpace::Part& part = space_.parts[part_of_[n.place]];
    velocity_.segment(space_.of_bodies() + 3 * part.first, part.inverse->rows()) +=
        part.inverse->middleCols<3>(3 * (n.place - part.first)) * (n.weight * force);
  }
}

}  // namespace impinge
