// Where a floor is to be seen, against rays, and what an automatic camera that goes along with a body looks at.
#include <catch2/catch.hpp>

#include "tests/support/pictures/hand_made_record.hpp"
#include "tests/support/pictures/view_scenes.hpp"
#include "viewer/image/id_image.hpp"
#include "viewer/layers/layer.hpp"
#include "viewer/layers/view_bodies.hpp"
#include "viewer/present/frame_painter.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

constexpr int kAcross = 160, kDown = 90;

bool is_floor(const IdImage& ids, double x, double y) {
  const IdObject* object = ids.object_at(static_cast<int>(x), static_cast<int>(y));
  return object != nullptr && object->body == "floor";
}

}  // namespace

TEST_CASE("a floor begins at the picture's lower border however low the eye") {
  HandMadeRecord scene;
  scene.add("floor", BodyKind::fixed, Plane{Vec3::UnitY(), 0.0}, Vec3::Zero());
  scene.add("block", BodyKind::dynamic, Box{Vec3::Constant(0.5)}, {0.0, 0.5, 0.0});
  FramePainter painter(kAcross, kDown);
  Image image;
  IdImage ids;
  for (const double distance : {1.5, 4.0, 20.0, 400.0})
    for (const double height : {0.03, 0.1, 0.15, 0.3, 1.0}) {
      ViewSettings settings = settings_with({"meshes"});
      settings.camera.look_at({0.0, height * distance, distance}, {0.0, 0.5, 0.0});
      settings.camera_given = true;
      painter.paint(scene.record(), settings, image, ids);
      CAPTURE(distance, height);
      const Vec3 x = settings.camera.unproject(0.5 * kAcross, kDown, 1.0, kAcross, kDown) - settings.camera.eye;
      if (x.y() >= 0.0) continue;  // nothing of it is in the picture
      int missing = 0;
      for (int column = 0; column < kAcross; ++column) {
        const IdObject* object = ids.object_at(column, kDown - 1);
        missing += object == nullptr;
      }
      CHECK(missing == 0);
    }
}

TEST_CASE("what rolled away still lies on a floor, in whatever picture it is") {
  FramePainter painter(kAcross, kDown);
  Image image;
  IdImage ids;
  for (const double way : {1.0, 3.0, 10.0, 40.0, 300.0})
    for (const Vec3& direction : {Vec3(Vec3::UnitX()), Vec3(-Vec3::UnitZ()), Vec3(0.6, 0.0, 0.8)}) {
      HandMadeRecord scene;
      scene.add("floor", BodyKind::fixed, Plane{Vec3::UnitY(), 0.0}, Vec3::Zero());
      const double radius = 0.2 + 0.05 * way;
      scene.add("ball", BodyKind::dynamic, Sphere{radius}, way * direction + radius * Vec3::UnitY());
      ViewSettings settings = settings_with({"meshes"});
      settings.camera.look_at({0.5, 0.7, 1.0}, {0.0, 0.2, 0.0});
      settings.camera_given = true;
      settings.camera_fit = CameraFit::all;
      painter.paint(scene.record(), settings, image, ids);
      const Camera camera = camera_of_picture(scene.record(), settings, static_cast<double>(kAcross) / kDown);
      CAPTURE(way, direction.transpose());
      // round the ball, on the floor, wherever that is in the picture and the ball is not before it
      int looked_at = 0, missing = 0;
      for (int i = 0; i < 12; ++i) {
        const double angle = i * M_PI / 6.0;
        const Vec3 x = way * direction + 1.5 * radius * Vec3(std::cos(angle), 0.0, std::sin(angle));
        const auto at = camera.project(x, kAcross, kDown);
        if (!at || at->x() < 1 || at->y() < 1 || at->x() > kAcross - 1 || at->y() > kDown - 1) continue;
        ++looked_at;
        missing += ids.object_at(static_cast<int>(at->x()), static_cast<int>(at->y())) == nullptr;
      }
      CHECK(looked_at > 2);
      CHECK(missing == 0);
    }
}

TEST_CASE("a floor far below a body that is followed is in the picture") {
  FramePainter painter(kAcross, kDown);
  Image image;
  IdImage ids;
  for (const double height : {1.0, 5.0, 20.0, 100.0}) {
    HandMadeRecord scene;
    scene.add("floor", BodyKind::fixed, Plane{Vec3::UnitY(), 0.0}, Vec3::Zero());
    scene.add("other", BodyKind::dynamic, Box{Vec3::Constant(0.5)}, {7.0, 0.5, 0.0});
    scene.add("crate", BodyKind::dynamic, Box{Vec3(0.5, 0.25, 0.5)}, {0.0, height, 0.0});
    ViewSettings settings = settings_with({"meshes"});
    settings.followed = "crate";
    settings.camera_given = false;
    settle_camera(settings, scene.record(), static_cast<double>(kAcross) / kDown);
    const Camera camera = camera_in_world(scene.record(), settings);
    const auto at = camera.project({0.0, height, 0.0}, kAcross, kDown);
    CAPTURE(height);
    REQUIRE(at);
    CHECK(at->x() == Approx(0.5 * kAcross));
    CHECK(at->y() == Approx(0.5 * kDown));
    painter.paint(scene.record(), settings, image, ids);
    const IdObject* middle = ids.object_at(kAcross / 2, kDown / 2);
    REQUIRE(middle != nullptr);
    CHECK(middle->body == "crate");
    CHECK(is_floor(ids, 0.5 * kAcross, kDown - 1));
  }
}
