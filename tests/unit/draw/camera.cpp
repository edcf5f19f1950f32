#include <catch2/catch.hpp>

#include "tests/support/random.hpp"
#include "viewer/draw/camera.hpp"

using namespace impinge;

namespace {

double angle_deg(const Vec3& a, const Vec3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)) * 180.0 / M_PI; }

}  // namespace

TEST_CASE("the target is in the middle of the picture, right is right and up is up") {
  Camera camera;
  camera.look_at({3, 2, 4}, {0, 0.5, 0});
  const Vec3 middle = *camera.project(camera.target, 640, 360);
  CHECK(middle.x() == Approx(320.0));
  CHECK(middle.y() == Approx(180.0));
  CHECK(middle.z() == Approx(camera.distance()));
  const Mat3 axes = camera.view_rotation();
  CHECK((axes * axes.transpose()).isIdentity(1e-12));
  CHECK(axes.determinant() == Approx(1.0));
  CHECK(camera.project(camera.target + 0.1 * axes.row(0).transpose(), 640, 360)->x() > 320.0);
  CHECK(camera.project(camera.target + Vec3(0, 0.1, 0), 640, 360)->y() < 180.0);
  CHECK_FALSE(camera.project(camera.eye + (camera.eye - camera.target), 640, 360));
}

TEST_CASE("the field of view is the vertical angle of the picture") {
  Camera camera;
  camera.look_at({0, 0, 5}, Vec3::Zero());
  camera.fov_deg = 50.0;
  const double half = 5.0 * std::tan(25.0 * M_PI / 180.0);
  CHECK(camera.project({0, half, 0}, 800, 400)->y() == Approx(0.0).margin(1e-9));
  CHECK(camera.project({0, -half, 0}, 800, 400)->y() == Approx(400.0));
  CHECK(camera.pixel_size_at(Vec3::Zero(), 400) == Approx(2.0 * half / 400.0));
  CHECK(camera.pixel_size_at({0, 0, 9}, 400) == 0.0);
}

TEST_CASE("the point at a pixel is seen there") {
  Camera camera;
  camera.look_at({3, 2, 4}, {-0.2, 0.5, 0.1});
  const Vec3 p(0.7, 0.3, -0.4), at = *camera.project(p, 640, 360);
  CHECK((camera.unproject(at.x(), at.y(), at.z(), 640, 360) - p).norm() < 1e-14);
  CHECK((camera.unproject(320, 180, camera.distance(), 640, 360) - camera.target).norm() < 1e-14);
}

TEST_CASE("orbit keeps target and distance and turns by the angles asked for") {
  Camera camera;
  camera.look_at({0, 0, 3}, Vec3::Zero());
  camera.orbit(90.0, 0.0);
  CHECK((camera.eye - Vec3(3, 0, 0)).norm() < 1e-12);  // the eye goes to the right
  camera.orbit(0.0, 30.0);
  CHECK(camera.eye.y() == Approx(1.5));
  CHECK(camera.distance() == Approx(3.0));
  camera.orbit(-90.0, -30.0);
  CHECK((camera.eye - Vec3(0, 0, 3)).norm() < 1e-12);
  camera.orbit(0.0, 500.0);  // stops short of the pole
  CHECK(angle_deg(camera.eye, Vec3::UnitY()) == Approx(1.0).epsilon(1e-6));
  CHECK(camera.view_rotation().allFinite());

  // about another up axis, a full turn in steps comes back
  camera.up = Vec3(1, 2, 0.5);
  camera.look_at({1, 4, -2}, {0.3, 0.1, 0.2});
  const Vec3 before = camera.eye;
  const double height = camera.up.normalized().dot(camera.eye - camera.target);
  for (int i = 0; i < 8; ++i) {
    camera.orbit(45.0, 0.0);
    CHECK(camera.up.normalized().dot(camera.eye - camera.target) == Approx(height));
  }
  CHECK((camera.eye - before).norm() < 1e-9);
}

TEST_CASE("pan shifts the view in its own plane, zoom divides the distance") {
  Camera camera;
  camera.look_at({3, 2, 4}, {0, 0.5, 0});
  const Vec3 old_target = camera.target;
  const Vec3 line = camera.eye - camera.target;
  camera.pan(0.5, -0.25);
  CHECK((camera.eye - camera.target - line).norm() < 1e-12);
  CHECK((camera.target - old_target).dot(line) == Approx(0.0).margin(1e-12));
  CHECK((camera.target - old_target).norm() == Approx(std::hypot(0.5, 0.25)));
  CHECK(camera.project(old_target, 640, 360)->x() < 320.0);
  const double distance = camera.distance();
  camera.zoom(2.0);
  CHECK(camera.distance() == Approx(0.5 * distance));
  CHECK(angle_deg(camera.eye - camera.target, line) < 1e-6);
}

