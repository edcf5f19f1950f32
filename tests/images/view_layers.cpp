#include <catch2/catch.hpp>
#include <set>

#include "tests/support/pictures/view_scenes.hpp"
#include "viewer/layers/layer.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

bool differs_at(const Image& a, const Image& b, int x, int y) {
  return !std::equal(a.pixel(x, y), a.pixel(x, y) + 3, b.pixel(x, y));
}

int changed_pixels(const Image& a, const Image& b) {
  int count = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) count += differs_at(a, b, x, y);
  return count;
}

/// Changed pixels within `reach` of where a world point appears.
int changed_near(const Image& a, const Image& b, const Camera& camera, const Vec3& point, int reach) {
  const auto at = camera.project(point, a.width, a.height);
  REQUIRE(at);
  int count = 0;
  for (int y = std::max(0, static_cast<int>(at->y()) - reach);
       y <= std::min(a.height - 1, static_cast<int>(at->y()) + reach); ++y)
    for (int x = std::max(0, static_cast<int>(at->x()) - reach);
         x <= std::min(a.width - 1, static_cast<int>(at->x()) + reach); ++x)
      count += differs_at(a, b, x, y);
  return count;
}

}  // namespace

TEST_CASE("layers have distinct names and each says what it draws", "[methods]") {
  std::set<std::string_view> names;
  for (const Layer& layer : layers()) {
    CHECK(names.insert(layer.name).second);
    CHECK_FALSE(layer.doc.empty());
  }
  for (const char* name :
       {"meshes",       "wireframe",   "aabbs",          "contacts",    "normals",   "contact_forces", "gaps",
        "stress",       "strain",      "tetrahedra",     "fixed_nodes", "embedding", "attachments",    "velocities",
        "mass_centers", "broad_pairs", "triangle_pairs", "groups",      "labels",    "heat",           "pulls"})
    CHECK(names.count(name) == 1);
}

TEST_CASE("every layer changes the picture, and no two in the same way", "[methods]") {
  // of rigid bodies, of which one is pulled, beside one of deformable ones
  StepRecord rigid = sample_record();
  BodyRecord& last = rigid.bodies.back();
  last.pull = {last.pose.position, last.pose.position + Vec3(0.3, 0.5, 0)};
  const auto both = [&](const std::vector<std::string>& names) {
    Image image = painted(rigid, settings_with(names)), soft = painted(soft_record(), settings_with(names));
    image.rgb.insert(image.rgb.end(), soft.rgb.begin(), soft.rgb.end());
    image.height *= 2;
    return image;
  };
  const Image base = both({"meshes"});
  std::vector<Image> pictures;
  for (const Layer& layer : layers()) {
    if (layer.name == "meshes") continue;
    CAPTURE(layer.name);
    pictures.push_back(both({"meshes", std::string(layer.name)}));
    CHECK(changed_pixels(base, pictures.back()) > 20);
  }
  for (std::size_t i = 0; i < pictures.size(); ++i)
    for (std::size_t k = i + 1; k < pictures.size(); ++k) CHECK(changed_pixels(pictures[i], pictures[k]) > 20);
}

TEST_CASE("marks appear where their bodies and contacts are, and nowhere else") {
  const ViewSettings plain = settings_with({"meshes"});
  const Image base = painted(sample_record(), plain);
  const Image contacts = painted(sample_record(), settings_with({"meshes", "contacts"}));
  int near = 0;
  for (const ContactRecord& c : sample_record().contacts) {
    const int here = changed_near(base, contacts, plain.camera, 0.5 * (c.point_a + c.point_b), 5);
    CHECK(here > 8);
    near += here;
  }
  CHECK(changed_pixels(base, contacts) <= near);  // discs may share pixels, so near counts at least all of them

  const Image normals = painted(sample_record(), settings_with({"meshes", "normals"}));
  for (const ContactRecord& c : sample_record().contacts) {
    // within the arrow, which is arrow_length pixels long in a picture 720 high, half of that in small ones, less where
    // open
    const double length = 0.25 * plain.arrow_length * plain.camera.pixel_size_at(c.point_b, base.height);
    CHECK(changed_near(base, normals, plain.camera, 0.5 * (c.point_a + c.point_b) + length * c.normal, 2) > 4);
  }

  const Image boxes = painted(sample_record(), settings_with({"meshes", "aabbs"}));
  for (const BodyRecord& body : sample_record().bodies) {
    const bool moves = body.kind != BodyKind::fixed;
    if (body.shape->as<Plane>() != nullptr) continue;
    CAPTURE(std::string(body.name));
    if (moves) CHECK(changed_near(base, boxes, plain.camera, body.bounds.max, 2) > 2);
  }
}

