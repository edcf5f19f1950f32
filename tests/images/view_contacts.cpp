// The contacts layer by its settings, and the legend that keeps away from what is picked.
#include <catch2/catch.hpp>

#include <cmath>

#include "tests/support/pictures/view_scenes.hpp"
#include "viewer/draw/color_map.hpp"
#include "viewer/draw/palette.hpp"
#include "viewer/gl/context.hpp"
#include "viewer/layers/layer.hpp"
#include "viewer/present/scene_painter.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// Three contacts beside each other: of `a` and `b`, of `b` and `c`, and one that carries nothing.
void make_contacts(HandMadeRecord& scene, double first, double second, bool with_open = true) {
  const int a = scene.add("a", BodyKind::dynamic, Sphere{0.1}, {0, 9, 0}),
            b = scene.add("b", BodyKind::dynamic, Sphere{0.1}, {0, 9, 0}),
            c = scene.add("c", BodyKind::fixed, Sphere{0.1}, {0, 9, 0});
  if (first > 0.0) scene.touch(a, b, {-0.5, 0, 0}, Vec3::UnitY(), ContactState::stick, -1e-3).lambda.x() = first;
  if (second > 0.0) scene.touch(b, c, {0.5, 0, 0}, Vec3::UnitY(), ContactState::slip, -2e-3).lambda.x() = second;
  if (with_open) scene.touch(a, c, {0, 0, 0}, Vec3::UnitY(), ContactState::open, 1e-3);
}

ViewSettings contacts_only() {
  ViewSettings settings = settings_with({"contacts"});
  settings.camera.look_at({0, 0, 4}, {0, 0, 0});
  settings.point_size = 24.0;
  return settings;
}

/// Pixels that differ from an empty picture, left and right of the middle.
std::pair<int, int> covered_halves(const Image& image) {
  const Image empty = painted(StepRecord{}, contacts_only());
  std::pair<int, int> count;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      if (!std::equal(image.pixel(x, y), image.pixel(x, y) + 3, empty.pixel(x, y)))
        ++(x < image.width / 2 ? count.first : count.second);
  return count;
}

/// Where a contact's middle is in the picture.
const std::uint8_t* pixel_at(const Image& image, const ViewSettings& settings, double x) {
  const auto at = settings.camera.project({x, 0, 0}, image.width, image.height);
  return image.pixel(static_cast<int>(std::lround(at->x())), static_cast<int>(std::lround(at->y())));
}

}  // namespace

TEST_CASE("contacts that carry nothing, or are of nothing selected, can be left out") {
  HandMadeRecord whole, carrying, of_a, one;
  make_contacts(whole, 1.0, 4.0);
  make_contacts(carrying, 1.0, 4.0, false);
  make_contacts(of_a, 1.0, 0.0);
  make_contacts(one, 1.0, 0.0, false);
  ViewSettings settings = contacts_only(), plain = contacts_only();
  set(settings, "view.contacts.carrying", "true");
  CHECK((painted(whole.record(), settings).rgb == painted(carrying.record(), plain).rgb));
  settings = contacts_only();
  set(settings, "view.contacts.of_selected", "true");
  CHECK((painted(whole.record(), settings).rgb == painted(whole.record(), plain).rgb));  // nothing is selected
  settings.selected = {"a"};
  CHECK((painted(whole.record(), settings).rgb == painted(of_a.record(), plain).rgb));
  settings.selected = {"a", "b"};  // a contact's two bodies: their pair
  CHECK((painted(whole.record(), settings).rgb == painted(one.record(), plain).rgb));
}

