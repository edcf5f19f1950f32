// What the panels explain of a picture: marks that are in it and no others, in no more room than they are worth; and
// marks whose colours are near each other have shapes that aren't.
#include <catch2/catch.hpp>

#include <array>
#include <cmath>

#include "tests/support/pictures/view_scenes.hpp"
#include "viewer/gl/context.hpp"
#include "viewer/layers/layer.hpp"
#include "viewer/present/scene_painter.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

struct Painted {
  PanelArea legend;
  std::vector<PanelArea> bars;
};

Painted panels_of(const StepRecord& record, ViewSettings settings, int width = 640, int height = 540) {
  static const auto context = make_offscreen_context();
  context->make_current();
  ScenePainter painter(width, height);
  settings.show_legend = true;
  painter.paint(record, settings);
  return {painter.legend(), painter.bars()};
}

/// How bright a pixel is, 0 to 255, so many pixels from where the point is, along (right, down).
int brightness(const Image& image, const Camera& camera, const Vec3& point, double right, double down) {
  const auto at = camera.project(point, image.width, image.height);
  REQUIRE(at);
  const std::uint8_t* pixel =
      image.pixel(static_cast<int>(std::lround(at->x() + right)), static_cast<int>(std::lround(at->y() + down)));
  return (pixel[0] + pixel[1] + pixel[2]) / 3;
}

}  // namespace

TEST_CASE("the legend lists the contacts that are in the picture") {
  ViewSettings settings = settings_with({"contacts"});
  std::vector<float> heights;
  for (const std::vector<ContactState>& states : {std::vector<ContactState>{},
                                                  {ContactState::stick},
                                                  {ContactState::stick, ContactState::open},
                                                  {ContactState::open, ContactState::slip, ContactState::stick},
                                                  {ContactState::slip, ContactState::slip, ContactState::slip}}) {
    HandMadeRecord scene;
    const int a = scene.add("a", BodyKind::dynamic, Sphere{0.1}, {0, 5, 0});
    for (const ContactState state : states) scene.touch(a, a, Vec3::Zero(), Vec3::UnitY(), state);
    heights.push_back(panels_of(scene.record(), settings).legend.height);
  }
  CHECK(heights[0] == 0.0f);
  const float row = heights[2] - heights[1];
  CHECK(row > 10.0f);
  CHECK(heights[3] - heights[2] == Approx(row));
  CHECK(heights[4] == Approx(heights[1]));
}

TEST_CASE("the legend has no row of what is on and isn't drawn, and none of what is hidden") {
  ViewSettings meshes = settings_with({"meshes"});
  meshes.legend_form = LegendForm::whole;
  const PanelArea alone = panels_of(sample_record(), meshes).legend;
  StepRecord still = sample_record();
  still.contacts.clear();
  for (BodyRecord& body : still.bodies) body.velocity = body.angular_velocity = Vec3::Zero();
  ViewSettings more = settings_with({"meshes", "contacts", "normals", "contact_forces", "gaps", "velocities"});
  more.legend_form = LegendForm::whole;
  CHECK(panels_of(still, more).legend.height == Approx(alone.height));
  CHECK(panels_of(sample_record(), more).legend.height > 2.0f * alone.height);
  ViewSettings hidden = meshes;
  for (const BodyRecord& body : sample_record().bodies)
    if (body.kind == BodyKind::scripted) hidden.hidden.emplace_back(body.name);
  REQUIRE_FALSE(hidden.hidden.empty());
  CHECK(panels_of(sample_record(), hidden).legend.height < alone.height);
}

TEST_CASE("what a row of the legend explains is drawn in the row's colour") {
  StepRecord rigid = sample_record(), soft = soft_record();
  rigid.bodies.back().pull = {rigid.bodies.back().pose.position, Vec3(0.3, 0.5, 0)};
  for (const Layer& layer : layers()) {
    const ViewSettings settings = settings_with({"meshes", std::string(layer.name)});
    DrawList lists[2];
    SurfaceCache surfaces;
    for (int k = 0; k < 2; ++k) {
      const StepRecord& record = k == 0 ? rigid : soft;
      layer.draw({record, settings, settings.camera, surfaces, layer.name}, lists[k]);
      lists[k].end_layer(layer.name);
    }
    for (const LegendRow& row : layer.legend) {
      CAPTURE(std::string(layer.name), std::string(row.text));
      if (row.present == nullptr && row.found == nullptr)
        CHECK((lists[0].has_color(layer.name, row.color) || lists[1].has_color(layer.name, row.color)));
    }
  }
}

