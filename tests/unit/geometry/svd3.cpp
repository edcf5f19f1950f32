#include "engine/geometry/svd3.hpp"

#include <catch2/catch.hpp>
#include <limits>

#include "tests/support/random.hpp"

using namespace impinge;

namespace {

void check_svd(const Mat3& f) {
  const Svd3 svd = rotation_svd(f);
  const double scale = f.norm();
  CAPTURE(f, svd.sigma.transpose());
  CHECK((svd.u * svd.sigma.asDiagonal() * svd.v.transpose() - f).norm() <= 4e-15 * scale);
  for (const Mat3& r : {svd.u, svd.v}) {
    CHECK((r.transpose() * r - Mat3::Identity()).norm() < 4e-15);
    CHECK(r.determinant() == Approx(1.0).margin(1e-14));
  }
  // in order, to rounding
  CHECK(svd.sigma[0] >= svd.sigma[1] - 1e-15 * scale);
  CHECK(svd.sigma[1] >= std::abs(svd.sigma[2]) - 1e-15 * scale);
}

}  // namespace

TEST_CASE("singular values of random, degenerate and inverted matrices") {
  test::Random random(11);
  for (int i = 0; i < 500; ++i) {
    Mat3 f;
    for (int k = 0; k < 9; ++k) f(k % 3, k / 3) = random.sym();
    check_svd(f);
    check_svd(f * std::pow(10.0, random.in(-150, 150)));
    const Mat3 u = random.rotation(), v = random.rotation();
    for (const Vec3& s : {Vec3(1, 1, 1), Vec3(1, 1, -1), Vec3(2, 1, 0), Vec3(1, 0, 0), Vec3(1, 1e-9, -1e-12),
                          Vec3(3, 3, 1e-30), Vec3(2, 1, -1)}) {
      check_svd(u * s.asDiagonal() * v.transpose());
      const Svd3 svd = rotation_svd(u * s.asDiagonal() * v.transpose());
      CHECK((svd.sigma - s).norm() < 1e-14 * s.norm());
    }
  }
  check_svd(Mat3::Zero());
  check_svd(Mat3::Identity());
  check_svd(-Mat3::Identity());
}

TEST_CASE("a small singular value of a scaled matrix keeps its relative accuracy") {
  // columns of very different length: squaring F would lose the smallest entirely
  test::Random random(12);
  for (int i = 0; i < 100; ++i) {
    const Mat3 u = random.rotation();
    const Vec3 s(1.0, 1e-7, 1e-13);
    CHECK(rotation_svd(u * s.asDiagonal()).sigma[2] == Approx(1e-13).epsilon(1e-12));
  }
}

TEST_CASE("a matrix that is not finite gives no loop and no finite answer") {
  Mat3 f = Mat3::Identity();
  f(1, 2) = std::numeric_limits<double>::quiet_NaN();
  CHECK(std::isnan(rotation_svd(f).sigma[0]));
  CHECK_FALSE(nearest_rotation(f).determinant() > 2.0);
}

TEST_CASE("the nearest rotation is one, beats others, and agrees between both routes") {
  test::Random random(13);
  for (int i = 0; i < 500; ++i) {
    Mat3 f;
    for (int k = 0; k < 9; ++k) f(k % 3, k / 3) = random.sym();
    const Mat3 r = nearest_rotation(f);
    CHECK((r.transpose() * r - Mat3::Identity()).norm() < 1e-14);
    CHECK(r.determinant() == Approx(1.0));
    const Svd3 svd = rotation_svd(f);
    // 1e-3 is where the cheap route hands over; its error there is the condition of the problem
    CHECK((r - svd.u * svd.v.transpose()).norm() < 1e-11);
    for (int k = 0; k < 20; ++k) {
      const Mat3 other = r * Eigen::AngleAxisd(0.2 * random.sym(), random.direction()).toRotationMatrix();
      CHECK((f - other).norm() >= (f - r).norm() - 1e-14);
    }
  }
}
