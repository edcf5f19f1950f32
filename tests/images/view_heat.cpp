// Colours of surfaces against formulas and against the record: as data, before anything is painted.
#include <catch2/catch.hpp>

#include <cmath>
#include <deque>

#include "tests/support/pictures/view_scenes.hpp"
#include "viewer/layers/layer.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

DrawList drawn(const StepRecord& record, const ViewSettings& settings) {
  static SurfaceCache surfaces;
  DrawList list;
  for (const Layer& layer : layers())
    if (settings.is_on(layer.name)) layer.draw({record, settings, settings.camera, surfaces, layer.name}, list);
  return list;
}

DrawList heated(const StepRecord& record, const std::string& of, double max) {
  ViewSettings settings = settings_with({"meshes", "heat"});
  set(settings, "view.heat.of", of);
  set(settings, "view.heat.max", std::to_string(max));
  return drawn(record, settings);
}

}  // namespace

TEST_CASE("the heat of speed is |v + w x r| of the vertices of a rigid body") {
  StepRecord record = sample_record();
  int vertices = 0;
  for (std::size_t i = 0; i < record.bodies.size(); ++i) {
    record.bodies[i].velocity = Vec3(0.3, -0.2, 0.1 * static_cast<double>(i));
    record.bodies[i].angular_velocity = Vec3(1.0, 2.0, -0.5);
  }
  const DrawList list = heated(record, "speed", 4.0);
  for (const DrawSurface& item : list.surfaces) {
    const BodyRecord& body = record.bodies[item.pick - 1];
    if (body.kind == BodyKind::fixed) {
      CHECK(item.heat == nullptr);
      continue;
    }
    REQUIRE(item.heat != nullptr);
    REQUIRE(item.heat->size() == item.surface->positions.size());
    // by a difference over a millionth of a second: rotation by Rodrigues' formula, centre by its velocity
    const double dt = 1e-6;
    const Mat3 turn = Eigen::AngleAxisd(body.angular_velocity.norm() * dt, body.angular_velocity.normalized()).matrix();
    for (std::size_t v = 0; v < item.heat->size(); ++v, ++vertices) {
      const Vec3 arm = body.pose.rotation * item.surface->positions[v].cast<double>();
      const double speed = ((turn * arm - arm) / dt + body.velocity).norm();
      REQUIRE((*item.heat)[v] == Approx(speed / 4.0).margin(1e-4));
    }
  }
  CHECK(vertices > 500);
}

TEST_CASE("the heat of a deformable body is the speed of its nodes where all have one") {
  StepRecord record = soft_record();
  int soft = 0;
  std::deque<DeformableBody> moving;
  for (BodyRecord& body : record.bodies) {
    if (body.deformable == nullptr) continue;
    DeformableBody& own = moving.emplace_back(*body.deformable);
    for (int i = 0; i < own.nodes(); ++i) own.velocity.segment<3>(3 * i) = Vec3(0.3, 0.4, 1.2);
    body.deformable = &own;
  }
  for (const DrawSurface& item : heated(record, "speed", 2.6).surfaces) {
    if (record.bodies[item.pick - 1].deformable == nullptr) continue;
    REQUIRE(item.heat != nullptr);
    for (const float v : *item.heat) CHECK(v == Approx(0.5).margin(1e-6));
    ++soft;
  }
  CHECK(soft == 2);
}