TEST_CASE("a draw list knows the colours of each of its layers, and of what was left out") {
  DrawList list;
  const Color red = hex(0xff0000), blue = hex(0x0000ff);
  list.points.push_back({Vec3::Zero(), red, 8.0f, Depth::on_top, body_pick(0)});
  list.end_layer("first");
  list.lines.push_back({Vec3::Zero(), Vec3::UnitX(), with_alpha(blue, 0.5f), 1.0f, Depth::tested, body_pick(1)});
  list.points.push_back({Vec3::Zero(), blue, 8.0f, Depth::on_top, body_pick(0)});
  list.end_layer("second");
  list.end_layer("third");
  CHECK(list.has_color("first", red));
  CHECK_FALSE(list.has_color("first", blue));
  CHECK_FALSE(list.has_color("second", red));
  CHECK(list.has_color("second", blue));
  CHECK_FALSE(list.has_color("third", blue));
  DrawSurface surface;
  surface.color = red;
  list.surfaces.push_back(surface);
  list.end_layer("plain");
  surface.heat = std::make_shared<std::vector<float>>();
  list.surfaces.push_back(surface);
  list.end_layer("heated");
  CHECK(list.has_color("plain", red));
  CHECK_FALSE(list.has_color("heated", red));
  list.leave_out([](PickId pick) { return pick == body_pick(0); });
  CHECK_FALSE(list.has_color("first", red));
  CHECK(list.has_color("second", blue));
  list.leave_out([](PickId) { return true; });
  CHECK_FALSE(list.has_color("second", blue));
}

TEST_CASE("a colour bar folds where it would cover a tenth of the picture, and stays in it") {
  ViewSettings settings = settings_with({"meshes", "stress"});
  for (const auto& [width, height] : {std::pair{1280, 720}, {640, 360}, {480, 270}, {320, 180}, {200, 120}}) {
    CAPTURE(width, height);
    settings.legend_form = LegendForm::whole;
    const std::vector<PanelArea> whole = panels_of(soft_record(), settings, width, height).bars;
    settings.legend_form = LegendForm::automatic;
    const std::vector<PanelArea> bars = panels_of(soft_record(), settings, width, height).bars;
    REQUIRE(bars.size() == 1);
    const PanelArea& bar = bars.front();
    const float picture = static_cast<float>(width * height);
    if (width > 200) {
      REQUIRE(whole.front().width > 0.0f);
      CHECK(bar.is_folded == (whole.front().width * whole.front().height > 0.1f * picture));
    }
    CHECK(bar.width * bar.height <= 0.1f * picture);
    if (bar.width > 0.0f) {
      CHECK(bar.x >= 0.0f);
      CHECK(bar.y >= 0.0f);
      CHECK(bar.x + bar.width <= static_cast<float>(width));
      CHECK(bar.y + bar.height <= static_cast<float>(height));
    }
  }
}

TEST_CASE("up to 480 pixels of height a colour bar is shorter, and still has its numbers") {
  const ViewSettings settings = settings_with({"meshes", "stress"});
  const PanelArea small = panels_of(soft_record(), settings, 640, 480).bars.front(),
                  large = panels_of(soft_record(), settings, 640, 481).bars.front();
  CHECK_FALSE(small.is_folded);
  CHECK(small.width < 0.75f * large.width);
  CHECK(small.width * small.height < 0.035f * 640.0f * 480.0f);
  CHECK(small.x + small.width > 630.0f);  // in the corner
  CHECK(small.y + small.height > 470.0f);
}

