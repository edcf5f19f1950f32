#include "engine/materials/isotropic.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "engine/geometry/svd3.hpp"

namespace impinge {
namespace {

/// Sets negative eigenvalues to zero. Cheap test first: most elements are far from indefinite.
void project(Mat3& h) {
  const double minor = h(0, 0) * h(1, 1) - h(0, 1) * h(1, 0);
  if (h(0, 0) > 0.0 && minor > 0.0 && h.determinant() > 0.0) return;
  Eigen::SelfAdjointEigenSolver<Mat3> eigen(h);
  h = eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).asDiagonal() * eigen.eigenvectors().transpose();
}

StretchHessian hessian_for(const IsotropicMaterial& material, const Lame& lame, const Vec3& stretch, bool exact) {
  StretchHessian h = material.density_hessian(lame, stretch);
  if (!exact) {
    project(h.principal);
    h.flip = h.flip.cwiseMax(0.0);
    h.twist = h.twist.cwiseMax(0.0);
  }
  return h;
}

}  // namespace

double twist_denominator(double sum) {
  // a thousandth: the force itself has a kink at zero (two stretches of opposite sign change places), so no derivative
  // exists
  constexpr double kSmallest = 1e-3;
  return sum >= 0.0 ? std::max(sum, kSmallest) : std::min(sum, -kSmallest);
}

double IsotropicMaterial::energy(const TetRest& rest, const Corners& x) const {
  return rest.volume * density(lame(rest), rotation_svd(deformation_gradient(rest, x)).sigma);
}

Mat3 IsotropicMaterial::stress(const Mat3& f) const {
  const Svd3 svd = rotation_svd(f);
  return svd.u * density_gradient(lame(), svd.sigma).asDiagonal() * svd.v.transpose();
}

void IsotropicMaterial::force(const TetRest& rest, const Corners& x, ElementResponse& out) const {
  const Svd3 svd = rotation_svd(deformation_gradient(rest, x));
  out.energy = rest.volume * density(lame(rest), svd.sigma);
  const Mat3 p = svd.u * density_gradient(lame(rest), svd.sigma).asDiagonal() * svd.v.transpose();
  out.force.noalias() = -rest.volume * (p * rest.gradient);
}

void IsotropicMaterial::response(const TetRest& rest, const Corners& x, Tangent tangent, ElementResponse& out) const {
  const Svd3 svd = rotation_svd(deformation_gradient(rest, x));
  out.energy = rest.volume * density(lame(rest), svd.sigma);
  const Mat3 p = svd.u * density_gradient(lame(rest), svd.sigma).asDiagonal() * svd.v.transpose();
  out.force.noalias() = -rest.volume * (p * rest.gradient);

  // in the frames of U and V only few entries of ∂P/∂F differ from zero: H_ij couples the diagonal, and each pair
  // couples the entries (i, j) and (j, i): `same` with itself, `cross` with the other
  const StretchHessian h = hessian_for(*this, lame(rest), svd.sigma, wanted(tangent) == Tangent::exact);
  Mat3 same = Mat3::Zero(), cross = Mat3::Zero();
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    same(i, j) = same(j, i) = 0.5 * (h.flip[k] + h.twist[k]);
    cross(i, j) = cross(j, i) = 0.5 * (h.flip[k] - h.twist[k]);
  }
  for (int i = 0; i < 3; ++i) same(i, i) = h.principal(i, i);
  const Corners g = svd.v.transpose() * rest.gradient;
  for (int block = 0; block < 10; ++block) {
    const Vec3 ga = g.col(kBlockRow[block]), gb = g.col(kBlockColumn[block]);
    Mat3 k;
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i)
        k(i, j) = i == j ? same(i, 0) * ga[0] * gb[0] + same(i, 1) * ga[1] * gb[1] + same(i, 2) * ga[2] * gb[2]
                         : ga[i] * h.principal(i, j) * gb[j] + ga[j] * cross(i, j) * gb[i];
    const Mat3 uk = svd.u * k;
    out.stiffness[block].noalias() = rest.volume * (uk * svd.u.transpose());
  }
}

Eigen::Matrix<double, 9, 9> IsotropicMaterial::stress_derivative(const Mat3& f, Tangent tangent) const {
  const Svd3 svd = rotation_svd(f);
  const StretchHessian h = hessian_for(*this, lame(), svd.sigma, wanted(tangent) == Tangent::exact);
  Eigen::Matrix<double, 9, 9> result;
  for (int column = 0; column < 9; ++column) {
    Mat3 df = Mat3::Zero();
    df(column % 3, column / 3) = 1.0;
    const Mat3 d = svd.u.transpose() * df * svd.v;
    Mat3 dp = Mat3::Zero();
    dp.diagonal() = h.principal * d.diagonal();
    for (int k = 0; k < 3; ++k) {
      const int i = (k + 1) % 3, j = (k + 2) % 3;
      const double flip = 0.5 * h.flip[k] * (d(i, j) + d(j, i)), twist = 0.5 * h.twist[k] * (d(i, j) - d(j, i));
      dp(i, j) = flip + twist;
      dp(j, i) = flip - twist;
    }
    const Mat3 full = svd.u * dp * svd.v.transpose();
    result.col(column) = Eigen::Map<const Eigen::Matrix<double, 9, 1>>(full.data());
  }
  return result;
}

}  // namespace impinge
