#include "engine/response/operators/splitting_delassus.hpp"

#include <Eigen/QR>
#include <algorithm>

#include "engine/contact/friction_cone.hpp"
#include "engine/lcp/residual.hpp"

namespace impinge {

SplittingDelassus::SplittingDelassus(GroupSystem& group, const std::vector<NodeInverse>& inverse,
                                     const std::vector<Vec3>& q)
    : group_(group), inverse_(inverse), q_(q), diagonal_(group.contacts.size()) {
  for (const ContactRows& rows : group.contacts)
    sides_.push_back({make_side(rows, rows.a, 1.0), make_side(rows, rows.b, -1.0)});
  prepare();
}

SplittingDelassus::Side SplittingDelassus::make_side(const ContactRows& rows, const ContactSide& from, double sign) {
  Side side;
  side.sign = sign;
  side.rigid = from.rigid;
  side.first = side.last = static_cast<int>(node_.size());
  if (from.rigid >= 0) {
    for (int k = 0; k < 3; ++k) side.arm.row(k) = sign * from.arm.cross(rows.directions.row(k).transpose()).transpose();
    side.angular = group_.rigid[from.rigid].inverse_inertia * side.arm.transpose();
  }
  if (from.nodes.empty()) return side;
  side.deformable = from.deformable;
  for (const NodeWeight& n : from.nodes) node_.push_back({n.node, sign * n.weight});
  side.last = static_cast<int>(node_.size());
  return side;
}

void SplittingDelassus::prepare() {
  for (std::size_t i = 0; i < sides_.size(); ++i) {
    const Mat3& d = group_.contacts[i].directions;
    diagonal_[i].setZero();
    for (Side& side : sides_[i]) {
      if (side.rigid >= 0)
        diagonal_[i] += group_.rigid[side.rigid].inverse_mass * (d * d.transpose()) + side.arm * side.angular;
      if (side.deformable < 0) continue;
      const NodeInverse& q = inverse_[side.deformable];
      Mat3 w = Mat3::Zero();
      for (int k = side.first; k < side.last; ++k) w += node_[k].weight * node_[k].weight * q[node_[k].index];
      diagonal_[i] += d * w * d.transpose();
    }
  }
}

Vec3 SplittingDelassus::velocity(std::size_t i, const std::vector<VecX>& x) const {
  Vec3 relative = Vec3::Zero(), turned = Vec3::Zero();
  for (const Side& side : sides_[i]) {
    if (side.rigid >= 0) {
      relative += side.sign * group_.delta_velocity[side.rigid];
      turned += side.arm * group_.delta_angular_velocity[side.rigid];
    }
    if (side.deformable < 0) continue;
    const double* node = x[side.deformable].data();
    for (int k = side.first; k < side.last; ++k)
      relative += node_[k].weight * Eigen::Map<const Vec3>(node + 3 * node_[k].index);
  }
  return group_.contacts[i].directions * relative + turned + q_[i];
}

void SplittingDelassus::move_rigid(const std::vector<Vec3>& lambda) {
  std::fill(group_.delta_velocity.begin(), group_.delta_velocity.end(), Vec3::Zero());
  std::fill(group_.delta_angular_velocity.begin(), group_.delta_angular_velocity.end(), Vec3::Zero());
  for (std::size_t i = 0; i < sides_.size(); ++i) {
    if (lambda[i].isZero(0.0)) continue;
    for (const Side& side : sides_[i]) {
      if (side.rigid < 0) continue;
      group_.delta_velocity[side.rigid] +=
          side.sign * group_.rigid[side.rigid].inverse_mass * (group_.contacts[i].directions.transpose() * lambda[i]);
      group_.delta_angular_velocity[side.rigid] += side.angular * lambda[i];
    }
  }
}

Vec3 SplittingDelassus::next_impulse(std::size_t i, const Vec3& u, const Vec3& lambda) const {
  const ContactRows& rows = group_.contacts[i];
  const Mat3& w = diagonal_[i];
  switch (rows.kind) {
    case RowKind::attachment:
      return lambda - Vec3(w.completeOrthogonalDecomposition().solve(u));
    case RowKind::sliding:
      return {lambda.x() - u.x() / w(0, 0), 0.0, 0.0};
    case RowKind::contact:
      break;
  }
  if (rows.friction == 0.0) return {std::max(0.0, lambda.x() - u.x() / w(0, 0)), 0.0, 0.0};
  return solve_one_contact(w, u - w * lambda, rows.friction);
}

double SplittingDelassus::sweep(std::vector<Vec3>& lambda, std::vector<VecX>& x) {
  double largest = 0.0;
  for (std::size_t i = 0; i < sides_.size(); ++i) {
    const Vec3 next = next_impulse(i, velocity(i, x), lambda[i]);
    const Vec3 change = next - lambda[i];
    if (change.isZero(0.0)) continue;
    lambda[i] = next;
    largest = std::max(largest, (diagonal_[i] * change).squaredNorm());
    const Vec3 force = group_.contacts[i].directions.transpose() * change;
    for (const Side& side : sides_[i]) {
      if (side.rigid >= 0) {
        group_.delta_velocity[side.rigid] += side.sign * group_.rigid[side.rigid].inverse_mass * force;
        group_.delta_angular_velocity[side.rigid] += side.angular * change;
      }
      if (side.deformable < 0) continue;
      const NodeInverse& q = inverse_[side.deformable];
      double* node = x[side.deformable].data();
      for (int k = side.first; k < side.last; ++k)
        Eigen::Map<Vec3>(node + 3 * node_[k].index) += q[node_[k].index] * (node_[k].weight * force);
    }
  }
  return std::sqrt(largest);
}

double SplittingDelassus::natural_residual(const std::vector<Vec3>& lambda, const std::vector<VecX>& x) const {
  double worst = 0.0;
  for (std::size_t i = 0; i < sides_.size(); ++i)
    worst = std::max(worst, natural_map(group_.contacts[i].kind, diagonal_[i], velocity(i, x), lambda[i],
                                        group_.contacts[i].friction));
  return worst;
}

void SplittingDelassus::impulses(const std::vector<Vec3>& lambda, std::vector<VecX>& f) const {
  for (VecX& v : f) v.setZero();
  for (std::size_t i = 0; i < sides_.size(); ++i) {
    if (lambda[i].isZero(0.0)) continue;
    const Vec3 force = group_.contacts[i].directions.transpose() * lambda[i];
    for (const Side& side : sides_[i])
      for (int k = side.first; k < side.last; ++k)
        f[side.deformable].segment<3>(3 * node_[k].index) += node_[k].weight * force;
  }
}

}  // namespace impinge
