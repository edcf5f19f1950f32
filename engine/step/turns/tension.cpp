#include "engine/step/turns/tension.hpp"

#include <Eigen/Eigenvalues>

namespace impinge {
namespace {

/// (ω Δt)² of a swing that is followed; a symplectic step comes apart at 4.
constexpr double kMost = 1.0;

/// Of an impulse p that pulls outwards at an arm r, N·m·s: what turns about other axes than the arm move it against.
Mat3 stiffness(const Vec3& p, const Vec3& r) {
  const double outwards = p.dot(r), length = r.norm();
  if (!(outwards > 0.0 && length > 0.0)) return Mat3::Zero();
  const Vec3 along = r / length;
  return outwards * (Mat3::Identity() - along * along.transpose());
}

}  // namespace

std::vector<SlowedBody> slow_taut_bodies(GroupSystem& system, double time_step) {
  std::vector<Mat3> taut(system.rigid.size(), Mat3::Zero());
  for (std::size_t i = 0; i < system.contacts.size(); ++i) {
    const ContactRows& row = system.contacts[i];
    if (system.lambda[i].isZero(0.0) || row.kind == RowKind::sliding) continue;
    Vec3 on_a = row.directions.transpose() * system.lambda[i];
    if (row.kind == RowKind::contact) on_a = system.lambda[i].x() * row.directions.row(0).transpose();
    if (row.a.rigid >= 0) taut[static_cast<std::size_t>(row.a.rigid)] += time_step * stiffness(on_a, row.a.arm);
    if (row.b.rigid >= 0) taut[static_cast<std::size_t>(row.b.rigid)] += time_step * stiffness(-on_a, row.b.arm);
  }
  std::vector<SlowedBody> slowed;
  for (std::size_t b = 0; b < taut.size(); ++b) {
    Mat3& inverse = system.rigid[b].inverse_inertia;
    if (!((inverse * taut[b]).norm() > kMost)) continue;  // an upper bound of the eigenvalues
    const Eigen::SelfAdjointEigenSolver<Mat3> own(inverse);
    const Mat3 root =
        own.eigenvectors() * own.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal() * own.eigenvectors().transpose();
    const Eigen::SelfAdjointEigenSolver<Mat3> swings(root * taut[b] * root);
    if (!(swings.eigenvalues().maxCoeff() > kMost)) continue;
    const Vec3 share = (swings.eigenvalues() / kMost).cwiseMax(1.0).cwiseInverse();
    const Mat3 across = root * swings.eigenvectors();
    slowed.push_back({b, inverse});
    inverse = across * share.asDiagonal() * across.transpose();
  }
  return slowed;
}

}  // namespace impinge