TEST_CASE("an attached point has lines to the middles of the bodies that it holds") {
  HandMadeRecord scene;
  const BodyIndex a(scene.add("a", BodyKind::dynamic, Sphere{0.1}, {-0.8, 0, 0})),
      b(scene.add("b", BodyKind::dynamic, Sphere{0.1}, {0.8, 0.3, 0}));
  ViewSettings settings = settings_with({"attachments"});
  settings.camera.look_at({0, 0, 4}, {0, 0, 0});
  const Image bare = painted(scene.record(), settings);
  const Vec3 at(0.1, -0.4, 0);
  const auto on_the_way = [&](const Image& image, const Vec3& to) {
    return changed_near(bare, image, settings.camera, 0.4 * at + 0.6 * to, 2);
  };
  scene.record().attachments = {{"both", a, b, at, at}};
  const Image both = painted(scene.record(), settings);
  CHECK(on_the_way(both, {-0.8, 0, 0}) > 2);
  CHECK(on_the_way(both, {0.8, 0.3, 0}) > 2);
  scene.record().attachments = {{"to_the_world", a, {}, at, at}};
  const Image one = painted(scene.record(), settings);
  CHECK(on_the_way(one, {-0.8, 0, 0}) > 2);
  CHECK(on_the_way(one, {0.8, 0.3, 0}) == 0);
}

TEST_CASE("contacts are told apart by state") {
  HandMadeRecord scene;
  const int a = scene.add("a", BodyKind::dynamic, Sphere{0.1}, {0, 5, 0});
  ViewSettings settings = settings_with({"contacts"});
  settings.camera.look_at({0, 0, 4}, {0, 0, 0});
  std::vector<std::array<int, 3>> colors;
  for (const ContactState state : {ContactState::open, ContactState::stick, ContactState::slip}) {
    HandMadeRecord one;
    one.add("a", BodyKind::dynamic, Sphere{0.1}, {0, 5, 0});
    one.touch(a, a, Vec3::Zero(), Vec3::UnitY(), state);
    const Image image = painted(one.record(), settings);
    const std::uint8_t* middle = image.pixel(image.width / 2, image.height / 2);
    colors.push_back({middle[0], middle[1], middle[2]});
  }
  for (int i = 0; i < 3; ++i)
    for (int k = i + 1; k < 3; ++k) {
      int distance = 0;
      for (int c = 0; c < 3; ++c) distance = std::max(distance, std::abs(colors[i][c] - colors[k][c]));
      CHECK(distance > 60);
    }
}

TEST_CASE("a wall hides nothing when it stands between the eye and what it looks at") {
  HandMadeRecord open, walled, blocked;
  for (HandMadeRecord* scene : {&open, &walled, &blocked})
    scene->add("ball", BodyKind::dynamic, Sphere{0.4}, Vec3::Zero());
  walled.add("wall", BodyKind::fixed, Box{{2.0, 2.0, 0.05}}, {0, 0, 1.5});
  blocked.add("thick", BodyKind::fixed, Box{{2.0, 2.0, 1.0}}, {0, 0, 2.0});
  ViewSettings settings = settings_with({"meshes"});
  settings.camera.look_at({0, 0, 6}, {0, 0, 0});
  const auto middle = [&](const HandMadeRecord& scene) {
    const Image image = painted(scene.record(), settings);
    const std::uint8_t* p = image.pixel(image.width / 2, image.height / 2);
    return std::array<int, 3>{p[0], p[1], p[2]};
  };
  const auto seen = middle(open), through = middle(walled), hidden = middle(blocked);
  for (int c = 0; c < 3; ++c) CHECK(std::abs(seen[c] - through[c]) < 30);
  CHECK(std::abs(seen[2] - hidden[2]) + std::abs(seen[0] - hidden[0]) > 60);

  // from inside, the wall behind what is looked at is solid
  HandMadeRecord behind;
  behind.add("wall", BodyKind::fixed, Box{{2.0, 2.0, 0.05}}, {0, 0, -1.5});
  const Image with = painted(behind.record(), settings), without = painted(StepRecord{}, settings);
  int changed = 0;
  for (int c = 0; c < 3; ++c) changed = std::max(changed, std::abs(with.pixel(160, 90)[c] - without.pixel(160, 90)[c]));
  CHECK(changed > 40);
}

TEST_CASE("a floor is drawn from above and left out from below") {
  HandMadeRecord scene;
  scene.add("floor", BodyKind::fixed, Plane{Vec3::UnitY(), 0.0}, Vec3::Zero());
  ViewSettings settings = settings_with({"meshes"});
  settings.camera.look_at({0, 2, 4}, {0, 0, 0});
  CHECK(changed_pixels(painted(scene.record(), settings), painted(StepRecord{}, settings)) > 5000);
  settings.camera.look_at({0, -2, 4}, {0, 0, 0});
  CHECK(changed_pixels(painted(scene.record(), settings), painted(StepRecord{}, settings)) == 0);
}
