#include "engine/response/group_operator.hpp"

#include <Eigen/LU>
#include <cmath>

namespace impinge {

GroupOperator::GroupOperator(const GroupSystem& group) : group_(group) {
  for (const BodyBlock& body : group.bodies) {
    mass_.push_back(1.0 / body.inverse_mass);
    inertia_.push_back(body.inverse_inertia.inverse());
  }
  size_ = 6 * static_cast<Eigen::Index>(group.bodies.size());
  for (const SoftBlock& block : group.soft) {
    soft_at_.push_back(size_);
    size_ += block.velocity.size();
  }
  plain_ = inverse_blocks({});
}

VecX GroupOperator::multiply(const VecX& x) const {
  VecX y(size_);
  for (std::size_t b = 0; b < mass_.size(); ++b) {
    y.segment<3>(6 * b) = mass_[b] * x.segment<3>(6 * b);
    y.segment<3>(6 * b + 3) = inertia_[b] * x.segment<3>(6 * b + 3);
  }
  for (std::size_t s = 0; s < soft_at_.size(); ++s) {
    const Eigen::Index n = group_.soft[s].velocity.size();
    y.segment(soft_at_[s], n) = *group_.soft[s].a * VecX(x.segment(soft_at_[s], n));
  }
  return y;
}

Vec3 GroupOperator::row(std::size_t i, const VecX& x) const {
  const ContactRows& rows = group_.contacts[i];
  Vec3 relative = Vec3::Zero();
  for (const auto& [side, sign] : {std::pair(&rows.a, 1.0), std::pair(&rows.b, -1.0)}) {
    if (side->rigid >= 0) relative += sign * (x.segment<3>(6 * side->rigid) + Vec3(x.segment<3>(6 * side->rigid + 3)).cross(side->arm));
    for (const NodeWeight& n : side->nodes) relative += sign * n.weight * x.segment<3>(soft_at_[side->soft] + 3 * n.node);
  }
  return rows.directions * relative;
}

void GroupOperator::add_impulse(std::size_t i, const Vec3& lambda, VecX& y) const {
  const ContactRows& rows = group_.contacts[i];
  const Vec3 force = rows.directions.transpose() * lambda;
  for (const auto& [side, sign] : {std::pair(&rows.a, 1.0), std::pair(&rows.b, -1.0)}) {
    if (side->rigid >= 0) {
      y.segment<3>(6 * side->rigid) += sign * force;
      y.segment<3>(6 * side->rigid + 3) += sign * side->arm.cross(force);
    }
    for (const NodeWeight& n : side->nodes) y.segment<3>(soft_at_[side->soft] + 3 * n.node) += sign * n.weight * force;
  }
}

Eigen::Matrix<double, 3, 6> GroupOperator::rigid_row(std::size_t i, const ContactSide& side, double sign) const {
  Eigen::Matrix<double, 3, 6> j;
  for (int k = 0; k < 3; ++k) {
    const Vec3 d = group_.contacts[i].directions.row(k);
    j.row(k) << sign * d.transpose(), sign * side.arm.cross(d).transpose();
  }
  return j;
}

Mat3 GroupOperator::block_mobility(std::size_t i) const {
  const ContactRows& rows = group_.contacts[i];
  Mat3 w = Mat3::Zero();
  for (const ContactSide* side : {&rows.a, &rows.b}) {
    if (side->rigid >= 0) {
      const auto j = rigid_row(i, *side, 1.0);
      w += j * plain_.rigid[side->rigid] * j.transpose();
    }
    for (const NodeWeight& n : side->nodes)
      w += n.weight * n.weight * rows.directions * plain_.node[side->soft][n.node] * rows.directions.transpose();
  }
  return w;
}

GroupOperator::Blocks GroupOperator::inverse_blocks(const std::vector<Mat3>& h) const {
  Blocks blocks;
  for (std::size_t b = 0; b < mass_.size(); ++b) {
    Mat6 m = Mat6::Zero();
    m.diagonal().head<3>().setConstant(mass_[b]);
    m.bottomRightCorner<3, 3>() = inertia_[b];
    blocks.rigid.push_back(m);
  }
  for (const SoftBlock& soft : group_.soft) {
    std::vector<Mat3>& node = blocks.node.emplace_back();
    for (int i = 0; i < soft.a->pattern->rows; ++i) node.push_back(soft.a->values[soft.a->pattern->diagonal[i]]);
  }
  for (std::size_t i = 0; i < h.size(); ++i) {
    const ContactRows& rows = group_.contacts[i];
    for (const auto& [side, sign] : {std::pair(&rows.a, 1.0), std::pair(&rows.b, -1.0)}) {
      if (side->rigid >= 0) {
        const auto j = rigid_row(i, *side, sign);
        blocks.rigid[side->rigid] += j.transpose() * h[i] * j;
      }
      for (const NodeWeight& n : side->nodes) blocks.node[side->soft][n.node] += n.weight * n.weight * rows.directions.transpose() * h[i] * rows.directions;
    }
  }
  for (Mat6& m : blocks.rigid) m = m.inverse().eval();
  for (std::vector<Mat3>& list : blocks.node)
    for (Mat3& m : list) m = m.inverse().eval();
  return blocks;
}

VecX GroupOperator::precondition(const Blocks& inverse, const VecX& r) const {
  VecX z(size_);
  for (std::size_t b = 0; b < inverse.rigid.size(); ++b) z.segment<6>(6 * b) = inverse.rigid[b] * r.segment<6>(6 * b);
  for (std::size_t s = 0; s < inverse.node.size(); ++s)
    for (std::size_t n = 0; n < inverse.node[s].size(); ++n) {
      const Eigen::Index at = soft_at_[s] + 3 * static_cast<Eigen::Index>(n);
      z.segment<3>(at) = inverse.node[s][n] * r.segment<3>(at);
    }
  return z;
}

bool GroupOperator::solve(const std::vector<Mat3>& h, const VecX& b, double tolerance, VecX& x) const {
  const Blocks inverse = h.empty() ? plain_ : inverse_blocks(h);
  const auto product = [&](const VecX& v) {
    VecX y = multiply(v);
    for (std::size_t i = 0; i < h.size(); ++i)
      if (!h[i].isZero(0.0)) add_impulse(i, h[i] * row(i, v), y);
    return y;
  };
  const double goal = tolerance * std::sqrt(dot(b, precondition(inverse, b)));
  VecX r = b - product(x), z = precondition(inverse, r), p = z;
  double rz = dot(r, z);
  for (Eigen::Index k = 0; k < 4 * size_ + 20 && std::sqrt(rz) > goal; ++k) {
    const VecX q = product(p);
    const double curvature = dot(p, q);
    if (!(curvature > 0.0)) return false;
    const double alpha = rz / curvature;
    x += alpha * p;
    r -= alpha * q;
    z = precondition(inverse, r);
    const double next = dot(r, z);
    p = z + (next / rz) * p;
    rz = next;
  }
  return std::sqrt(rz) <= goal;
}

double GroupOperator::norm(const VecX& b) const { return std::sqrt(dot(b, precondition(plain_, b))); }

void GroupOperator::store(const VecX& x, GroupSystem& group) const {
  for (std::size_t b = 0; b < mass_.size(); ++b) {
    group.delta_velocity[b] = x.segment<3>(6 * b);
    group.delta_angular_velocity[b] = x.segment<3>(6 * b + 3);
  }
  for (std::size_t s = 0; s < soft_at_.size(); ++s) group.soft_delta[s] = x.segment(soft_at_[s], group.soft[s].velocity.size());
}

}  // namespace impinge