TEST_CASE("the legend's arrow of a force is as long as one of that force in the picture") {
  // 20 N to the right, across the line of sight; below the legend
  HandMadeRecord scene;
  const int b = scene.add("b", BodyKind::dynamic, Sphere{0.1}, {0, 9, 0}),
            c = scene.add("c", BodyKind::fixed, Sphere{0.1}, {0, 9, 0});
  scene.touch(b, c, {-0.2, -0.3, 0}, Vec3::UnitX(), ContactState::stick).lambda.x() = 20.0 / 60.0;
  ViewSettings settings = settings_with({"contact_forces"});
  settings.camera.look_at({0, 0, 4}, {0, 0, 0});
  set(settings, "view.contact_forces.unit", "20");
  /// Columns that have the colour of forces, in the upper half and in the lower one.
  const auto lengths = [&](LegendForm form, int width, int height) {
    ViewSettings shown = settings;
    shown.show_legend = true;
    shown.legend_form = form;
    const Image image = painted(scene.record(), shown, width, height);
    std::array<int, 2> count = {0, 0};
    for (int half = 0; half < 2; ++half)
      for (int x = 0; x < width; ++x) {
        bool any = false;
        for (int y = half * height / 2; y < (half + 1) * height / 2; ++y) {
          const std::uint8_t* p = image.pixel(x, y);
          any |= p[0] - p[2] > 40;  // orange, thinned out at the tip
        }
        count[static_cast<std::size_t>(half)] += any;
      }
    return count;
  };
  for (const LegendForm form : {LegendForm::whole, LegendForm::folded})
    for (const auto& [width, height] : {std::pair{1280, 720}, {640, 480}, {720, 1280}, {1920, 1080}}) {
      const auto [in_legend, in_picture] = lengths(form, width, height);
      CAPTURE(width, height, in_legend, in_picture);
      const double wanted = settings.arrow_length * std::min(width, height) / 720.0;
      CHECK(std::abs(in_legend - wanted) <= 2.0);
      CHECK(std::abs(in_picture - wanted) <= 2.0);  // its tip has a dark rim
    }
}

TEST_CASE("a centre of mass is a target, and an open contact a disc") {
  HandMadeRecord scene;
  const int a = scene.add("a", BodyKind::dynamic, Sphere{5.0}, Vec3::Zero());  // which has room for a large mark
  scene.touch(a, a, {0.5, 0, 0}, Vec3::UnitY(), ContactState::open);
  ViewSettings settings = settings_with({"mass_centers", "contacts"});
  settings.camera.look_at({0, 0, 4}, {0, 0, 0});
  settings.point_size = 60.0;
  const Image image = painted(scene.record(), settings, 640, 360);
  const auto seen = [&](const Vec3& point, double share) {  // between the axes, which go right and up
    const double radius = 0.5 * 0.5 * 60.0 * share;         // of marks in a small picture
    return brightness(image, settings.camera, point, -radius * std::sqrt(0.5), radius * std::sqrt(0.5));
  };
  const Vec3 contact(0.5, 0, 0);
  for (const double share : {0.1, 0.3, 0.5}) CHECK(seen(contact, share) > 200);
  CHECK(seen(Vec3::Zero(), 0.1) > 200);
  CHECK(seen(Vec3::Zero(), 0.6) < 60);
  CHECK(seen(Vec3::Zero(), 1.0) > 200);
}

TEST_CASE("a body's axis is a bar, and a contact's force an arrow") {
  // along x, the red axis beside the orange force
  HandMadeRecord axis, force;
  axis.add("a", BodyKind::dynamic, Sphere{0.1}, Vec3::Zero());
  const int b = force.add("b", BodyKind::dynamic, Sphere{0.1}, {0, 9, 0}),
            c = force.add("c", BodyKind::fixed, Sphere{0.1}, {0, 9, 0});
  force.touch(b, c, Vec3::Zero(), Vec3::UnitX(), ContactState::stick).lambda.x() = 1e6;
  ViewSettings settings = settings_with({"mass_centers"}), forces = settings_with({"contact_forces"});
  for (ViewSettings* each : {&settings, &forces}) {
    each->camera.look_at({0, 0, 4}, {0, 0, 0});
    each->arrow_length = 200.0;
    each->line_width = 6.0;
  }
  const Image with_axis = painted(axis.record(), settings, 640, 360),
              with_force = painted(force.record(), forces, 640, 360);
  const Image no_axis = painted(StepRecord{}, settings, 640, 360), no_force = painted(StepRecord{}, forces, 640, 360);
  /// Pixels across it, at each column right of the middle.
  const auto widths = [](const Image& image, const Image& without) {
    std::vector<int> all;
    for (int x = image.width / 2 + 20; x < image.width; ++x) {
      int count = 0;
      for (int y = 0; y < image.height; ++y)
        count += !std::equal(image.pixel(x, y), image.pixel(x, y) + 3, without.pixel(x, y));
      if (count > 0) all.push_back(count);
    }
    return all;
  };
  const std::vector<int> bar = widths(with_axis, no_axis), arrow = widths(with_force, no_force);
  REQUIRE(bar.size() > 20);
  REQUIRE(arrow.size() > 20);
  CHECK(*std::max_element(bar.begin(), bar.end()) <= bar.front() + 1);
  CHECK(*std::max_element(arrow.begin(), arrow.end()) > 1.6 * arrow.front());
}
