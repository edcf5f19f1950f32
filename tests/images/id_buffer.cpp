// The id buffer against rays cast one by one.
#include <catch2/catch.hpp>

#include <map>
#include <set>

#include "engine/core/error.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/pictures/hand_made_record.hpp"
#include "tests/support/pictures/view_scenes.hpp"
#include "tests/support/program/temp_folder.hpp"
#include "viewer/image/id_image.hpp"
#include "viewer/layers/layer.hpp"
#include "viewer/present/frame_painter.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// World-space triangles of every mesh, box and (finely) ball of the record, found by brute force.
struct Hit {
  int body = -1, triangle = -1;
  double distance = 1e300;
};

void cast_at(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles, int body, const Vec3& eye,
             const Vec3& way, Hit& hit) {
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Vec3 &a = vertices[static_cast<std::size_t>(triangles[t][0])],
               &b = vertices[static_cast<std::size_t>(triangles[t][1])],
               &c = vertices[static_cast<std::size_t>(triangles[t][2])];
    Mat3 m;
    m << b - a, c - a, -way;
    if (std::abs(m.determinant()) < 1e-14) continue;
    const Vec3 uvs = m.inverse() * (eye - a);
    if (uvs[0] < 0 || uvs[1] < 0 || uvs[0] + uvs[1] > 1 || uvs[2] <= 0 || uvs[2] >= hit.distance) continue;
    hit = {body, static_cast<int>(t), uvs[2]};
  }
}

void cast_at_ball(const Vec3& center, double radius, int body, const Vec3& eye, const Vec3& way, Hit& hit) {
  const double b = way.dot(center - eye), c = (center - eye).squaredNorm() - radius * radius, root = b * b - c;
  if (root < 0 || b - std::sqrt(root) >= hit.distance) return;
  hit = {body, -1, b - std::sqrt(root)};
}

}  // namespace

TEST_CASE("each pixel names the body, and of a mesh the triangle, that a ray through it meets first") {
  HandMadeRecord scene;
  const MeshPointer stone = surface(scaled_to(bumpy_sphere(3), 0.8)), ring = surface(torus(0.32, 0.12, 24, 12));
  scene.add("stone", BodyKind::dynamic, stone, {-0.3, 0.3, 0.0});
  scene.add("ring", BodyKind::dynamic, ring, {0.2, 0.35, 0.4},
            Eigen::AngleAxisd(1.1, Vec3::UnitX()).toRotationMatrix());
  scene.add("ball", BodyKind::dynamic, Sphere{0.3}, {0.35, 0.4, -0.3});
  const StepRecord& record = scene.record();
  ViewSettings settings = settings_with({"meshes"});
  settings.camera.look_at({0.4, 0.9, 2.2}, {0.0, 0.3, 0.0});
  settings.camera_given = true;
  constexpr int kWidth = 160, kHeight = 90;
  FramePainter painter(kWidth, kHeight);
  Image image;
  IdImage ids;
  painter.paint(record, settings, image, ids);
  REQUIRE(ids.width == kWidth);
  REQUIRE(ids.object.size() == std::size_t{kWidth} * kHeight);

  const Camera& camera = settings.camera;
  const Mat3 rotation = camera.view_rotation();
  const double focal = 0.5 * kHeight / std::tan(0.5 * camera.fov_deg * M_PI / 180.0);
  int wrong_body = 0, wrong_triangle = 0, on_bodies = 0, on_meshes = 0;
  std::set<int> bodies;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const Vec3 way =
          (rotation.transpose() * Vec3((x + 0.5 - 0.5 * kWidth) / focal, (0.5 * kHeight - y - 0.5) / focal, -1.0))
              .normalized();
      Hit hit;
      cast_at(std::vector<Vec3>(record.bodies[0].vertices.begin(), record.bodies[0].vertices.end()),
              stone->mesh.triangles, 0, camera.eye, way, hit);
      cast_at(std::vector<Vec3>(record.bodies[1].vertices.begin(), record.bodies[1].vertices.end()),
              ring->mesh.triangles, 1, camera.eye, way, hit);
      cast_at_ball({0.35, 0.4, -0.3}, 0.3, 2, camera.eye, way, hit);
      const IdObject* object = ids.object_at(x, y);
      wrong_body += (object == nullptr ? -1 : object->body_index) != hit.body;
      if (hit.body >= 0) ++on_bodies, bodies.insert(hit.body);
      if (object == nullptr || hit.triangle < 0 || object->body_index != hit.body) continue;
      ++on_meshes;
      CHECK(object->layer == "meshes");
      CHECK(object->mark == "surface");
      CHECK(object->body == record.bodies[static_cast<std::size_t>(hit.body)].name);
      wrong_triangle += ids.part[static_cast<std::size_t>(y) * kWidth + x] != static_cast<std::uint32_t>(hit.triangle);
    }
  CHECK(bodies.size() == 3);
  CHECK(on_bodies > 2000);
  CHECK(on_meshes > 1000);
  // rays that graze an edge may go either way: single precision, and a ball drawn as flat facets
  CHECK(wrong_body <= on_bodies / 100);
  CHECK(wrong_triangle <= on_meshes / 50);
}

