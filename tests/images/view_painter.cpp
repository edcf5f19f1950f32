#include <catch2/catch.hpp>

#include "tests/support/pictures/view_scenes.hpp"
#include "viewer/layers/layer.hpp"
#include "viewer/present/frame_painter.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

Image paint_with(FramePainter& painter, const StepRecord& record, const ViewSettings& settings) {
  Image image;
  painter.paint(record, settings, image);
  return image;
}

}  // namespace

TEST_CASE("the same record and settings give the same pixels, whatever was painted before") {
  ViewSettings full = settings_with(all_layers());
  full.show_figures = full.show_legend = true;
  ViewSettings plain = settings_with({"meshes"});
  plain.antialiasing = !full.antialiasing;
  plain.panel_scale = 2;
  ViewSettings fitted = full;
  fitted.camera_given = false;

  FramePainter first(640, 360), second(640, 360);
  const Image a = paint_with(first, sample_record(), full);
  const Image b = paint_with(first, other_record(), plain);
  const Image c = paint_with(first, sample_record(), fitted);
  CHECK(a.width == 640);
  CHECK(a.rgb.size() == 640u * 360u * 3u);
  CHECK_FALSE(a == b);
  CHECK_FALSE(a == c);
  // another painter, the other way round
  CHECK(paint_with(second, sample_record(), fitted) == c);
  CHECK(paint_with(second, other_record(), plain) == b);
  CHECK(paint_with(second, sample_record(), full) == a);
  // the first one again, after all that
  CHECK(paint_with(first, sample_record(), full) == a);
}

TEST_CASE("a painter reuses the picture it is given and names what draws") {
  FramePainter painter(160, 90);
  Image image(7, 3);
  painter.paint(sample_record(), settings_with({"meshes"}), image);
  CHECK(image.width == 160);
  CHECK(image.height == 90);
  CHECK(painter.renderer_name().find("llvmpipe") != std::string::npos);
}

TEST_CASE("a record without bodies is painted as the backdrop alone") {
  StepRecord empty;
  ViewSettings settings = make_view_settings();
  settings.show_figures = settings.show_legend = false;
  FramePainter painter(64, 36);
  Image image;
  painter.paint(empty, settings, image);
  for (int y = 0; y < 36; ++y)
    for (int x = 1; x < 64; ++x) REQUIRE(std::equal(image.pixel(x, y), image.pixel(x, y) + 3, image.pixel(0, y)));
}

TEST_CASE("pictures are the right way up and not mirrored") {
  HandMadeRecord scene;
  scene.add("red", BodyKind::dynamic, Sphere{0.3}, {1.0, 1.0, 0.0});
  ViewSettings settings = settings_with({"meshes"});
  settings.camera.look_at({0, 0, 8}, {0, 0, 0});
  const Image with = painted(scene.record(), settings);
  const Image without = painted(StepRecord{}, settings);
  int changed = 0, upper_right = 0;
  for (int y = 0; y < with.height; ++y)
    for (int x = 0; x < with.width; ++x)
      if (!std::equal(with.pixel(x, y), with.pixel(x, y) + 3, without.pixel(x, y))) {
        ++changed;
        upper_right += x > with.width / 2 && y < with.height / 2;
      }
  CHECK(changed > 100);
  CHECK(upper_right == changed);
}

TEST_CASE("a sphere covers the area that perspective gives it") {
  HandMadeRecord scene;
  const double radius = 0.5, distance = 4.0;
  scene.add("ball", BodyKind::dynamic, Sphere{radius}, Vec3::Zero());
  ViewSettings settings = settings_with({"meshes"});
  settings.camera.look_at({0, 0, distance}, {0, 0, 0});
  settings.camera.fov_deg = 40.0;
  const int width = 640, height = 360;
  const Image with = painted(scene.record(), settings, width, height),
              without = painted(StepRecord{}, settings, width, height);
  int covered = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) covered += !std::equal(with.pixel(x, y), with.pixel(x, y) + 3, without.pixel(x, y));
  // the cone that touches the sphere: sin(half angle) = r / d
  const double focal = 0.5 * height / std::tan(20.0 * M_PI / 180.0);
  const double disc = focal * std::tan(std::asin(radius / distance));
  CHECK(covered == Approx(M_PI * disc * disc).epsilon(0.03));
}
