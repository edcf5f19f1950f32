#include "engine/response/assembled_delassus.hpp"

#include <algorithm>

#include "engine/core/error.hpp"

namespace impinge {
namespace {

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

}  // namespace

AssembledDelassus::AssembledDelassus(const GroupSystem& group) {
  const auto n = static_cast<Eigen::Index>(3 * group.contacts.size());
  w_ = MatX::Zero(n, n);
  lambda_ = VecX::Zero(n);
  add_rigid(group);
  for (int s = 0; s < static_cast<int>(group.soft.size()); ++s) add_soft(group, s);
  w_ = 0.5 * (w_ + MatX(w_.transpose()));
  for (std::size_t i = 0; i < group.contacts.size(); ++i) diagonal_.push_back(w_.block<3, 3>(3 * static_cast<Eigen::Index>(i), 3 * static_cast<Eigen::Index>(i)));
}

void AssembledDelassus::add_rigid(const GroupSystem& group) {
  for (int b = 0; b < static_cast<int>(group.bodies.size()); ++b) {
    const BodyBlock& block = group.bodies[b];
    const std::vector<Part> parts = parts_of(group, [&](const ContactSide& s) { return s.rigid == b; });
    std::vector<Mat3> arms;
    for (const Part& p : parts) {
      Mat3 arm;
      for (int k = 0; k < 3; ++k) arm.row(k) = p.sign * p.side->arm.cross(group.contacts[p.contact].directions.row(k).transpose()).transpose();
      arms.push_back(arm);
    }
    for (std::size_t i = 0; i < parts.size(); ++i)
      for (std::size_t j = 0; j < parts.size(); ++j)
        w_.block<3, 3>(3 * parts[i].contact, 3 * parts[j].contact) +=
            parts[i].sign * parts[j].sign * block.inverse_mass * group.contacts[parts[i].contact].directions *
                group.contacts[parts[j].contact].directions.transpose() +
            arms[i] * block.inverse_inertia * arms[j].transpose();
  }
}

void AssembledDelassus::add_soft(const GroupSystem& group, int body) {
  const SoftBlock& block = group.soft[body];
  const std::vector<Part> parts = parts_of(group, [&](const ContactSide& s) { return s.soft == body && !s.nodes.empty(); });
  if (parts.empty()) return;
  if (block.solver->factorize(*block.a) != SolveStatus::ok)
    throw DivergenceError("the system matrix of a deformable body is not positive definite");
  // right-hand sides in slabs: memory stays at n x 96 however many contacts there are
  constexpr std::size_t kSlab = 32;
  for (std::size_t begin = 0; begin < parts.size(); begin += kSlab) {
    const std::size_t count = std::min(kSlab, parts.size() - begin);
    MatX rhs = MatX::Zero(block.velocity.size(), static_cast<Eigen::Index>(3 * count)), x;
    for (std::size_t j = 0; j < count; ++j) {
      const Part& p = parts[begin + j];
      for (const NodeWeight& n : p.side->nodes)
        rhs.block<3, 3>(3 * n.node, 3 * static_cast<Eigen::Index>(j)) += p.sign * n.weight * group.contacts[p.contact].directions.transpose();
    }
    block.solver->solve_many(rhs, x);
    for (const Part& p : parts)
      for (std::size_t j = 0; j < count; ++j) {
        Mat3 at = Mat3::Zero();
        for (const NodeWeight& n : p.side->nodes) at += n.weight * x.block<3, 3>(3 * n.node, 3 * static_cast<Eigen::Index>(j));
        w_.block<3, 3>(3 * p.contact, 3 * parts[begin + j].contact) += p.sign * group.contacts[p.contact].directions * at;
      }
  }
}

void AssembledDelassus::begin(const std::vector<Vec3>& lambda) {
  for (std::size_t i = 0; i < lambda.size(); ++i) lambda_.segment<3>(3 * static_cast<Eigen::Index>(i)) = lambda[i];
}

Vec3 AssembledDelassus::row(std::size_t i, bool normal_only) const {
  const auto at = static_cast<Eigen::Index>(3 * i);  // W is symmetric: columns lie together in memory, rows do not
  if (normal_only) return {w_.col(at).dot(lambda_), 0.0, 0.0};
  return w_.middleCols<3>(at).transpose() * lambda_;
}

void AssembledDelassus::change(std::size_t i, const Vec3& delta, bool) { lambda_.segment<3>(3 * static_cast<Eigen::Index>(i)) += delta; }

}  // namespace impinge