TEST_CASE("marks of contacts leave bodies to be seen that are small in the picture or have many") {
  // a ball of a metre with contacts all over it, from near and from far away: how much of its disc stays its own
  const auto left = [](int contacts, double away) {
    HandMadeRecord scene;
    const int ball = scene.add("ball", BodyKind::dynamic, Sphere{0.5}, {0, 0, 0}),
              other = scene.add("other", BodyKind::fixed, Sphere{0.5}, {0, 100, 0});
    for (int i = 0; i < contacts; ++i) {
      const double y = 1.0 - (2.0 * i + 1.0) / contacts, turn = 2.4 * i, r = std::sqrt(1.0 - y * y);
      const Vec3 n(r * std::cos(turn), y, r * std::sin(turn));
      scene.touch(ball, other, 0.5 * n, n, ContactState::stick, -1e-3).lambda.x() = 1.0;
    }
    ViewSettings settings = settings_with({"meshes", "contacts"}), bare = settings_with({"meshes"});
    for (ViewSettings* s : {&settings, &bare}) s->camera.look_at({0, 0, away}, {0, 0, 0});
    const Image with = painted(scene.record(), settings), without = painted(scene.record(), bare),
                empty = painted(StepRecord{}, bare);
    int disc = 0, own = 0;
    for (std::size_t i = 0; i + 2 < with.rgb.size(); i += 3) {
      const auto same = [&](const Image& a, const Image& b) {
        return std::equal(a.rgb.begin() + i, a.rgb.begin() + i + 3, b.rgb.begin() + i);
      };
      if (same(without, empty)) continue;
      ++disc, own += same(with, without);
    }
    REQUIRE(disc > 100);
    return static_cast<double>(own) / disc;
  };
  CHECK(left(24, 3.0) > 0.6);
  CHECK(left(24, 12.0) > 0.4);  // discs of one size would cover all of it
  CHECK(left(200, 3.0) > 0.4);
  // a few on a large body are as large as ever: half of view.point_size in a picture 180 high
  HandMadeRecord scene;
  const int ball = scene.add("ball", BodyKind::dynamic, Sphere{3.0}, {0, 0, -3}),
            floor = scene.add("floor", BodyKind::fixed, Sphere{0.5}, {0, 100, 0});
  scene.touch(ball, floor, {0, 0, 0}, Vec3::UnitY(), ContactState::stick, -1e-3).lambda.x() = 1.0;
  ViewSettings settings = contacts_only();
  const auto [l, r] = covered_halves(painted(scene.record(), settings));
  const double radius = 0.5 * 0.5 * settings.point_size, rim = 1.4 * 0.5;
  CHECK(l + r > 3.14 * radius * radius);
  CHECK(l + r < 3.14 * std::pow(radius + rim + 1.0, 2));
}

TEST_CASE("areas of contacts are like their forces") {
  HandMadeRecord scene;
  make_contacts(scene, 1.0, 4.0, false);
  ViewSettings settings = contacts_only();
  const auto [left, right] = covered_halves(painted(scene.record(), settings));
  CHECK(std::abs(left - right) < 0.1 * left);
  set(settings, "view.contacts.size", "force");
  const auto [small, large] = covered_halves(painted(scene.record(), settings));
  CAPTURE(small, large);
  CHECK(large > 3.0 * small);  // a rim of a pixel is added to both
  CHECK(large < 5.0 * small);
}

