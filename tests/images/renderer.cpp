#include <catch2/catch.hpp>

#include "engine/shapes/primitives.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/pictures/easel.hpp"
#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

// marks without blue, so that the blue background's share tells how much of a pixel they cover
constexpr Color kInk = hex(0xff8000), kOtherInk = hex(0x00ff00);

ShadedSurfacePointer shaded(const TriangleMesh& mesh) {
  return std::make_shared<ShadedSurface>(make_shaded_surface(mesh, make_topology(mesh), 40.0));
}

ShadedSurfacePointer shaded(const SharedShape& shape) { return shaded(shape->drawn()); }

Camera front_camera(double distance = 4.0) {
  Camera camera;
  camera.look_at({0, 0, distance}, Vec3::Zero());
  return camera;
}

Pose at(const Vec3& position) { return {Mat3::Identity(), position}; }

/// Where a ray meets a triangle, in lengths of `direction`; 1e30 if it doesn't. By signed volumes.
double met_at(const Vec3& eye, const Vec3& direction, const std::array<Vec3, 3>& t) {
  const Vec3 a = t[0] - eye, b = t[1] - eye, c = t[2] - eye;
  const double u = direction.dot(b.cross(c)), v = direction.dot(c.cross(a)), w = direction.dot(a.cross(b));
  if ((u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0)) return 1e30;
  const double along = a.dot(b.cross(c)) / (u + v + w);
  return along > 0.0 ? along : 1e30;
}

/// The surface seen through each pixel's middle, by rays and brute force: its number, -1 where there is none, -2 where
/// a nudge of the ray would change the answer.
std::vector<int> seen_by_rays(const std::vector<DrawSurface>& surfaces, const Camera& camera, int width, int height) {
  const Mat3 axes = camera.view_rotation();
  const double tangent = std::tan(0.5 * camera.fov_deg * M_PI / 180.0);
  std::vector<std::pair<int, std::array<Vec3, 3>>> triangles;  // of which surface, corners
  for (std::size_t k = 0; k < surfaces.size(); ++k)
    for (const auto& t : surfaces[k].surface->triangles) {
      const auto corner = [&](int i) {
        return surfaces[k].pose.apply(surfaces[k].surface->positions[t[i]].cast<double>());
      };
      triangles.push_back({static_cast<int>(k), {corner(0), corner(1), corner(2)}});
    }
  const auto seen = [&](double px, double py) {
    const Vec3 ray((2.0 * px - width) / height * tangent, (height - 2.0 * py) / height * tangent, -1.0);
    const Vec3 direction = axes.transpose() * ray;
    double nearest = 1e30;
    int found = -1;
    for (const auto& [owner, corners] : triangles)
      if (const double along = met_at(camera.eye, direction, corners); along < nearest) nearest = along, found = owner;
    return found;
  };
  std::vector<int> out;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const int first = seen(x + 0.5, y + 0.5);
      bool sure = true;
      for (const auto& [dx, dy] : {std::pair{0.05, 0.0}, {-0.05, 0.0}, {0.0, 0.05}, {0.0, -0.05}})
        sure = sure && seen(x + 0.5 + dx, y + 0.5 + dy) == first;
      out.push_back(sure ? first : -2);
    }
  return out;
}

DrawList busy_list() {
  DrawList list;
  list.surfaces.push_back({shaded(Sphere{0.5}), at({-0.6, 0.5, 0}), series_color(0)});
  list.surfaces.push_back({shaded(Box{{0.4, 0.3, 0.2}}), at({0.6, 0.3, 0.2}), series_color(1), false, true});
  list.surfaces.push_back({shaded(Capsule{0.2, 0.3}), at({0.1, 0.6, -0.8}), series_color(2), true});
  list.planes.push_back({Vec3::UnitY(), 0.0, hex(0x3a4048)});
  for (const Depth depth : {Depth::tested, Depth::on_top, Depth::both}) {
    const double x = 0.3 * static_cast<int>(depth);
    list.points.push_back({{x - 0.6, 0.4, -0.3}, kInk, 9.0f, depth});
    list.lines.push_back({{x - 1.0, 0.1, -0.5}, {x + 0.6, 0.9, 0.4}, kOtherInk, 2.0f, depth});
    list.arrows.push_back({{x, 0.2, 0.6}, Vec3::UnitY(), kInk, 30.0f, 2.5f, depth});
    list.triangles.push_back({{Vec3(x, 1, 0), Vec3(x + 0.3, 1, 0), Vec3(x, 1.3, -0.4)}, kOtherInk, depth});
  }
  return list;
}

}  // namespace

