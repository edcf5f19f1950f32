#include <catch2/catch.hpp>

#include "tests/support/random.hpp"
#include "viewer/draw/camera.hpp"

using namespace impinge;
using impinge::test::Random;

namespace {

Camera random_camera(Random& random) {
  Camera camera;
  camera.look_at(5.0 * random.vector(), 2.0 * random.vector());
  camera.fov_deg = random.in(10.0, 100.0);
  return camera;
}

/// The textbook way: look-at and perspective as 4 x 4 matrices, then the viewport. Independent of Camera's own
/// formulas.
Vec3 project_by_matrices(const Camera& camera, const Vec3& point, int width, int height) {
  const Vec3 forward = (camera.target - camera.eye).normalized(), side = forward.cross(camera.up).normalized(),
             upwards = side.cross(forward);
  Eigen::Matrix4d look = Eigen::Matrix4d::Identity();
  look.block<1, 3>(0, 0) = side.transpose();
  look.block<1, 3>(1, 0) = upwards.transpose();
  look.block<1, 3>(2, 0) = -forward.transpose();
  look.block<3, 1>(0, 3) = -look.block<3, 3>(0, 0) * camera.eye;
  const double cotangent = 1.0 / std::tan(0.5 * camera.fov_deg * M_PI / 180.0), near = 0.1, far = 100.0;
  Eigen::Matrix4d perspective = Eigen::Matrix4d::Zero();
  perspective(0, 0) = cotangent * height / width;
  perspective(1, 1) = cotangent;
  perspective(2, 2) = (far + near) / (near - far);
  perspective(2, 3) = 2.0 * far * near / (near - far);
  perspective(3, 2) = -1.0;
  const Eigen::Vector4d clip = perspective * look * point.homogeneous();
  return {(0.5 + 0.5 * clip.x() / clip.w()) * width, (0.5 - 0.5 * clip.y() / clip.w()) * height, clip.w()};
}

}  // namespace

TEST_CASE("a camera's axes are right-handed, orthonormal and look at the target", "[camera]") {
  Random random(101);
  for (int i = 0; i < 200; ++i) {
    const Camera camera = random_camera(random);
    const Mat3 r = camera.view_rotation();
    CHECK((r * r.transpose() - Mat3::Identity()).norm() < 1e-13);
    CHECK(r.determinant() == Approx(1.0).epsilon(1e-12));
    const Vec3 seen = r * (camera.target - camera.eye);
    CHECK(std::hypot(seen.x(), seen.y()) < 1e-12 * camera.distance());
    CHECK(seen.z() == Approx(-camera.distance()));
    CHECK(r.row(1).dot(camera.up.transpose()) >= 0.0);  // the world's up is never upside down
  }
}

TEST_CASE("a camera that looks straight up or down still has axes", "[camera]") {
  for (const double side : {-1.0, 1.0}) {
    Camera camera;
    camera.look_at({0.0, side * 3.0, 0.0}, Vec3::Zero());
    const Mat3 r = camera.view_rotation();
    CHECK((r * r.transpose() - Mat3::Identity()).norm() < 1e-13);
    CHECK((r * (camera.target - camera.eye) - Vec3(0, 0, -3)).norm() < 1e-12);
  }
}

TEST_CASE("projection is that of the textbook matrices", "[camera]") {
  Random random(102);
  int visible = 0, behind = 0;
  for (int i = 0; i < 2000; ++i) {
    const Camera camera = random_camera(random);
    const Vec3 point = 6.0 * random.vector();
    const auto pixel = camera.project(point, 640, 360);
    const Vec3 expected = project_by_matrices(camera, point, 640, 360);
    REQUIRE(pixel.has_value() == (expected.z() > 0.0));
    if (!pixel) {
      ++behind;
      CHECK(camera.pixel_size_at(point, 360) == 0.0);
      continue;
    }
    ++visible;
    CHECK((*pixel - expected).norm() < 1e-9 * (1.0 + expected.norm()));
    // a step of one pixel's size to the side moves the point by one pixel
    const Vec3 aside = point + camera.pixel_size_at(point, 360) * camera.view_rotation().row(0).transpose();
    CHECK((*camera.project(aside, 640, 360) - *pixel - Vec3(1, 0, 0)).norm() < 1e-7 * (1.0 + pixel->norm()));
  }
  CHECK(visible > 100);  // both answers were tried
  CHECK(behind > 100);
}
