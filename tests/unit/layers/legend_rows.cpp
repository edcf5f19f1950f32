// Rows of the legend that come and go with what is in the picture.
#include <catch2/catch.hpp>

#include <algorithm>

#include "tests/support/pictures/hand_made_record.hpp"
#include "viewer/layers/view_bodies.hpp"
#include "viewer/panels/overlay/legend_rows.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

std::vector<ShownRow> rows_of(const StepRecord& record, const ViewSettings& settings) {
  SurfaceCache surfaces;
  DrawList list;
  for (const Layer& layer : layers()) {
    if (!settings.is_on(layer.name)) continue;
    layer.draw({record, settings, settings.camera, surfaces, layer.name}, list);
    list.end_layer(layer.name);
  }
  if (const BodySet hidden = not_drawn(record, settings); !hidden.is_empty())
    list.leave_out([&](PickId pick) { return hidden.has(pick); });
  return legend_rows(record, list, settings, 1.0f, 6.0f, 60.0f);
}

const ShownRow* row_of_sleepers(const std::vector<ShownRow>& rows) {
  const auto it = std::find_if(rows.begin(), rows.end(),
                               [](const ShownRow& row) { return row.text.find("asleep") != std::string::npos; });
  return it == rows.end() ? nullptr : &*it;
}

}  // namespace

TEST_CASE("the legend says what a sleeping body's colour means, where one is seen in it") {
  HandMadeRecord scene;
  for (const char* name : {"a", "b", "c"}) scene.add(name, BodyKind::dynamic, Sphere{0.1}, Vec3::Zero());
  ViewSettings settings = make_view_settings();
  const auto row = [&](const ViewSettings& view) {
    static std::vector<ShownRow> rows;
    rows = rows_of(scene.record(), view);
    return row_of_sleepers(rows);
  };
  CHECK(row(settings) == nullptr);
  scene.record().bodies[1].asleep = scene.record().bodies[2].asleep = true;
  REQUIRE(row(settings) != nullptr);
  CHECK(row(settings)->color == asleep_color(series_color(1)));
  CHECK(row(settings)->color != series_color(1));
  ViewSettings other = settings;
  other.hidden = {"b"};  // the other one is still in the picture
  REQUIRE(row(other) != nullptr);
  CHECK(row(other)->color == asleep_color(series_color(2)));
  other.hidden = {"b", "c"};
  CHECK(row(other) == nullptr);
  other = settings;
  other.switch_layer("meshes", false);
  CHECK(row(other) == nullptr);
  other = settings;
  other.switch_layer("groups", true);  // whose colours are greyed likewise
  REQUIRE(row(other) != nullptr);
  CHECK(row(other)->color == asleep_color(role::kUngrouped));
  other = settings;
  other.switch_layer("heat", true);  // other colours, which say nothing of it
  CHECK(row(other) == nullptr);
}