TEST_CASE("every pixel shows the surface that a ray through its middle meets first", "[renderer]") {
  Random random(201);
  constexpr int kWidth = 96, kHeight = 54;
  Easel easel(kWidth, kHeight);
  const std::vector<ShadedSurfacePointer> shapes = {shaded(icosphere(1, 0.5)), shaded(Box{{0.6, 0.3, 0.4}}),
                                                    shaded(torus(0.6, 0.2, 16, 8)), shaded(Box{{0.2, 0.8, 0.3}})};
  for (int scene = 0; scene < 4; ++scene) {
    DrawList list;
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      DrawSurface item{shapes[i], {random.rotation(), 0.5 * random.vector()}, hex(i % 2 == 0 ? 0xff0000 : 0x00ff00)};
      if (i < 2 || scene > 1) list.surfaces.push_back(item);
    }
    Camera camera;
    camera.look_at(3.0 * random.direction(), Vec3::Zero());
    const Image image = easel.draw(list, camera);
    const std::vector<int> expected = seen_by_rays(list.surfaces, camera, kWidth, kHeight);
    int wrong = 0, sure = 0, covered = 0;
    for (int i = 0; i < kWidth * kHeight; ++i) {
      const std::uint8_t* p = image.rgb.data() + 3 * i;
      if (expected[i] == -2) continue;
      ++sure;
      covered += expected[i] >= 0;
      const bool background = is_color(p, easel.background);
      const bool right = expected[i] < 0 ? background : !background && (p[0] > p[1]) == (expected[i] % 2 == 0);
      wrong += !right;
    }
    CAPTURE(scene, sure, covered);
    CHECK(wrong == 0);
    CHECK(sure > 0.8 * kWidth * kHeight);
    CHECK(covered > 300);
  }
}

TEST_CASE("a sheet is seen from both sides, a solid from inside too", "[renderer]") {
  Easel easel;
  const auto covered = [&](const ShadedSurfacePointer& surface, const Vec3& eye) {
    DrawList list;
    list.surfaces.push_back({surface, Pose{}, hex(0xffff00)});
    Camera camera;
    camera.look_at(eye, eye.normalized() * -2.0);
    const Image image = easel.draw(list, camera);
    int n = 0;
    for (int y = 0; y < 180; ++y)
      for (int x = 0; x < 320; ++x) n += !is_color(image.pixel(x, y), easel.background, 0);
    return n;
  };
  const ShadedSurfacePointer flat = shaded(sheet(0.5, 2)), solid = shaded(icosphere(2, 1.0));
  CHECK_FALSE(flat->solid);
  CHECK(solid->solid);
  const int above = covered(flat, {0.2, 2, 0.1}), below = covered(flat, {0.2, -2, 0.1});
  CHECK(above > 2000);
  CHECK(below == Approx(above).margin(20));
  for (const double depth : {0.0001, 0.5, 0.9, 0.99}) CHECK(covered(solid, {0, 0, depth}) == 320 * 180);
  TriangleMesh inverted = icosphere(2, 1.0);  // drawn all the same, so that the fault is seen
  for (Triangle& t : inverted.triangles) std::swap(t[0], t[1]);
  CHECK_FALSE(shaded(inverted)->solid);
  CHECK(covered(shaded(inverted), {0, 0, 3}) == covered(solid, {0, 0, 3}));
}

TEST_CASE("a drawn sphere covers the area of its outline's ellipse", "[renderer]") {
  const double distance = 3.0, radius = 0.7;
  const Camera camera = front_camera(distance);
  DrawList list;
  list.surfaces.push_back({shaded(Sphere{radius}), Pose{}, hex(0xffff00)});
  const double focal = 90.0 / std::tan(0.5 * camera.fov_deg * M_PI / 180.0);
  const double outline = focal * radius / std::sqrt(distance * distance - radius * radius);
  Easel easel;
  const Image image = easel.draw(list, camera);
  double area = 0.0;
  Vec2 center = Vec2::Zero();
  for (int y = 0; y < 180; ++y)
    for (int x = 0; x < 320; ++x)
      if (!is_color(image.pixel(x, y), easel.background, 0)) area += 1.0, center += Vec2(x + 0.5, y + 0.5);
  CHECK(area == Approx(M_PI * outline * outline).epsilon(0.01));  // 1280 triangles lie 0.3 % inside
  CHECK((center / area - Vec2(160, 90)).norm() < 0.05);
}

