// Bodies in which others are: what is inside is to be seen where the surface round it would hide all of it.
#include <catch2/catch.hpp>

#include <algorithm>

#include "tests/support/geometry/meshes.hpp"
#include "tests/support/pictures/view_scenes.hpp"
#include "viewer/layers/container.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// A box of two metres about the origin, `is_open` without its top, with a ball at a place.
void make_box(HandMadeRecord& scene, bool is_open, const Vec3& place, BodyKind kind = BodyKind::fixed) {
  TriangleMesh mesh = box(Vec3::Ones(), {3, 3, 3});
  const auto is_top = [&](const Triangle& t) {
    return std::all_of(t.begin(), t.end(),
                       [&](int v) { return mesh.vertices[static_cast<std::size_t>(v)].y() > 0.99; });
  };
  if (is_open) std::erase_if(mesh.triangles, is_top);
  scene.add("box", kind, surface(std::move(mesh)), Vec3::Zero());
  scene.add("ball", BodyKind::dynamic, Sphere{0.3}, place);
}

bool hides(bool is_open, const Vec3& place, const Vec3& eye, BodyKind kind = BodyKind::fixed, std::size_t body = 0) {
  HandMadeRecord scene;
  make_box(scene, is_open, place, kind);
  return hides_what_is_inside(scene.record(), body, eye);
}

Image picture_with_ball_at(const Vec3& place) {
  HandMadeRecord scene;
  make_box(scene, false, place);
  return painted(scene.record(), settings_with({"meshes"}));
}

}  // namespace

TEST_CASE("a container hides what is inside from an eye outside, all of it and nothing else") {
  const Vec3 beside(4.0, 0.5, 3.0), above(0.3, 5.0, 0.2), within(0.8, 0.8, 0.8);
  for (const BodyKind kind : {BodyKind::fixed, BodyKind::scripted, BodyKind::dynamic})
    for (const bool is_open : {false, true}) CHECK(hides(is_open, Vec3::Zero(), beside, kind));
  CHECK(hides(false, Vec3::Zero(), above));
  CHECK_FALSE(hides(true, Vec3::Zero(), above));
  CHECK_FALSE(hides(false, Vec3::Zero(), within));
  CHECK_FALSE(hides(false, Vec3(0.0, 0.0, 0.9), beside));  // it sticks out
  CHECK_FALSE(hides(false, Vec3::Zero(), beside, BodyKind::fixed, 1));
}

TEST_CASE("what is in a closed box is in its picture") {
  CHECK(picture_with_ball_at(Vec3(0.2, 0.0, 0.0)).rgb != picture_with_ball_at(Vec3(-0.2, 0.1, 0.0)).rgb);
}
