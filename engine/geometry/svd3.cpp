// One-sided Jacobi (Hestenes): plane rotations from the right until the columns of F V are orthogonal. Compared with
// the eigenvectors of FᵀF it doesn't square the condition number, so nearly flat elements keep their smallest stretch.
#include "engine/geometry/svd3.hpp"

#include <cmath>
#include <limits>
#include <utility>

namespace impinge {
namespace {

/// Makes columns p and q of b orthogonal; false if they already were, to rounding.
bool rotate_columns(Mat3& b, Mat3& v, int p, int q) {
  const double b0 = b(0, p), b1 = b(1, p), b2 = b(2, p), c0 = b(0, q), c1 = b(1, q), c2 = b(2, q);
  const double alpha = b0 * b0 + b1 * b1 + b2 * b2, beta = c0 * c0 + c1 * c1 + c2 * c2,
               gamma = b0 * c0 + b1 * c1 + b2 * c2;
  if (!(gamma * gamma > 1e-32 * alpha * beta)) return false;
  // tan of the angle is the smaller root of t² + 2 ζ t = 1, ζ = (β − α)/2γ
  const double difference = 0.5 * (beta - alpha);
  const double t = gamma / (difference + std::copysign(std::sqrt(difference * difference + gamma * gamma), difference));
  const double c = 1.0 / std::sqrt(1.0 + t * t), s = c * t;
  b(0, p) = c * b0 - s * c0;
  b(1, p) = c * b1 - s * c1;
  b(2, p) = c * b2 - s * c2;
  b(0, q) = s * b0 + c * c0;
  b(1, q) = s * b1 + c * c1;
  b(2, q) = s * b2 + c * c2;
  for (int i = 0; i < 3; ++i) {
    const double vp = v(i, p), vq = v(i, q);
    v(i, p) = c * vp - s * vq;
    v(i, q) = s * vp + c * vq;
  }
  return true;
}

/// Exchanges two columns and turns one round, which keeps the determinant.
void swap_columns(Mat3& b, Mat3& v, int p, int q) {
  for (Mat3* m : {&b, &v}) {
    const Vec3 mp = m->col(p);
    m->col(p) = m->col(q);
    m->col(q) = -mp;
  }
}

/// A unit vector at right angles to the unit vector n.
Vec3 any_normal_to(const Vec3& n) {
  int axis = 0;
  n.cwiseAbs().minCoeff(&axis);
  return n.cross(Vec3::Unit(axis)).normalized();
}

}  // namespace

Svd3 rotation_svd(const Mat3& f) {
  // the scale keeps squared lengths away from under- and overflow
  const double scale = f.cwiseAbs().maxCoeff();
  Svd3 result{Mat3::Identity(), Vec3::Zero(), Mat3::Identity()};
  if (!(scale > 0.0)) {
    if (scale != 0.0) result.sigma.setConstant(scale);
    return result;
  }
  if (!f.allFinite()) {
    result.sigma.setConstant(std::numeric_limits<double>::quiet_NaN());
    return result;
  }
  Mat3 b = f / scale;
  Mat3& v = result.v;
  // converges quadratically: 3 to 5 sweeps; the bound only guards against rounding that never settles
  for (int sweep = 0; sweep < 20; ++sweep) {
    bool changed = rotate_columns(b, v, 0, 1);
    changed |= rotate_columns(b, v, 0, 2);
    changed |= rotate_columns(b, v, 1, 2);
    if (!changed) break;
  }
  Vec3 length_sq = b.colwise().squaredNorm();
  const auto order = [&](int p, int q) {
    if (length_sq[p] >= length_sq[q]) return;
    swap_columns(b, v, p, q);
    std::swap(length_sq[p], length_sq[q]);
  };
  order(0, 1);
  order(0, 2);
  order(1, 2);
  const double s0 = std::sqrt(length_sq[0]);
  const Vec3 u0 = b.col(0) / s0;
  // below this the second column is rounding of the first, and any direction does
  Vec3 rest = b.col(1) - u0 * u0.dot(b.col(1));
  const double s1 = rest.norm();
  const Vec3 u1 = s1 > 1e-200 ? Vec3(rest / s1) : any_normal_to(u0);
  Vec3 u1_clean = u1 - u0 * u0.dot(u1);
  u1_clean.normalize();
  result.u.col(0) = u0;
  result.u.col(1) = u1_clean;
  result.u.col(2) = u0.cross(u1_clean);
  result.sigma = scale * Vec3(s0, u1_clean.dot(b.col(1)), result.u.col(2).dot(b.col(2)));
  return result;
}

Mat3 nearest_rotation(const Mat3& f) {
  // Newton's iteration for the polar factor [Higham86] is several times cheaper than the singular values and exact
  // to rounding, but only for an F that is neither inverted nor nearly flat.
  const double det = f.determinant();
  const double norm_sq = f.squaredNorm();
  if (det > 1e-3 * norm_sq * std::sqrt(norm_sq)) {
    Mat3 r = f;
    for (int i = 0; i < 12; ++i) {
      Mat3 cofactor;
      cofactor.col(0) = r.col(1).cross(r.col(2));
      cofactor.col(1) = r.col(2).cross(r.col(0));
      cofactor.col(2) = r.col(0).cross(r.col(1));
      const double d = r.col(0).dot(cofactor.col(0));
      // scaling by the determinant speeds up the first steps and is 1 at the limit
      const double gamma = i < 2 ? std::cbrt(1.0 / d) : 1.0;
      const Mat3 next = 0.5 * (gamma * r + cofactor / (gamma * d));
      const double change = (next - r).cwiseAbs().maxCoeff();
      r = next;
      // quadratic: after a change of 1e-9 the next one is below rounding
      if (change < 1e-9) {
        return r;
      }
    }
  }
  const Svd3 svd = rotation_svd(f);
  return svd.u * svd.v.transpose();
}

}  // namespace impinge
