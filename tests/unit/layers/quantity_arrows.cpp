// Forces and spins can be read by their arrows: lengths against what the layers say one stands for.
#include <catch2/catch.hpp>

#include <cmath>

#include "tests/support/pictures/hand_made_record.hpp"
#include "tests/support/random.hpp"
#include "viewer/layers/layer.hpp"
#include "viewer/panels/overlay/legend_rows.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

void put(ViewSettings& settings, const char* path, const char* text) {
  ParameterSet rows;
  settings.bind(rows);
  const Parameter* row = rows.find(path);
  REQUIRE(row != nullptr);
  row->set(checked_value(*row, parse_value(*row, text)));
}

DrawList drawn(const StepRecord& record, const ViewSettings& settings, std::string_view name) {
  SurfaceCache surfaces;
  DrawList list;
  for (const Layer& layer : layers())
    if (layer.name == name) {
      layer.draw({record, settings, settings.camera, surfaces, layer.name}, list);
      list.end_layer(name);
    }
  return list;
}

const MarkScale& only_scale(const DrawList& list, Color color) {
  const auto is_it = [&](const MarkScale& s) { return s.color == color; };
  REQUIRE(std::count_if(list.scales.begin(), list.scales.end(), is_it) == 1);
  return *std::find_if(list.scales.begin(), list.scales.end(), is_it);
}

bool is_round(double value) {
  const double digits = value / std::pow(10.0, std::floor(std::log10(value) + 1e-9));
  return std::abs(digits - 1.0) < 1e-9 || std::abs(digits - 2.0) < 1e-9 || std::abs(digits - 5.0) < 1e-9;
}

/// A crate of 1 kg on a floor, with such normal forces, N.
void load(HandMadeRecord& scene, const std::vector<double>& forces) {
  if (scene.record().bodies.empty()) {
    scene.add("floor", BodyKind::fixed, Plane{Vec3::UnitY(), 0.0}, Vec3::Zero());
    scene.add("crate", BodyKind::dynamic, Box{{0.5, 0.5, 0.5}}, {0, 0.5, 0});
  }
  scene.record().contacts.clear();
  for (std::size_t i = 0; i < forces.size(); ++i)
    scene.touch(1, 0, {0.01 * static_cast<double>(i), 0, 0}, Vec3::UnitY(), ContactState::stick).lambda = {
        forces[i] * scene.record().frame_time, 0.0, 0.0};
}

}  // namespace

TEST_CASE("contact forces are as long as the legend's newtons say, and none is longer than view.arrow_most") {
  Random random(51);
  HandMadeRecord scene;
  ViewSettings settings = make_view_settings();
  int cut = 0, whole = 0;
  for (int trial = 0; trial < 60; ++trial) {
    std::vector<double> forces(1 + trial % 40);
    const double size = std::pow(10.0, random.in(-4.0, 5.0));
    for (double& force : forces) force = size * std::pow(10.0, random.in(-1.0, 1.0));
    load(scene, forces);
    put(settings, "view.contact_forces.unit", trial % 3 == 0 ? "7.5" : "0");
    put(settings, "view.arrow_most", trial % 2 == 0 ? "3" : "1.5");
    const DrawList list = drawn(scene.record(), settings, "contact_forces");
    if (list.arrows.empty()) continue;  // all below half a pixel
    const MarkScale& scale = only_scale(list, role::kForce);
    CHECK(scale.unit == "N");
    CHECK(scale.size_px == Approx(settings.arrow_length));
    if (trial % 3 == 0)
      CHECK(scale.value == 7.5);
    else
      CHECK(is_round(scale.value));
    bool any_cut = false;
    for (std::size_t i = 0; i < list.arrows.size(); ++i) {
      const DrawArrow& arrow = list.arrows[i];
      CHECK((arrow.direction - Vec3::UnitY()).norm() < 1e-12);
      const double force = forces[static_cast<std::size_t>(arrow.pick & 0xffffu)];
      if (!arrow.is_cut) {
        CHECK(arrow.length_px * scale.value / scale.size_px == Approx(force));
        CHECK(force <= scale.most * (1.0 + 1e-9));
        ++whole;
        continue;
      }
      // of two heads, the first at the end
      any_cut = true, ++cut;
      CHECK(force > scale.most);
      CHECK(arrow.length_px == Approx(settings.arrow_most * settings.arrow_length));
      REQUIRE(++i < list.arrows.size());
      CHECK(list.arrows[i].pick == arrow.pick);
      CHECK(list.arrows[i].length_px < arrow.length_px);
    }
    CHECK(list.has_cut_arrow("contact_forces", role::kForce) == any_cut);
  }
  CHECK(cut > 20);
  CHECK(whole > 200);
}

