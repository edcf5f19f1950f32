#include <catch2/catch.hpp>

#include "engine/core/error.hpp"
#include "viewer/layers/layer.hpp"

using namespace impinge;

namespace {

void put(const ParameterSet& rows, const char* path, const char* text) {
  const Parameter* row = rows.find(path);
  REQUIRE(row != nullptr);
  row->set(checked_value(*row, parse_value(*row, text)));
}

}  // namespace

TEST_CASE("the view's rows switch layers one by one and as a list") {
  ViewSettings settings = make_view_settings();
  ParameterSet rows;
  settings.bind(rows);
  CHECK(settings.is_on("meshes"));
  put(rows, "view.layers", "[normals, contacts]");
  CHECK(settings.layers_on() == std::vector<std::string>{"normals", "contacts"});
  CHECK_FALSE(settings.is_on("meshes"));
  put(rows, "view.layer.aabbs", "true");
  put(rows, "view.layer.normals", "false");
  CHECK(settings.layers_on() == std::vector<std::string>{"aabbs", "contacts"});
  CHECK(std::get<std::vector<std::string>>(rows.find("view.layers")->get()) == settings.layers_on());
  for (const Layer& layer : layers()) CHECK(rows.find("view.layer." + std::string(layer.name)) != nullptr);
}

TEST_CASE("a layer that is not there is refused with the nearest name") {
  ViewSettings settings = make_view_settings();
  ParameterSet rows;
  settings.bind(rows);
  CHECK_THROWS_WITH(put(rows, "view.layers", "[meshes, contcts]"), Catch::Contains("contacts"));
  CHECK_THROWS_AS(settings.switch_layer("normal", true), InputError);
  CHECK_THROWS_WITH(settings.switch_layer("normal", true), Catch::Contains("did you mean 'normals'"));
  CHECK(settings.is_on("meshes"));
}

TEST_CASE("the camera is given once eye or target is") {
  ViewSettings settings = make_view_settings();
  ParameterSet rows;
  settings.bind(rows);
  put(rows, "view.camera.fov", "55");
  CHECK_FALSE(settings.camera_given);
  CHECK(settings.camera.fov_deg == 55.0);
  put(rows, "view.camera.eye", "[1, 2, 3]");
  CHECK(settings.camera_given);
  CHECK(settings.camera.eye == Vec3(1, 2, 3));
  CHECK_THROWS_AS(put(rows, "view.camera.fov", "0"), InputError);
}