TEST_CASE("fit shows every corner of any box, and not from farther than needed") {
  test::Random random(11);
  for (int i = 0; i < 50; ++i) {
    Aabb box;
    for (int k = 0; k < 2; ++k) box.include(Vec3(random.in(-5, 5), random.in(-5, 5), random.in(-5, 5)));
    Camera camera;
    camera.look_at({random.in(-3, 3), random.in(0.1, 3), 4.0}, Vec3::Zero());
    const double aspect = random.in(0.5, 2.5);
    const Vec3 direction = (camera.eye - camera.target).normalized();
    camera.fit(box, aspect);
    CHECK(angle_deg(camera.eye - camera.target, direction) < 1e-6);
    const int height = 500, width = static_cast<int>(height * aspect);
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 p(corner & 1 ? box.max.x() : box.min.x(), corner & 2 ? box.max.y() : box.min.y(),
                   corner & 4 ? box.max.z() : box.min.z());
      const auto at = camera.project(p, width, height);
      REQUIRE(at);
      CHECK(at->x() >= -1.0);
      CHECK(at->x() <= width + 1.0);
      CHECK(at->y() >= -1.0);
      CHECK(at->y() <= height + 1.0);
    }
    // the sphere about the box touches the narrower pair of the picture's sides
    const double half = 0.5 * camera.fov_deg * M_PI / 180.0;
    const double narrow = std::min(half, std::atan(std::tan(half) * aspect));
    CHECK(camera.distance() * std::sin(narrow) == Approx(0.5 * box.extent().norm()));
  }
  Camera camera;
  const Vec3 eye = camera.eye;
  camera.fit(Aabb{});
  CHECK(camera.eye == eye);
}

TEST_CASE("take_in goes back and across until all points are in the picture, no farther, and not at all if they are") {
  test::Random random(71);
  for (int trial = 0; trial < 200; ++trial) {
    Camera camera;
    camera.look_at(3.0 * random.direction(), 0.5 * random.direction());
    camera.fov_deg = random.in(20.0, 70.0);
    const int width = 640, height = 360;
    const double aspect = static_cast<double>(width) / height;
    std::vector<Vec3> points(1 + static_cast<std::size_t>(trial % 5));
    for (Vec3& x : points) x = std::pow(10.0, random.in(-1.0, 2.0)) * random.direction();
    Camera wide = camera;
    wide.take_in(points, aspect);
    CAPTURE(trial);
    // the same direction, moved by as much as the target
    CHECK(((wide.eye - wide.target) - (camera.eye - camera.target)).norm() < 1e-9 * (1.0 + wide.eye.norm()));
    const double back = camera.view_rotation().row(2).dot(wide.eye - camera.eye);
    CHECK(back >= 0.0);
    const auto holds = [&](const Camera& c, const Vec3& x) {
      const auto at = c.project(x, width, height);
      return at && at->x() >= 0.0 && at->x() <= width && at->y() >= 0.0 && at->y() <= height;
    };
    for (const Vec3& x : points) CHECK(holds(wide, x));
    // what was seen round the target still is
    for (const double u : {0.03, 0.97})
      for (const double v : {0.03, 0.97})
        CHECK(holds(wide, camera.unproject(u * width, v * height, camera.distance(), width, height)));
    // again: nothing to do
    Camera again = wide;
    again.take_in(points, aspect);
    CHECK((again.eye - wide.eye).norm() < 1e-9 * (1.0 + wide.eye.norm()));
    // a tenth of the way less and something is out, or too near to the eye
    if (back > 1e-6) {
      Camera less = wide;
      const Vec3 shift = 0.1 * back * camera.view_rotation().row(2).transpose();
      less.eye -= shift, less.target -= shift;
      Camera more = less;
      more.take_in(points, aspect);
      CHECK((more.eye - less.eye).norm() > 1e-9);
    }
  }
  Camera camera;
  const Camera before = camera;
  camera.take_in(std::vector<Vec3>{camera.target}, 1.5);
  CHECK(camera.eye == before.eye);
  camera.take_in({}, 1.5);
  CHECK(camera.eye == before.eye);
}