TEST_CASE("the unit of forces is what a contact carries of the weight, or the middle one of larger forces") {
  HandMadeRecord scene;
  const ViewSettings settings = make_view_settings();
  const auto unit = [&](const std::vector<double>& forces) {
    load(scene, forces);
    return only_scale(drawn(scene.record(), settings, "contact_forces"), role::kForce).value;
  };
  CHECK(unit({9.81}) == Approx(10.0));
  CHECK(unit({4.9, 4.9}) == Approx(5.0));                           // 9.81 N on two of them
  CHECK(unit({0.02, 0.02, 9.7}) == Approx(5.0));                    // what hardly carries doesn't count
  CHECK(unit({3.0, 3.0, 3.0, 800.0}) == Approx(5.0));               // nor does one that is struck
  CHECK(unit({1100.0, 1300.0, 1200.0, 1000.0}) == Approx(2000.0));  // pressed together
  scene.record().gravity = Vec3::Zero();
  CHECK(unit({0.3, 0.4, 0.1}) == Approx(0.5));
}

TEST_CASE("rotation is as long as the legend's radians a second say") {
  HandMadeRecord scene;
  const double spins[] = {1.0, 5.0, 10.0, 29.0, 31.0, 400.0};
  for (const double spin : spins) {
    const int body = scene.add("body" + std::to_string(spin), BodyKind::dynamic, Sphere{0.1}, Vec3::Zero());
    scene.record().bodies[static_cast<std::size_t>(body)].angular_velocity = {0, 0, spin};
  }
  ViewSettings settings = make_view_settings();
  const DrawList list = drawn(scene.record(), settings, "velocities");
  const MarkScale& scale = only_scale(list, role::kSpin);
  CHECK(scale.value == Approx(10.0));  // a radian in six frames of a sixtieth of a second
  CHECK(scale.unit == "rad/s");
  for (const DrawArrow& arrow : list.arrows) {
    const double spin = spins[arrow.pick - 1];
    CHECK(arrow.is_cut == (spin > 30.0));
    CHECK(arrow.length_px <= Approx(3.0 * settings.arrow_length));
    if (!arrow.is_cut) CHECK(arrow.length_px / scale.size_px * scale.value == Approx(spin));
  }
}

TEST_CASE("a body that hardly moves has no arrow of a velocity") {
  HandMadeRecord scene;
  const double speeds[] = {0.0, 1e-9, 1e-3, 0.5};  // seen from 4 m, where half a pixel is a millimetre and a half
  for (const double speed : speeds) {
    const int body = scene.add("body" + std::to_string(speed), BodyKind::dynamic, Sphere{0.1}, Vec3::Zero());
    scene.record().bodies[static_cast<std::size_t>(body)].velocity = {speed, 0, 0};
  }
  ViewSettings settings = make_view_settings();
  settings.camera.look_at({0, 0, 4}, {0, 0, 0});
  const DrawList list = drawn(scene.record(), settings, "velocities");
  REQUIRE(list.arrows.size() == 1);
  CHECK(list.arrows[0].pick == body_pick(3));
  CHECK((list.arrows[0].direction - Vec3(0.05, 0, 0)).norm() < 1e-12);  // of six frames of a sixtieth of a second
}

TEST_CASE("the legend has marks of a size that fits, of an amount as round") {
  HandMadeRecord scene;
  load(scene, {20.0, 20.0, 20.0, 500.0});
  for (const double length : {1.0, 4.0, 36.0, 100.0, 300.0, 1000.0})
    for (const float scale : {0.5f, 1.0f, 3.0f}) {
      ViewSettings settings = make_view_settings();
      settings.switch_layer("contact_forces", true);
      settings.switch_layer("contacts", false);
      settings.arrow_length = length;
      const DrawList list = drawn(scene.record(), settings, "contact_forces");
      const float least = 6.0f * scale, most = 60.0f * scale;
      const std::vector<ShownRow> rows = legend_rows(scene.record(), list, settings, scale, least, most);
      const auto force = std::find_if(rows.begin(), rows.end(), [](const ShownRow& r) { return r.size > 0.0f; });
      REQUIRE(force != rows.end());
      CAPTURE(length, scale, force->text, force->size);
      CHECK(force->size <= most);
      if (length >= 4.0) CHECK(force->size >= least);  // of less no more than what is cut could be shown
      double amount = 0.0;
      char prefix = 0;
      REQUIRE(std::sscanf(force->quantity.c_str(), "%lf %c", &amount, &prefix) == 2);
      if (prefix == 'm') amount *= 1e-3;
      CHECK(is_round(amount));
      CHECK(amount / 20.0 == Approx(force->size / (length * scale)));
      CHECK(force->text.find(force->quantity) != std::string::npos);
      REQUIRE(force + 1 != rows.end());
      CHECK((force + 1)->is_cut);
      CHECK((force + 1)->text == "over 60 N");
    }
}
