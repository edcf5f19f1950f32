#include "engine/response/operators/factored_delassus.hpp"

#include <Eigen/LU>

#include "engine/response/operators/rigid_space.hpp"

namespace impinge {

std::vector<std::vector<Mat3>> inverse_node_blocks(const GroupSystem& group) {
  std::vector<std::vector<Mat3>> inverse(group.deformable.size());
  for (std::size_t s = 0; s < group.deformable.size(); ++s) {
    const BlockMatrix& a = *group.deformable[s].a;
    for (int i = 0; i < a.pattern->rows; ++i) inverse[s].push_back(a.values[a.pattern->diagonal[i]].inverse());
  }
  return inverse;
}

FactoredDelassus::FactoredDelassus(GroupSystem& group, const std::vector<std::vector<Mat3>>* node_inverse)
    : group_(group),
      node_inverse_(node_inverse),
      diagonal_(group.contacts.size(), Mat3::Zero()),
      sides_(group.contacts.size()) {
  group.clear_delta();
  for (std::size_t i = 0; i < group.contacts.size(); ++i) {
    const ContactRows& rows = group.contacts[i];
    const auto add = [&](const ContactSide& side, double sign, RigidSide& out) {
      if (side.rigid >= 0) {
        const RigidBlock& block = group.rigid[side.rigid];
        for (int k = 0; k < 3; ++k)
          out.arm.row(k) = sign * side.arm.cross(rows.directions.row(k).transpose()).transpose();
        out.linear = sign * block.inverse_mass * rows.directions.transpose();
        out.angular = block.inverse_inertia * out.arm.transpose();
        diagonal_[i] += block.inverse_mass * (rows.directions * rows.directions.transpose()) + out.arm * out.angular;
      }
      for (const NodeWeight& n : side.nodes)
        diagonal_[i] += n.weight * n.weight *
                        (rows.directions * (*node_inverse_)[side.deformable][n.node] * rows.directions.transpose());
    };
    add(rows.a, 1.0, sides_[i][0]);
    add(rows.b, -1.0, sides_[i][1]);
  }
}

const BodySpace* FactoredDelassus::body_space() {
  if (!group_.deformable.empty()) return nullptr;
  if (body_space_ == nullptr) body_space_ = std::make_unique<BodySpace>(rigid_space(group_));
  return body_space_.get();
}

void FactoredDelassus::begin(const std::vector<Vec3>& lambda) {
  group_.clear_delta();
  for (std::size_t i = 0; i < lambda.size(); ++i)
    if (!lambda[i].isZero(0.0)) change(i, lambda[i], group_.contacts[i].has_one_row());
}

Vec3 FactoredDelassus::row(std::size_t i, bool normal_only) const {
  const ContactRows& rows = group_.contacts[i];
  Vec3 relative = Vec3::Zero(), turned = Vec3::Zero();
  const auto add = [&](const ContactSide& side, double sign, const RigidSide& rigid) {
    if (side.rigid >= 0) {
      relative += sign * group_.delta_velocity[side.rigid];
      const Vec3& w = group_.delta_angular_velocity[side.rigid];
      if (normal_only)
        turned.x() += rigid.arm.row(0).dot(w);
      else
        turned += rigid.arm * w;
    }
    for (const NodeWeight& n : side.nodes)
      relative += sign * n.weight * group_.deformable_delta[side.deformable].segment<3>(3 * n.node);
  };
  add(rows.a, 1.0, sides_[i][0]);
  add(rows.b, -1.0, sides_[i][1]);
  if (normal_only) return {rows.directions.row(0).dot(relative) + turned.x(), 0.0, 0.0};
  return rows.directions * relative + turned;
}

void FactoredDelassus::change(std::size_t i, const Vec3& delta, bool normal_only) {
  const ContactRows& rows = group_.contacts[i];
  const auto add = [&](const ContactSide& side, double sign, const RigidSide& rigid) {
    if (side.rigid >= 0) {
      if (normal_only) {
        group_.delta_velocity[side.rigid] += rigid.linear.col(0) * delta.x();
        group_.delta_angular_velocity[side.rigid] += rigid.angular.col(0) * delta.x();
      } else {
        group_.delta_velocity[side.rigid] += rigid.linear * delta;
        group_.delta_angular_velocity[side.rigid] += rigid.angular * delta;
      }
    }
    if (side.nodes.empty()) return;
    const Vec3 force =
        normal_only ? Vec3(rows.directions.row(0).transpose() * delta.x()) : Vec3(rows.directions.transpose() * delta);
    for (const NodeWeight& n : side.nodes)
      group_.deformable_delta[side.deformable].segment<3>(3 * n.node) +=
          (*node_inverse_)[side.deformable][n.node] * (sign * n.weight * force);
  };
  add(rows.a, 1.0, sides_[i][0]);
  add(rows.b, -1.0, sides_[i][1]);
}

}  // namespace impinge
