#include "engine/response/operators/group_operator.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "engine/core/interrupt.hpp"

namespace impinge {

GroupOperator::GroupOperator(const GroupSystem& group) : group_(group) {
  for (const RigidBlock& body : group.rigid) {
    mass_.push_back(1.0 / body.inverse_mass);
    inertia_.push_back(body.inverse_inertia.inverse());
  }
  size_ = 6 * static_cast<Eigen::Index>(group.rigid.size());
  for (const DeformableBlock& block : group.deformable) {
    deformable_at_.push_back(size_);
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
  for (std::size_t s = 0; s < deformable_at_.size(); ++s) {
    const Eigen::Index n = group_.deformable[s].velocity.size();
    y.segment(deformable_at_[s], n) = *group_.deformable[s].a * VecX(x.segment(deformable_at_[s], n));
  }
  return y;
}

Vec3 GroupOperator::row(std::size_t i, const VecX& x) const {
  const ContactRows& rows = group_.contacts[i];
  Vec3 relative = Vec3::Zero();
  for (const auto& [side, sign] : {std::pair(&rows.a, 1.0), std::pair(&rows.b, -1.0)}) {
    if (side->rigid >= 0)
      relative += sign * (x.segment<3>(6 * side->rigid) + Vec3(x.segment<3>(6 * side->rigid + 3)).cross(side->arm));
    for (const NodeWeight& n : side->nodes)
      relative += sign * n.weight * x.segment<3>(deformable_at_[side->deformable] + 3 * n.node);
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
    for (const NodeWeight& n : side->nodes)
      y.segment<3>(deformable_at_[side->deformable] + 3 * n.node) += sign * n.weight * force;
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
      w += n.weight * n.weight * rows.directions * plain_.node[side->deformable][n.node] * rows.directions.transpose();
  }
  return w;
}

std::vector<Mat3> GroupOperator::shared_mobility(const std::vector<char>& act) const {
  std::vector<int> rigid(group_.rigid.size(), 0);
  std::vector<VecX> load, mass;  // by node: sum of weights; kg
  for (const DeformableBlock& soft : group_.deformable) {
    const BlockPattern& p = *soft.a->pattern;
    load.push_back(VecX::Zero(p.rows));
    mass.push_back(VecX::Zero(p.rows));
    for (int i = 0; i < p.rows; ++i)
      for (int k = p.begin[i]; k < p.begin[i + 1]; ++k) mass.back()[i] += soft.a->values[k].trace() / 3.0;
  }
  for (std::size_t i = 0; i < act.size(); ++i)
    for (const ContactSide* side : {&group_.contacts[i].a, &group_.contacts[i].b}) {
      if (!act[i]) continue;
      if (side->rigid >= 0) ++rigid[side->rigid];
      for (const NodeWeight& n : side->nodes) load[side->deformable][n.node] += std::abs(n.weight);
    }
  std::vector<Mat3> shared(group_.contacts.size(), Mat3::Zero());
  for (std::size_t i = 0; i < shared.size(); ++i)
    for (const ContactSide* side : {&group_.contacts[i].a, &group_.contacts[i].b}) {
      if (!act[i]) continue;
      if (side->rigid >= 0) {
        const auto j = rigid_row(i, *side, 1.0);
        shared[i] += rigid[side->rigid] * j * plain_.rigid[side->rigid] * j.transpose();
      }
      for (const NodeWeight& n : side->nodes)
        if (const double m = mass[side->deformable][n.node]; m > 0.0)
          shared[i] += std::abs(n.weight) * load[side->deformable][n.node] / m * Mat3::Identity();
    }
  return shared;
}

double GroupOperator::largest_normal_eigenvalue(const std::vector<char>& act) const {
  constexpr int kSteps = 6;
  std::vector<double> scale(act.size(), 0.0), y(act.size(), 1.0);
  for (std::size_t i = 0; i < act.size(); ++i)
    if (const double w = act[i] ? block_mobility(i)(0, 0) : 0.0; w > 0.0) scale[i] = 1.0 / std::sqrt(w);
  double eigenvalue = 0.0;
  VecX x = VecX::Zero(size_);
  for (int k = 0; k < kSteps; ++k) {
    VecX b = VecX::Zero(size_);
    double before = 0.0, after = 0.0;
    for (std::size_t i = 0; i < act.size(); ++i) {
      if (scale[i] > 0.0) add_impulse(i, Vec3(scale[i] * y[i], 0, 0), b);
      before += scale[i] > 0.0 ? y[i] * y[i] : 0.0;
    }
    if (!(before > 0.0)) return 0.0;
    solve({}, b, 1e-2, x);
    for (std::size_t i = 0; i < act.size(); ++i) {
      y[i] = scale[i] > 0.0 ? scale[i] * row(i, x).x() : 0.0;
      after += y[i] * y[i];
    }
    eigenvalue = std::sqrt(after / before);
    for (double& v : y) v /= std::sqrt(after);
    x /= std::sqrt(after);
  }
  return eigenvalue;
}

GroupOperator::Blocks GroupOperator::inverse_blocks(const std::vector<Mat3>& h) const {
  Blocks blocks;
  for (std::size_t b = 0; b < mass_.size(); ++b) {
    Mat6 m = Mat6::Zero();
    m.diagonal().head<3>().setConstant(mass_[b]);
    m.bottomRightCorner<3, 3>() = inertia_[b];
    blocks.rigid.push_back(m);
  }
  for (const DeformableBlock& soft : group_.deformable) {
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
      for (const NodeWeight& n : side->nodes)
        blocks.node[side->deformable][n.node] +=
            n.weight * n.weight * rows.directions.transpose() * h[i] * rows.directions;
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
      const Eigen::Index at = deformable_at_[s] + 3 * static_cast<Eigen::Index>(n);
      z.segment<3>(at) = inverse.node[s][n] * r.segment<3>(at);
    }
  return z;
}

VecX GroupOperator::multiply_with_springs(const std::vector<Mat3>& h, const VecX& x) const {
  VecX y = multiply(x);
  for (std::size_t i = 0; i < h.size(); ++i)
    if (!h[i].isZero(0.0)) add_impulse(i, h[i] * row(i, x), y);
  return y;
}

bool GroupOperator::solve(const std::vector<Mat3>& h, const VecX& b, double tolerance, VecX& x, int* steps) const {
  const Blocks inverse = h.empty() ? plain_ : inverse_blocks(h);
  const double goal = tolerance * std::sqrt(dot(b, precondition(inverse, b)));
  VecX r = b - multiply_with_springs(h, x), z = precondition(inverse, r), p = z;
  double rz = dot(r, z);
  for (Eigen::Index k = 0; k < 4 * size_ + 20 && std::sqrt(rz) > goal; ++k) {
    check_interrupt();
    if (steps != nullptr) *steps = static_cast<int>(k) + 1;
    const VecX q = multiply_with_springs(h, p);
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

bool GroupOperator::solve_unsymmetric(const std::vector<Mat3>& h, const VecX& b, double tolerance, VecX& x,
                                      int* steps) const {
  const Blocks inverse = inverse_blocks(h);
  const auto times = [&](const VecX& v) { return precondition(inverse, multiply_with_springs(h, v)); };
  const VecX right = precondition(inverse, b);
  const double goal = tolerance * std::sqrt(dot(right, right));
  VecX r = right - times(x);
  const VecX shadow = r;
  VecX p = r;
  double rho = dot(shadow, r), size = std::sqrt(dot(r, r));
  for (Eigen::Index k = 0; k < 2 * size_ + 20 && size > goal; ++k) {
    check_interrupt();
    if (steps != nullptr) *steps = static_cast<int>(k) + 1;
    const VecX v = times(p);
    const double along = dot(shadow, v);
    if (along == 0.0) return false;
    const double alpha = rho / along;
    r -= alpha * v;
    const VecX t = times(r);
    const double t_t = dot(t, t), omega = t_t > 0.0 ? dot(t, r) / t_t : 0.0;
    x += alpha * p + omega * r;
    r -= omega * t;
    size = std::sqrt(dot(r, r));
    const double next = dot(shadow, r);
    if (!std::isfinite(size) || omega == 0.0 || rho == 0.0) return size <= goal;
    p = r + (next / rho * alpha / omega) * (p - omega * v);
    rho = next;
  }
  return size <= goal;
}

double GroupOperator::velocity_of(const VecX& b) const {
  const VecX v = precondition(plain_, b);
  double largest = 0.0;
  for (Eigen::Index i = 0; i + 3 <= v.size(); i += 3) largest = std::max(largest, v.segment<3>(i).norm());
  return largest;
}

double GroupOperator::norm(const VecX& b) const { return std::sqrt(dot(b, precondition(plain_, b))); }

VecX GroupOperator::load(const GroupSystem& group) const {
  VecX x(size_);
  for (std::size_t b = 0; b < mass_.size(); ++b) {
    x.segment<3>(6 * b) = group.delta_velocity[b];
    x.segment<3>(6 * b + 3) = group.delta_angular_velocity[b];
  }
  for (std::size_t s = 0; s < deformable_at_.size(); ++s)
    x.segment(deformable_at_[s], group.deformable_delta[s].size()) = group.deformable_delta[s];
  return x;
}

void GroupOperator::store(const VecX& x, GroupSystem& group) const {
  for (std::size_t b = 0; b < mass_.size(); ++b) {
    group.delta_velocity[b] = x.segment<3>(6 * b);
    group.delta_angular_velocity[b] = x.segment<3>(6 * b + 3);
  }
  for (std::size_t s = 0; s < deformable_at_.size(); ++s)
    group.deformable_delta[s] = x.segment(deformable_at_[s], group.deformable[s].velocity.size());
}

}  // namespace impinge