TEST_CASE("a point is a disc of its diameter where the camera puts it", "[renderer]") {
  Random random(202);
  Easel easel;
  for (int i = 0; i < 30; ++i) {
    const Camera camera = front_camera();
    DrawPoint point{random.vector(), hex(0xff0000), static_cast<float>(random.in(4.0, 20.0))};
    DrawList list;
    list.points = {point};
    const Blot blot = blot_of(easel.draw(list, camera));
    const Vec3 expected = *camera.project(point.position, 320, 180);
    CHECK((blot.center - expected.head<2>()).norm() < 0.1);
    CHECK((blot.high - blot.low).minCoeff() > point.diameter - 1.0);
    CHECK((blot.high - blot.low).maxCoeff() < point.diameter + 5.0);  // with its dark rim on both sides
  }
}

TEST_CASE("a line has its width and ends where the camera puts them", "[renderer]") {
  Random random(203);
  Easel easel;
  const Camera camera = front_camera();
  for (int i = 0; i < 40; ++i) {
    const Vec3 a = random.vector(), b = random.vector();
    const float width = static_cast<float>(random.in(1.0, 5.0));
    const Vec2 pa = camera.project(a, 320, 180)->head<2>(), pb = camera.project(b, 320, 180)->head<2>();
    if ((pa - pb).norm() < 20.0) continue;
    DrawList list;
    list.lines = {{a, b, kInk, width, Depth::tested}};
    const Blot blot = blot_of(easel.draw(list, camera));
    CAPTURE(i, width, (pa - pb).norm());
    CHECK(blot.area == Approx((pa - pb).norm() * width).epsilon(0.03).margin(3.0 * width));
    CHECK((blot.center - 0.5 * (pa + pb)).norm() < 0.5);
    CHECK((blot.low - pa.cwiseMin(pb)).cwiseAbs().maxCoeff() < width + 2.0);
    CHECK((blot.high - pa.cwiseMax(pb)).cwiseAbs().maxCoeff() < width + 2.0);
  }
}

TEST_CASE("a line that starts behind the eye is drawn where it is in front, and only there", "[renderer]") {
  Easel easel;
  const Camera camera = front_camera(2.0);
  DrawList list;
  const Vec3 far_end(0.3, 0.2, -1.0), behind(0.1, -0.15, 4.0);
  list.lines = {{behind, far_end, kInk, 3.0f, Depth::tested}};
  const Image image = easel.draw(list, camera);
  const Vec2 end = camera.project(far_end, 320, 180)->head<2>();
  int on_line = 0, sampled = 0;
  for (double t = 0.0; t <= 1.0; t += 0.001) {
    const auto pixel = camera.project(behind + t * (far_end - behind), 320, 180);
    if (!pixel || pixel->z() < 0.3 || pixel->x() < 0 || pixel->x() >= 320 || pixel->y() < 0 || pixel->y() >= 180)
      continue;
    if ((pixel->head<2>() - end).norm() < 2.0) continue;  // its last pixel is covered in part
    ++sampled;
    on_line += is_color(image.pixel(static_cast<int>(pixel->x()), static_cast<int>(pixel->y())), kInk, 130);
  }
  CHECK(sampled > 100);
  CHECK(on_line == sampled);
  // the mirrored part, where a clipless projection would put it
  const Blot blot = blot_of(image);
  CHECK(blot.low.y() > end.y() - 4.0);
}

TEST_CASE("an arrow's length in pixels doesn't depend on its distance, in metres it does", "[renderer]") {
  Easel easel;
  for (const double distance : {2.0, 8.0, 40.0}) {
    const Camera camera = front_camera(distance);
    DrawList list;
    list.arrows = {{Vec3::Zero(), Vec3::UnitX(), kInk, 50.0f}};
    const Blot blot = blot_of(easel.draw(list, camera));
    CAPTURE(distance);
    CHECK(blot.high.x() - 160.0 == Approx(50.0).margin(2.5));
    CHECK(blot.low.x() == Approx(160.0).margin(2.5));
    list.arrows = {{Vec3::Zero(), Vec3(0.4, 0, 0), kInk}};
    const Vec3 tip = *camera.project({0.4, 0, 0}, 320, 180);
    if (tip.x() - 160.0 > 15.0) CHECK(blot_of(easel.draw(list, camera)).high.x() == Approx(tip.x()).margin(2.5));
  }
}

