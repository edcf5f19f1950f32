#include "viewer/layers/view_bodies.hpp"

#include <catch2/catch.hpp>

#include "engine/core/settings_error.hpp"

#include "tests/support/pictures/hand_made_record.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

DrawList list_of(std::initializer_list<std::pair<const char*, std::vector<PickId>>> layers) {
  DrawList list;
  for (const auto& [name, picks] : layers) {
    for (const PickId pick : picks) {
      list.points.push_back({Vec3::Zero(), {}, 1.0f, Depth::on_top, pick});
      list.lines.push_back({Vec3::Zero(), Vec3::UnitX(), {}, 1.0f, Depth::tested, pick});
    }
    list.end_layer(name);
  }
  return list;
}

}  // namespace

TEST_CASE("what is left out of a draw list is gone, and layers keep what is theirs") {
  DrawList list = list_of({{"a", {1, 2, 1}}, {"none", {}}, {"b", {2, 2}}, {"c", {1, 0, 2, 3}}});
  list.labels.push_back({Vec3::Zero(), "two", {}, 2});
  list.labels.push_back({Vec3::Zero(), "three", {}, 3});
  list.leave_out([](PickId pick) { return pick == 2; });
  const DrawList wanted = list_of({{"a", {1, 1}}, {"none", {}}, {"b", {}}, {"c", {1, 0, 3}}});
  REQUIRE(list.points.size() == wanted.points.size());
  for (std::size_t i = 0; i < wanted.points.size(); ++i) CHECK(list.points[i].pick == wanted.points[i].pick);
  CHECK(list.lines.size() == wanted.lines.size());
  REQUIRE(list.layers.size() == wanted.layers.size());
  for (std::size_t i = 0; i < wanted.layers.size(); ++i) {
    CHECK(list.layers[i].points == wanted.layers[i].points);
    CHECK(list.layers[i].lines == wanted.layers[i].lines);
  }
  REQUIRE(list.labels.size() == 1);
  CHECK(list.labels[0].text == "three");
}

TEST_CASE("a contact is of a set of bodies if both its bodies are") {
  HandMadeRecord scene;
  const int a = scene.add("a", BodyKind::dynamic, Sphere{0.1}, {0, 0, 0}),
            b = scene.add("b", BodyKind::dynamic, Sphere{0.1}, {1, 0, 0}),
            c = scene.add("c", BodyKind::fixed, Sphere{0.1}, {2, 0, 0});
  scene.touch(a, b, Vec3::Zero(), Vec3::UnitY(), ContactState::stick);
  scene.touch(b, c, Vec3::Zero(), Vec3::UnitY(), ContactState::stick);
  const BodySet set(scene.record(), {"a", "b"});
  CHECK(set.has(contact_pick(0)));
  CHECK_FALSE(set.has(contact_pick(1)));
  CHECK(set.has(body_pick(static_cast<std::size_t>(a))));
  CHECK_FALSE(set.has(body_pick(static_cast<std::size_t>(c))));
  CHECK_FALSE(set.has(PickId(0)));
  CHECK(BodySet(scene.record(), {}).is_empty());
}

TEST_CASE("a camera that follows a body is as far from it as it was told, wherever the body is") {
  for (const Vec3& place : {Vec3(0, 0, 0), Vec3(3, -2, 100)}) {
    HandMadeRecord scene;
    scene.add("a", BodyKind::dynamic, Sphere{0.1}, {9, 9, 9});
    scene.add("ball", BodyKind::dynamic, Sphere{0.1}, place);
    ViewSettings settings;
    settings.camera.look_at({0, 1, 3}, {0, 0.5, 0});
    CHECK(camera_in_world(scene.record(), settings).eye == Vec3(0, 1, 3));
    settings.followed = "ball";
    const Camera camera = camera_in_world(scene.record(), settings);
    CHECK(camera.eye == place + Vec3(0, 1, 3));
    CHECK(camera.target == place + Vec3(0, 0.5, 0));
  }
}

TEST_CASE("names of bodies that are not there are told with the nearest one") {
  HandMadeRecord scene;
  scene.add("crate", BodyKind::dynamic, Sphere{0.1}, {0, 0, 0});
  ViewSettings settings;
  CHECK_NOTHROW(check_names(scene.record(), settings));
  settings.hidden = {"crate"};
  CHECK_NOTHROW(check_names(scene.record(), settings));
  settings.locked = {"crat"};
  try {
    check_names(scene.record(), settings);
    FAIL("a name that is not there is taken");
  } catch (const SettingsError& error) {
    CHECK(error.paths == std::vector<std::string>{"view.locked"});
    CHECK(error.what() == std::string("'crat' for view.locked; bodies: crate; did you mean 'crate'?"));
  }
}
