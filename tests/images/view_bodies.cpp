// Pictures in which single bodies are left out, or are followed: held against pictures of scenes made so.
#include <catch2/catch.hpp>

#include "tests/support/pictures/view_scenes.hpp"
#include "viewer/controller/frame_view.hpp"
#include "viewer/layers/layer.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// A slab, a ball on it and a box beside it, with a contact each; `left_out` is not made at all.
void make_bodies(HandMadeRecord& scene, const std::string& left_out = "", const Vec3& shift = Vec3::Zero()) {
  const auto add = [&](const char* name, BodyKind kind, SharedShape shape, const Vec3& at) {
    return name == left_out ? -1 : scene.add(name, kind, std::move(shape), at + shift);
  };
  const int slab = add("slab", BodyKind::fixed, Box{{1.0, 0.1, 1.0}}, {0, -0.1, 0}),
            ball = add("ball", BodyKind::dynamic, Sphere{0.3}, {-0.4, 0.3, 0}),
            box = add("box", BodyKind::dynamic, Box{{0.2, 0.2, 0.2}}, {0.5, 0.2, 0});
  if (ball >= 0) scene.touch(slab, ball, Vec3(-0.4, 0, 0) + shift, Vec3::UnitY(), ContactState::stick);
  if (box >= 0) scene.touch(slab, box, Vec3(0.5, 0, 0) + shift, Vec3::UnitY(), ContactState::slip);
}

}  // namespace

TEST_CASE("a hidden body leaves the picture of a scene without it, but for the contact with what is seen",
          "[methods]") {
  HandMadeRecord whole, without;
  make_bodies(whole);
  make_bodies(without, "box");  // the last: colours go by the order
  ViewSettings settings = settings_with({"meshes", "aabbs", "mass_centers", "labels", "velocities"});
  const Image wanted = painted(without.record(), settings);
  CHECK(painted(whole.record(), settings).rgb != wanted.rgb);
  settings.hidden = {"box"};
  CHECK((painted(whole.record(), settings).rgb == wanted.rgb));

  settings = settings_with({"contacts"});
  const Image both = painted(whole.record(), settings);
  settings.hidden = {"box"};
  CHECK((painted(whole.record(), settings).rgb == both.rgb));
  settings.hidden = {"box", "slab"};
  CHECK((painted(whole.record(), settings).rgb != both.rgb));
}

TEST_CASE("where all is hidden no layer draws anything", "[methods]") {
  for (const StepRecord* record : {&sample_record(), &soft_record()}) {
    ViewSettings settings = settings_with(all_layers());
    for (const BodyRecord& body : record->bodies) settings.hidden.emplace_back(body.name);
    CHECK((painted(*record, settings).rgb == painted(StepRecord{}, settings_with({})).rgb));
  }
}

TEST_CASE("a body that is followed stands still in the picture while the world goes by") {
  HandMadeRecord here, there;
  make_bodies(here);
  make_bodies(there, "", {16.0, 0.5, -8.0});  // sums that are exact
  FrameView view;
  ParameterSet rows;
  view.bind(rows);
  view.settle(here.record(), 320, 180);
  const auto picture = [&](const HandMadeRecord& scene) {
    ViewSettings settings = settings_with({"meshes"});
    settings.camera = view.settings().camera;
    settings.followed = view.settings().followed;
    return painted(scene.record(), settings);
  };
  const Image before = picture(here);
  view.show({BodiesCommand::follow, {"ball"}}, here.record());
  CHECK(view.settings().followed == "ball");
  CHECK((picture(here).rgb == before.rgb));
  CHECK((picture(there).rgb == before.rgb));
  view.show({BodiesCommand::follow, {}}, there.record());  // stays with it where it is now
  CHECK((picture(there).rgb == before.rgb));
  CHECK((picture(here).rgb != before.rgb));
}

TEST_CASE("a body that is framed fills the picture, wherever the camera was and whatever it follows") {
  for (const char* followed : {"", "ball"}) {
    HandMadeRecord scene;
    make_bodies(scene);
    FrameView view;
    ParameterSet rows;
    view.bind(rows);
    view.settle(scene.record(), 320, 180);
    if (*followed != 0) view.show({BodiesCommand::follow, {followed}}, scene.record());
    view.show({BodiesCommand::frame, {"box"}}, scene.record());
    ViewSettings settings = settings_with({"meshes"});
    settings.camera = view.settings().camera;
    settings.followed = view.settings().followed;
    settings.hidden = {"ball", "slab"};
    const Image seen = painted(scene.record(), settings), nothing = painted(StepRecord{}, settings_with({}));
    int top = 180, bottom = -1, left = 320, right = -1;
    for (int y = 0; y < 180; ++y)
      for (int x = 0; x < 320; ++x)
        if (!std::equal(seen.pixel(x, y), seen.pixel(x, y) + 3, nothing.pixel(x, y))) {
          top = std::min(top, y), bottom = std::max(bottom, y);
          left = std::min(left, x), right = std::max(right, x);
        }
    CAPTURE(followed, top, bottom, left, right);
    CHECK(top > 0);
    CHECK(bottom < 179);
    CHECK(bottom - top > 90);      // a cube in a ball that just fits
    if (*followed != 0) continue;  // its camera is told relative to the ball
    const auto middle = settings.camera.project({0.5, 0.2, 0.0}, 320, 180);
    REQUIRE(middle);
    CHECK(middle->x() == Approx(160.0).margin(1.0));
    CHECK(middle->y() == Approx(90.0).margin(1.0));
    Vec2 low = Vec2::Constant(INFINITY), high = Vec2::Constant(-INFINITY);
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 x = Vec3(0.5, 0.2, 0.0) + 0.2 * Vec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
      const auto at = settings.camera.project(x, 320, 180);
      REQUIRE(at);
      low = low.cwiseMin(at->head<2>()), high = high.cwiseMax(at->head<2>());
    }
    CHECK(std::abs(left - low.x()) < 2.0);
    CHECK(std::abs(right - high.x()) < 2.0);
    CHECK(std::abs(top - low.y()) < 2.0);
    CHECK(std::abs(bottom - high.y()) < 2.0);
  }
}