TEST_CASE("tested marks hide, marks on top don't, both are faint where hidden", "[renderer]") {
  Easel easel;
  const Camera camera = front_camera();
  const auto middle = [&](Depth depth, double z, bool line) {
    DrawList list;
    list.surfaces.push_back({shaded(Box{{0.6, 0.6, 0.2}}), Pose{}, hex(0x0000ff)});
    if (line)
      list.lines = {{{-0.5, 0, z}, {0.5, 0, z}, kOtherInk, 6.0f, depth}};
    else
      list.points = {{{0, 0, z}, kOtherInk, 12.0f, depth}};
    return static_cast<int>(easel.draw(list, camera).pixel(160, 90)[1]);  // green
  };
  DrawList bare;
  bare.surfaces.push_back({shaded(Box{{0.6, 0.6, 0.2}}), Pose{}, hex(0x0000ff)});
  const int nothing = easel.draw(bare, camera).pixel(160, 90)[1];
  for (const bool line : {false, true}) {
    CAPTURE(line);
    for (const Depth depth : {Depth::tested, Depth::on_top, Depth::both}) CHECK(middle(depth, 0.5, line) > 225);
    CHECK(middle(Depth::tested, -0.5, line) == nothing);
    CHECK(middle(Depth::on_top, -0.5, line) > 225);
    CHECK(middle(Depth::both, -0.5, line) > nothing + 30);
    CHECK(middle(Depth::both, -0.5, line) < 180);
    CHECK(middle(Depth::tested, 0.2, line) > 225);  // what lies in the surface itself is seen
  }
}

TEST_CASE("a list gives the same pixels whatever was drawn before, and by another renderer", "[renderer]") {
  const DrawList list = busy_list();
  Camera camera, other;
  camera.look_at({1.5, 1.4, 2.5}, {0, 0.4, 0});
  other.look_at({-1, 4, 1}, {0, 0, 0});
  for (const bool smooth : {false, true}) {
    Easel first, second;
    const Image fresh = first.draw(list, camera, 1.0f, smooth);
    CHECK(second.draw(list, camera, 1.0f, smooth) == fresh);
    DrawList few;
    few.surfaces.push_back({shaded(Sphere{2.0}), Pose{}, series_color(4)});
    const Image covered = first.draw(few, other, 1.0f, smooth);
    CHECK_FALSE(covered == fresh);
    first.draw(DrawList{}, other, 3.0f, !smooth);
    CHECK(first.draw(list, camera, 1.0f, smooth) == fresh);
    CHECK(second.draw(few, other, 1.0f, smooth) == covered);
  }
}

TEST_CASE("without marks and surfaces there is the backdrop alone", "[renderer]") {
  Easel easel;
  const Image image = easel.draw(DrawList{}, Camera{});
  CHECK(blot_of(image).area == 0.0);
}

TEST_CASE("a scene far from the origin looks as it does at the origin", "[renderer]") {
  Easel easel;
  const Vec3 far_away(1e6, 2e6, -3e6);
  DrawList list = busy_list(), moved = list;
  list.planes.clear();  // the grid's lines are the world's: they need not repeat there
  moved.planes.clear();
  for (DrawSurface& s : moved.surfaces) s.pose.position += far_away;
  for (DrawPoint& p : moved.points) p.position += far_away;
  for (DrawLine& l : moved.lines) l.a += far_away, l.b += far_away;
  for (DrawArrow& a : moved.arrows) a.tail += far_away;
  for (DrawTriangle& t : moved.triangles)
    for (Vec3& c : t.corners) c += far_away;
  Camera camera;
  camera.look_at({1.5, 1.4, 2.5}, {0, 0.4, 0});
  const Image near_picture = easel.draw(list, camera);
  camera.look_at(camera.eye + far_away, camera.target + far_away);
  const Image far_picture = easel.draw(moved, camera);
  CHECK(blot_of(near_picture).area > 2000.0);
  CHECK(count_differing(near_picture, far_picture) < 30);
}

TEST_CASE("marks keep their share of a picture of twice the size", "[renderer]") {
  Easel small(320, 180), large(640, 360);
  const Camera camera = front_camera();
  DrawList list;
  list.points = {{{-0.5, 0.2, 0}, kInk, 10.0f}};
  list.lines = {{{-0.2, -0.4, 0}, {0.9, 0.1, 0}, kInk, 3.0f, Depth::tested}};
  list.arrows = {{{0.2, 0.3, 0}, Vec3::UnitX(), kInk, 40.0f}};
  const Blot one = blot_of(small.draw(list, camera, 1.0f)), two = blot_of(large.draw(list, camera, 2.0f));
  CHECK(two.area == Approx(4.0 * one.area).epsilon(0.03));
  CHECK((0.5 * two.center - one.center).norm() < 0.5);
}