TEST_CASE("colours of contacts are those of their quantity by the bar's end") {
  HandMadeRecord scene;
  make_contacts(scene, 1.0, 4.0, false);
  // a mark is shaded (shaders/point.frag): by how much at that pixel, a colour that is known says
  const Image known = painted(scene.record(), contacts_only());
  const auto shade_at = [&](double x, Color color) {
    const std::uint8_t* seen = pixel_at(known, contacts_only(), x);
    return static_cast<float>(seen[0] + seen[1] + seen[2]) / (255.0f * (color.r + color.g + color.b));
  };
  const float shades[] = {shade_at(-0.5, role::kStick), shade_at(0.5, role::kSlip)};
  const auto check = [&](const char* quantity, const char* most, double first, double second) {
    CAPTURE(quantity);
    ViewSettings settings = contacts_only();
    set(settings, "view.contacts.color", quantity);
    set(settings, "view.contacts.max", most);
    const Image image = painted(scene.record(), settings);
    for (const auto& [x, share] : {std::pair(-0.5, first), {0.5, second}}) {
      const Color wanted = heat_color(share);
      const std::uint8_t* seen = pixel_at(image, settings, x);
      const float shade = shades[x < 0.0 ? 0 : 1];
      CHECK(std::abs(seen[0] - 255.0f * shade * wanted.r) < 4.0f);
      CHECK(std::abs(seen[1] - 255.0f * shade * wanted.g) < 4.0f);
      CHECK(std::abs(seen[2] - 255.0f * shade * wanted.b) < 4.0f);
    }
  };
  check("impulse", "0", 0.2, 0.8);  // the bar ends at 5
  check("impulse", "8", 0.125, 0.5);
  check("gap", "0.004", 0.25, 0.5);
  BodyRecord& b = scene.record().bodies[1];
  b.velocity = {0.3, 7.0, 0.4};  // along the contacts' planes 0.5 m/s
  check("slip", "1", 0.5, 0.5);
  b.angular_velocity = {0.0, 0.0, 1.0};  // 9 m below its centre: 9 m/s more along x, and some across
  check("slip", "20", std::hypot(9.3, 0.4) / 20.0, std::hypot(9.3, 0.4) / 20.0);
}

TEST_CASE("the legend leaves in sight what is picked, and folds where it can't") {
  const auto context = make_offscreen_context();
  context->make_current();
  ScenePainter painter(640, 540);
  ViewSettings settings = settings_with({"contacts", "normals", "gaps"});
  settings.show_legend = true;
  settings.camera.look_at({0, 0, 10}, {0, 0, 0});
  settings.camera.fov_deg = 40.0;
  const auto legend = [&](const Vec3& low, const Vec3& high) {
    settings.picked = Aabb{low, high};
    painter.paint(sample_record(), settings);
    return painter.legend();
  };
  const auto hides = [&](const PanelArea& area, const Vec3& point) {
    const auto at = settings.camera.project(point, 640, 540);
    return at->x() >= area.x && at->x() < area.x + area.width && at->y() >= area.y && at->y() < area.y + area.height;
  };
  const PanelArea usual = legend(Vec3::Constant(1.0), Vec3::Constant(-1.0));  // nothing
  CHECK_FALSE(usual.is_folded);
  CHECK(usual.x > 320.0f);
  CHECK(usual.y < 20.0f);
  int moved = 0;
  for (const double x : {-4.0, -2.0, 0.0, 2.0, 3.9})
    for (const double y : {-3.3, -1.5, 0.0, 1.5, 3.3}) {
      const Vec3 point(x, y, 0.0);
      const PanelArea area = legend(point, point);
      CAPTURE(x, y, area.x, area.y);
      CHECK(area.width > 0.0f);
      CHECK_FALSE(area.is_folded);
      CHECK_FALSE(hides(area, point));
      moved += area.x != usual.x || area.y != usual.y;
    }
  CHECK(moved >= 1);
  CHECK(moved <= 6);  // it stays where it is not in the way
  CHECK(legend({-3.9, -1.5, 0}, {3.9, 1.5, 0}).is_folded == false);
  const PanelArea folded = legend({-3.9, -2.7, 0}, {3.9, 2.4, 0});  // half of the picture, into every corner
  CHECK(folded.width > 0.0f);
  settings.legend_form = LegendForm::folded;
  CHECK(legend(Vec3::Constant(1.0), Vec3::Constant(-1.0)).is_folded);
  settings.legend_form = LegendForm::automatic;
  settings.most_legend = 0.01;
  const PanelArea small = legend(Vec3::Constant(1.0), Vec3::Constant(-1.0));
  CHECK(small.is_folded);
  CHECK(small.width * small.height < 0.4f * usual.width * usual.height);
  settings.legend_form = LegendForm::whole;
  CHECK(legend(Vec3::Constant(1.0), Vec3::Constant(-1.0)).width == usual.width);
}