TEST_CASE("the hottest vertices of a body have what its contacts have, and what nothing touches has no heat") {
  int touched = 0;
  for (StepRecord shown : {sample_record(), soft_record()}) {
    StepRecord* record = &shown;
    double next = 0.0;
    for (ContactRecord& c : shown.contacts) c.residual = next += 0.01;  // that of the records is rounding
    std::vector<double> impulse(record->bodies.size(), 0.0), overlap = impulse, residual = impulse;
    for (const ContactRecord& c : record->contacts)
      for (const BodyIndex b : {c.body_a, c.body_b}) {
        const auto i = static_cast<std::size_t>(b.value());
        impulse[i] = std::max(impulse[i], c.lambda.x());
        overlap[i] = std::max(overlap[i], -c.gap);
        residual[i] = std::max(residual[i], c.residual);
      }
    for (const auto& [of, wanted, high] :
         {std::tuple("impulse", &impulse, 1e3), {"overlap", &overlap, 10.0}, {"residual", &residual, 1.0}}) {
      const DrawList list = heated(*record, of, high);
      for (const DrawSurface& item : list.surfaces) {
        const double most = (*wanted)[item.pick - 1];
        CAPTURE(of, most, item.pick);
        REQUIRE((item.heat != nullptr) == (most > 0.0));
        // a palette's colour would read as a value of the bar
        const BodyKind kind = record->bodies[item.pick - 1].kind;
        const bool is_of_palette = kind == BodyKind::dynamic || kind == BodyKind::deformable;
        if (item.heat == nullptr) CHECK((item.color == role::kNoValue) == is_of_palette);
        if (item.heat == nullptr) continue;
        CHECK(*std::max_element(item.heat->begin(), item.heat->end()) == Approx(most / high).epsilon(1e-5));
        ++touched;
      }
      const bool any = std::any_of(list.surfaces.begin(), list.surfaces.end(), [](const auto& i) { return i.heat; });
      CHECK(list.color_bars.size() == (any ? 1 : 0));
    }
  }
  CHECK(touched >= 9);
}

TEST_CASE("where heat is shown nothing of stress is left, and solid tetrahedra have their nodes' speed") {
  StepRecord record = soft_record();
  std::deque<DeformableBody> moving;
  for (BodyRecord& body : record.bodies) {
    if (body.deformable == nullptr) continue;
    DeformableBody& own = moving.emplace_back(*body.deformable);
    for (int i = 0; i < own.nodes(); ++i) own.velocity.segment<3>(3 * i) = Vec3(0.3, 0.4, 1.2);
    body.deformable = &own;
  }
  ViewSettings settings = settings_with({"meshes", "stress", "heat", "tetrahedra"});
  set(settings, "view.tetrahedra.style", "shrunk");
  set(settings, "view.heat.of", "speed");
  set(settings, "view.heat.max", "2.6");
  int solids = 0;
  for (const DrawSurface& item : drawn(record, settings).surfaces) {
    if (record.bodies[item.pick - 1].deformable == nullptr || item.see_through || item.color == role::kOverlap)
      continue;
    REQUIRE(item.heat != nullptr);
    REQUIRE(item.heat->size() == item.surface->positions.size());
    for (const float v : *item.heat) CHECK(v == Approx(0.5).margin(1e-6));
    ++solids;
  }
  CHECK(solids == 2);

  // nothing touches anything: no bar, no colours, whatever stress there is
  record.contacts.clear();
  set(settings, "view.heat.of", "overlap");
  const DrawList list = drawn(record, settings);
  CHECK(list.color_bars.empty());
  for (const DrawSurface& item : list.surfaces) CHECK(item.heat == nullptr);
}

TEST_CASE("the bar of overlap does not end below a millionth of the largest body that moves") {
  StepRecord record = sample_record();
  double largest = 0.0;
  for (const BodyRecord& body : record.bodies)
    if (body.kind != BodyKind::fixed) largest = std::max(largest, body.bounds.extent().norm());
  for (ContactRecord& c : record.contacts) c.gap = -1e-15;
  const DrawList tiny = heated(record, "overlap", 0.0);
  REQUIRE(tiny.color_bars.size() == 1);
  CHECK(tiny.color_bars.front().scale.high >= 1e-6 * largest);
  CHECK(tiny.color_bars.front().scale.high <= 1e-5 * largest);
  for (ContactRecord& c : record.contacts) c.gap = -0.01;
  CHECK(heated(record, "overlap", 0.0).color_bars.front().scale.high == Approx(0.01));
}
