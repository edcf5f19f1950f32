#include "engine/elements/rigid_motions.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace impinge {
namespace {

constexpr double kOnALine = 1e-14;  // of the largest: nodes on a line have no motion about it

/// Columns: an orthonormal basis of a + ω × x; of nodes on a line one column is 0.
template <int N>
Eigen::Matrix<double, 3 * N, 6> rigid_motions(const Eigen::Matrix<double, 3, N>& x) {
  const Eigen::Matrix<double, 3, N> arms = x.colwise() - x.rowwise().mean();
  const Mat3 inertia = arms.squaredNorm() * Mat3::Identity() - arms * arms.transpose();
  const Eigen::SelfAdjointEigenSolver<Mat3> axes(inertia);
  Eigen::Matrix<double, 3 * N, 6> basis = Eigen::Matrix<double, 3 * N, 6>::Zero();
  for (int k = 0; k < 3; ++k) {
    const double about = axes.eigenvalues()[k];
    const Vec3 axis = axes.eigenvectors().col(k);
    for (int a = 0; a < N; ++a) {
      basis(3 * a + k, k) = 1.0 / std::sqrt(static_cast<double>(N));
      if (about > kOnALine * axes.eigenvalues()[2])
        basis.template block<3, 1>(3 * a, 3 + k) = axis.cross(Vec3(arms.col(a))) / std::sqrt(about);
    }
  }
  return basis;
}

}  // namespace

template <int N>
void leave_rigid_motions(const Eigen::Matrix<double, 3, N>& x, ElementAnswer<N>& out) {
  const Eigen::Matrix<double, 3 * N, 6> q = rigid_motions<N>(x);
  Eigen::Matrix<double, 3 * N, 6> kq = Eigen::Matrix<double, 3 * N, 6>::Zero();
  int block = 0;
  for (int a = 0; a < N; ++a)
    for (int b = a; b < N; ++b, ++block) {
      kq.template middleRows<3>(3 * a) += out.stiffness[block] * q.template middleRows<3>(3 * b);
      if (b > a) kq.template middleRows<3>(3 * b) += out.stiffness[block].transpose() * q.template middleRows<3>(3 * a);
    }
  // P K P = K − (K q) qᵀ − q (K q)ᵀ + q (qᵀ K q) qᵀ = K − c qᵀ − q cᵀ with c = K q − q (qᵀ K q)/2
  const Eigen::Matrix<double, 6, 6> qkq = q.transpose() * kq;
  const Eigen::Matrix<double, 3 * N, 6> c = kq - 0.5 * q * qkq;
  block = 0;
  for (int a = 0; a < N; ++a)
    for (int b = a; b < N; ++b, ++block)
      out.stiffness[block] -= c.template middleRows<3>(3 * a) * q.template middleRows<3>(3 * b).transpose() +
                              q.template middleRows<3>(3 * a) * c.template middleRows<3>(3 * b).transpose();
}

template void leave_rigid_motions<4>(const Eigen::Matrix<double, 3, 4>&, ElementAnswer<4>&);
template void leave_rigid_motions<10>(const Eigen::Matrix<double, 3, 10>&, ElementAnswer<10>&);

}  // namespace impinge