TEST_CASE("the picture is the same with ids and without, and so are its ids whatever was painted before") {
  std::vector<std::string> names;
  for (const Layer& layer : layers()) names.emplace_back(layer.name);
  ViewSettings full = settings_with(names);
  full.show_figures = full.show_legend = true;
  ViewSettings clipped = settings_with({"meshes", "contacts", "aabbs"});
  clipped.clip = {true, {0.0, 0.0, 1.0}, 0.1};
  FramePainter with(480, 270), without(480, 270);
  Image a, b;
  IdImage first, again;
  for (const auto& [record, settings] :
       {std::pair{&sample_record(), &full}, {&soft_record(), &full}, {&sample_record(), &clipped}}) {
    with.paint(*record, *settings, a, first);
    without.paint(*record, *settings, b);
    CHECK(a == b);
    with.paint(*record, *settings, a, again);
    CHECK(a == b);
    CHECK(first.object == again.object);
    CHECK(first.part == again.part);
  }
}

TEST_CASE("marks are told apart by layer, kind and contact, and panels hide what is behind them") {
  StepRecord record = sample_record();
  for (std::size_t i = 0; i < record.contacts.size(); ++i) record.contacts[i].pair_id = 100 + i;
  ViewSettings settings = settings_with({"meshes", "contacts", "normals", "aabbs"});
  settings.show_figures = true;
  FramePainter painter(640, 360);
  Image image;
  IdImage ids;
  painter.paint(record, settings, image, ids);
  keep_visible_objects(ids);
  std::map<std::string, std::set<std::uint64_t>> contacts;  // by layer
  std::set<std::string> layers_seen, bodies;
  for (const IdObject& object : ids.objects) {
    layers_seen.insert(object.layer);
    if (object.contact_index >= 0) {
      const ContactRecord& c = record.contacts[static_cast<std::size_t>(object.contact_index)];
      CHECK(object.identity == c.pair_id);
      CHECK(object.body == record.bodies[static_cast<std::size_t>(c.body_a)].name);
      CHECK(object.other == record.bodies[static_cast<std::size_t>(c.body_b)].name);
      contacts[object.layer + " " + object.mark].insert(object.identity);
    } else if (object.mark == "surface" || object.mark == "fixed surface") {
      CHECK((object.mark == "surface") ==
            (record.bodies[static_cast<std::size_t>(object.body_index)].kind != BodyKind::fixed));
      bodies.insert(object.body);
    }
  }
  CHECK(layers_seen == std::set<std::string>{"meshes", "contacts", "normals", "aabbs", "panels"});
  CHECK(contacts["contacts point"].size() == record.contacts.size());
  CHECK(contacts["normals arrow"].size() == record.contacts.size());
  CHECK(bodies.size() == record.bodies.size());
  // each contact's point is where the camera sees it
  for (const ContactRecord& c : record.contacts) {
    const auto at = settings.camera.project(0.5 * (c.point_a + c.point_b), 640, 360);
    REQUIRE(at);
    bool found = false;
    for (int dy = -6; dy <= 6; ++dy)
      for (int dx = -6; dx <= 6; ++dx) {
        const IdObject* o = ids.object_at(static_cast<int>(at->x()) + dx, static_cast<int>(at->y()) + dy);
        found = found || (o != nullptr && o->mark == "point" && o->identity == c.pair_id);
      }
    CAPTURE(c.pair_id);
    CHECK(found);
  }
  const IdObject* corner = ids.object_at(20, 20);
  REQUIRE(corner != nullptr);
  CHECK(corner->layer == "panels");
  CHECK(corner->mark == "figures");
}

TEST_CASE("an id picture reads back as it was written, another picture is refused") {
  const TempFolder folder;
  StepRecord record = sample_record();
  for (std::size_t i = 0; i < record.contacts.size(); ++i) record.contacts[i].pair_id = 0xfedcba9876543210u + i;
  FramePainter painter(320, 180);
  Image image;
  IdImage ids;
  painter.paint(record, settings_with({"meshes", "contacts", "velocities"}), image, ids);
  // an object that no pixel shows, in the middle of the table
  const std::vector<IdObject> all = ids.objects;
  IdObject hidden;
  hidden.body = "hidden";
  ids.objects.insert(ids.objects.begin() + 2, hidden);
  for (std::uint32_t& i : ids.object) i += i > 2;
  keep_visible_objects(ids);
  REQUIRE(ids.objects.size() == all.size());
  for (std::size_t i = 0; i < all.size(); ++i) CHECK(ids.objects[i].is_same_as(all[i]));
  write_png(folder / "ids.png", id_picture(ids), id_text(ids));
  const IdImage read = read_ids(folder / "ids.png");
  CHECK(read.object == ids.object);
  REQUIRE(read.objects.size() == ids.objects.size());
  for (std::size_t i = 0; i < read.objects.size(); ++i) CHECK(read.objects[i].is_same_as(ids.objects[i]));
  write_png(folder / "plain.png", image);
  CHECK_THROWS_AS(read_ids(folder / "plain.png"), InputError);
  // an index beyond the table
  Image beyond = id_picture(ids);
  beyond.pixel(3, 3)[0] = 255;
  write_png(folder / "beyond.png", beyond, id_text(ids));
  CHECK_THROWS_AS(read_ids(folder / "beyond.png"), InputError);
}
