#include "engine/response/operators/delassus_by_contact.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "engine/contact/mobility.hpp"
#include "engine/core/error.hpp"
#include "engine/core/finite.hpp"
#include "engine/core/interrupt.hpp"
#include "engine/lcp/residual.hpp"

namespace impinge {
DelassusByContact::DelassusByContact(GroupSystem& group)
    : group_(group),
      node_inverse_(group.deformable.size()),
      coupled_(group.deformable.size()),
      place_(group.contacts.size(), {-1, -1}),
      coupled_velocity_(group.contacts.size(), Vec3::Zero()),
      diagonal_(group.contacts.size(), Mat3::Zero()),
      split_(group.contacts.size(), Mat3::Zero()) {
  group_.clear_delta();
  std::vector<int> rigid_contacts(group.rigid.size(), 0);
  std::vector<std::vector<int>> node_contacts(group.deformable.size());
  for (std::size_t s = 0; s < group.deformable.size(); ++s) {
    if (!group.deformable[s].is_diagonal) continue;
    const BlockMatrix& a = *group.deformable[s].a;
    for (int i = 0; i < a.pattern->rows; ++i) node_inverse_[s].push_back(a.values[a.pattern->diagonal[i]].inverse());
    node_contacts[s].assign(a.pattern->rows, 0);
  }
  for (std::size_t i = 0; i < group.contacts.size(); ++i) {
    const std::array<const ContactSide*, 2> sides{&group.contacts[i].a, &group.contacts[i].b};
    for (int k = 0; k < 2; ++k) {
      if (sides[k]->rigid >= 0) ++rigid_contacts[sides[k]->rigid];
      if (sides[k]->nodes.empty()) continue;
      if (group.deformable[sides[k]->deformable].is_diagonal) {
        for (const NodeWeight& n : sides[k]->nodes) ++node_contacts[sides[k]->deformable][n.node];
      } else {
        std::vector<std::size_t>& list = coupled_[sides[k]->deformable].contacts;
        place_[i][k] = static_cast<int>(list.size());
        list.push_back(i);
      }
    }
  }
  for (std::size_t i = 0; i < group.contacts.size(); ++i) {
    const ContactRows& rows = group.contacts[i];
    for (const ContactSide* side : {&rows.a, &rows.b}) {
      if (side->rigid >= 0) {
        const Mat3 w = mobility(group.rigid[side->rigid], rows.directions, side->arm);
        diagonal_[i] += w;
        split_[i] += rigid_contacts[side->rigid] * w;
      }
      if (side->nodes.empty() || !group.deformable[side->deformable].is_diagonal) continue;
      for (const NodeWeight& n : side->nodes) {
        const Mat3 w = n.weight * n.weight * rows.directions * node_inverse_[side->deformable][n.node] *
                       rows.directions.transpose();
        diagonal_[i] += w;
        split_[i] += node_contacts[side->deformable][n.node] * w;
      }
    }
  }
  for (int s = 0; s < static_cast<int>(group.deformable.size()); ++s)
    if (!coupled_[s].contacts.empty()) add_coupled(s);
  for (std::size_t i = 0; i < group.contacts.size(); ++i)
    if (!group.lambda[i].isZero(0.0)) add_impulse(i, group.lambda[i]);
}

void DelassusByContact::add_coupled(int s) {
  const DeformableBlock& block = group_.deformable[s];
  Coupled& coupled = coupled_[s];
  const int m = static_cast<int>(coupled.contacts.size());
  std::vector<Eigen::Triplet<double>> entries;
  for (int c = 0; c < m; ++c) {
    const ContactRows& rows = group_.contacts[coupled.contacts[c]];
    for (const auto& [side, sign] : {std::pair(&rows.a, 1.0), std::pair(&rows.b, -1.0)}) {
      if (side->deformable != s) continue;
      for (const NodeWeight& n : side->nodes)
        for (int r = 0; r < 3; ++r)
          for (int k = 0; k < 3; ++k)
            entries.emplace_back(3 * n.node + k, 3 * c + r, sign * n.weight * rows.directions(r, k));
    }
  }
  SparseColumns columns(block.velocity.size(), 3 * m);
  columns.setFromTriplets(entries.begin(), entries.end());
  check_interrupt();
  if (block.solver->factorize(*block.a) != SolveStatus::ok ||
      block.solver->gram(columns, coupled.w).status != SolveStatus::ok)
    throw DivergenceError("the system matrix of a deformable body is not positive definite");
  for (int c = 0; c < m; ++c) {
    check_interrupt();
    const Mat3 own = coupled.w.block<3, 3>(3 * c, 3 * c);
    double others = 0.0;
    for (int d = 0; d < m; ++d)
      if (d != c) others += coupled.w.block<3, 3>(3 * c, 3 * d).norm();
    diagonal_[coupled.contacts[c]] += own;
    split_[coupled.contacts[c]] += own + others * Mat3::Identity();
  }
}

Vec3 DelassusByContact::velocity(std::size_t i) const {
  return group_.contact_velocity(i, true) + coupled_velocity_[i];
}

Mat3 DelassusByContact::between(std::size_t i, std::size_t j) const {
  const ContactRows &of = group_.contacts[i], &other = group_.contacts[j];
  const auto cross = [](const Vec3& arm, const Mat3& rows) {
    Mat3 turns;
    for (int k = 0; k < 3; ++k) turns.row(k) = arm.cross(rows.row(k).transpose()).transpose();
    return turns;
  };
  Mat3 w = Mat3::Zero();
  for (int k = 0; k < 2; ++k)
    for (int l = 0; l < 2; ++l) {
      const ContactSide &side = k == 0 ? of.a : of.b, &at = l == 0 ? other.a : other.b;
      const double sign = k == l ? 1.0 : -1.0;
      if (side.rigid >= 0 && side.rigid == at.rigid) {
        const RigidBlock& block = group_.rigid[static_cast<std::size_t>(side.rigid)];
        w += sign *
             (block.inverse_mass * of.directions * other.directions.transpose() +
              cross(side.arm, of.directions) * block.inverse_inertia * cross(at.arm, other.directions).transpose());
      }
      if (side.nodes.empty() || at.nodes.empty() || side.deformable != at.deformable) continue;
      if (place_[i][k] >= 0) {  // signs are in it
        w += coupled_[side.deformable].w.block<3, 3>(3 * place_[i][k], 3 * place_[j][l]);
        continue;
      }
      for (const NodeWeight& n : side.nodes)
        for (const NodeWeight& m : at.nodes)
          if (n.node == m.node)
            w += sign * n.weight * m.weight * of.directions * node_inverse_[side.deformable][n.node] *
                 other.directions.transpose();
    }
  return w;
}

double DelassusByContact::natural_residual(std::span<const double> bound, std::span<const double> impact) const {
  double worst = 0.0;
  for (std::size_t i = 0; i < group_.contacts.size(); ++i) {
    if ((!impact.empty() && impact[i] != 0.0) || !(diagonal_[i](0, 0) > 0.0)) continue;
    const ContactRows& rows = group_.contacts[i];
    Vec3 u = velocity(i);
    u.x() -= bound[i];
    worst = larger(worst, natural_map(rows.kind, diagonal_[i], u, group_.lambda[i], rows.friction));
  }
  return worst;
}

void DelassusByContact::add_impulse(std::size_t i, const Vec3& delta) {
  const ContactRows& rows = group_.contacts[i];
  const Vec3 force = rows.directions.transpose() * delta;
  const std::array<const ContactSide*, 2> sides{&rows.a, &rows.b};
  for (int k = 0; k < 2; ++k) {
    const ContactSide& side = *sides[k];
    const double sign = k == 0 ? 1.0 : -1.0;
    if (side.rigid >= 0) {
      const RigidBlock& block = group_.rigid[side.rigid];
      group_.delta_velocity[side.rigid] += sign * block.inverse_mass * force;
      group_.delta_angular_velocity[side.rigid] += sign * (block.inverse_inertia * side.arm.cross(force));
    }
    if (side.nodes.empty()) continue;
    if (place_[i][k] < 0) {
      for (const NodeWeight& n : side.nodes)
        group_.deformable_delta[side.deformable].segment<3>(3 * n.node) +=
            node_inverse_[side.deformable][n.node] * (sign * n.weight * force);
    } else {
      const Coupled& coupled = coupled_[side.deformable];
      for (std::size_t c = 0; c < coupled.contacts.size(); ++c)
        coupled_velocity_[coupled.contacts[c]] += coupled.w.block<3, 3>(3 * c, 3 * place_[i][k]) * delta;
    }
  }
}

void DelassusByContact::change(std::size_t i, const Vec3& delta) {
  group_.lambda[i] += delta;
  add_impulse(i, delta);
}

void DelassusByContact::show(const std::function<void(const GroupSystem&)>& observe) {
  if (!observe) return;
  finish();
  observe(group_);
  for (std::size_t s = 0; s < coupled_.size(); ++s)
    // while impulses change, coupled_velocity_ says it
    if (!coupled_[s].contacts.empty()) group_.deformable_delta[s].setZero();
}

bool DelassusByContact::finish() {
  group_.clear_delta();
  std::fill(coupled_velocity_.begin(), coupled_velocity_.end(), Vec3::Zero());
  for (std::size_t i = 0; i < group_.contacts.size(); ++i)
    if (!group_.lambda[i].isZero(0.0)) add_impulse(i, group_.lambda[i]);
  for (int s = 0; s < static_cast<int>(group_.deformable.size()); ++s) {
    if (coupled_[s].contacts.empty() || !solved_) continue;
    solved_ = group_.deformable[s]
                  .solver->solve(group_.deformable_impulse(s, group_.lambda), group_.deformable_delta[s])
                  .status == SolveStatus::ok;
  }
  return solved_;
}

void relax_friction(const Mat3& mobility, const Vec3& u, double friction, Vec3& lambda) {
  // the largest eigenvalue of the tangential block: one factor for both directions, or the disc's projection would turn
  // slip
  const double mean = 0.5 * (mobility(1, 1) + mobility(2, 2)), half = 0.5 * (mobility(1, 1) - mobility(2, 2));
  const double largest = mean + std::hypot(half, mobility(1, 2));
  if (!(largest > 0.0)) return;
  Vec2 t = lambda.tail<2>() - u.tail<2>() / largest;
  const double size = t.norm(), limit = friction * lambda.x();
  if (size > limit) t *= limit / size;
  lambda.tail<2>() = t;
}

Vec3 relaxed_impulse(const ContactRows& rows, const Mat3& mobility, Vec3 u, Vec3 lambda) {
  if (rows.kind == RowKind::attachment) return lambda - mobility.ldlt().solve(u);
  if (!(mobility(0, 0) > 0.0)) return lambda;
  const double before = lambda.x();
  lambda.x() -= u.x() / mobility(0, 0);
  if (rows.kind == RowKind::sliding) return lambda;
  lambda.x() = std::max(0.0, lambda.x());
  if (rows.has_one_row()) return lambda;
  u += mobility.col(0) * (lambda.x() - before);
  relax_friction(mobility, u, rows.friction, lambda);
  return lambda;
}

}  // namespace impinge
