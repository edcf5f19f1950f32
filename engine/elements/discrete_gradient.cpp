#include "engine/elements/discrete_gradient.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace impinge {
namespace {

constexpr double kNoChange = 1e-7;  // |ΔC| with which what is left of the energy is rounding
constexpr double kFlat = 1e-3;      // stretch below which C tells too little

/// V P of the energy at the deformation gradient f, whose corners are Σ f E with the edges E at rest.
Mat3 stress_at(const Material& material, const TetRest& rest, const Mat3& edges, const Mat3& f) {
  Corners x;
  x.col(0).setZero();
  x.rightCols<3>() = f * edges;
  ElementResponse at;
  material.force(rest, x, at);
  return -at.force.rightCols<3>() * edges.transpose();
}

/// c of c · direction, by which `stress` : change comes to do the work that is wanted.
double made_up(double wanted, double done, double squared) { return (wanted - done) / squared; }

}  // namespace

void discrete_gradient(const Material& material, const TetRest& rest, const Corners& x0, const Corners& x1,
                       ElementResponse& out) {
  const Mat3 edges = rest.gradient.rightCols<3>().transpose().inverse();
  const Mat3 f0 = deformation_gradient(rest, x0), f1 = deformation_gradient(rest, x1), middle = 0.5 * (f0 + f1),
             change = f1 - f0;
  const double before = material.energy(rest, x0);
  out.energy = material.energy(rest, x1);
  const double wanted = out.energy - before;
  const Mat3 c0 = f0.transpose() * f0, c1 = f1.transpose() * f1, dc = c1 - c0;
  Mat3 stress;
  const Eigen::SelfAdjointEigenSolver<Mat3> mean(0.5 * (c0 + c1));
  const bool is_right = f0.determinant() > 0.0 && f1.determinant() > 0.0 && middle.determinant() > 0.0 &&
                        mean.eigenvalues().minCoeff() > kFlat * kFlat;
  if (material.is_objective() && is_right) {
    const Vec3 stretch = mean.eigenvalues().cwiseSqrt();
    const Mat3& v = mean.eigenvectors();
    const Mat3 u = v * stretch.asDiagonal() * v.transpose();
    // S = U⁻¹ P(U), symmetric but for rounding
    Mat3 s = v * stretch.cwiseInverse().asDiagonal() * v.transpose() * stress_at(material, rest, edges, u);
    s = 0.5 * (s + s.transpose()).eval();
    const double squared = dc.squaredNorm();
    if (squared > kNoChange * kNoChange) s += 2.0 * made_up(wanted, 0.5 * s.cwiseProduct(dc).sum(), squared) * dc;
    stress = middle * s;
  } else {
    stress = stress_at(material, rest, edges, middle);
    const double squared = change.squaredNorm();
    if (squared > kNoChange * kNoChange) stress += made_up(wanted, stress.cwiseProduct(change).sum(), squared) * change;
  }
  out.force.noalias() = -stress * rest.gradient;
}

}  // namespace impinge
