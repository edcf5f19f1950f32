// Deformable bodies and cut surfaces in pictures, against rigid bodies of the same form and against rays.
#include <catch2/catch.hpp>

#include "engine/geometry/tets/tet_cage.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/pictures/view_scenes.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

Vec3 bent(const Vec3& p) {
  return {p.x() + 0.4 * p.y() * p.y(), 0.8 * p.y() + 0.2 * p.x(), p.z() * (1.0 + 0.5 * p.y())};
}

struct Caged {
  MeshPointer surface;
  TetCage cage;
};

const Caged& caged_lump() {
  static const Caged caged = [] {
    const MeshPointer lump = surface(scaled_to(bumpy_sphere(3), 1.2));
    return Caged{lump, make_tet_cage(lump->mesh, {.cells = 4, .rays_per_cell = 8})};
  }();
  return caged;
}

int add_bent(HandMadeRecord& scene, const Vec3& shift = Vec3::Zero()) {
  const Caged& c = caged_lump();
  return scene.add_soft("lump", c.surface, c.cage.mesh, c.cage.embedding,
                        [&](const Vec3& p) { return Vec3(bent(p) + shift); });
}

/// Pixels that differ by more than `levels`.
int count_unlike(const Image& a, const Image& b, int levels) {
  int count = 0;
  for (std::size_t i = 0; i < a.rgb.size(); i += 3) {
    int most = 0;
    for (std::size_t c = i; c < i + 3; ++c) most = std::max(most, std::abs(a.rgb[c] - b.rgb[c]));
    count += most > levels;
  }
  return count;
}

int covered_pixels(const Image& image) {
  const Image nothing = painted(StepRecord{}, settings_with({}), image.width, image.height);
  return count_unlike(image, nothing, 0);
}

}  // namespace

TEST_CASE("a deformed body looks like a rigid one of the same form") {
  HandMadeRecord soft, rigid;
  const MeshPointer round = surface(icosphere(4, 0.6));  // without creases, before and after
  const TetCage cage = make_tet_cage(round->mesh, {.cells = 4, .rays_per_cell = 4});
  soft.add_soft("lump", round, cage.mesh, cage.embedding, bent);
  TriangleMesh mesh = round->mesh;
  mesh.vertices.assign(soft.record().bodies[0].vertices.begin(), soft.record().bodies[0].vertices.end());
  rigid.add("lump", BodyKind::dynamic, surface(mesh), Vec3::Zero());
  for (const char* layer : {"meshes", "wireframe", "aabbs"}) {
    CAPTURE(layer);
    const Image a = painted(soft.record(), settings_with({layer})), b = painted(rigid.record(), settings_with({layer}));
    CHECK(covered_pixels(a) > 500);
    CHECK(count_unlike(a, b, 3) < 8);
  }
}

TEST_CASE("a deformed body is drawn where it is now, whatever it was before") {
  HandMadeRecord scene;
  add_bent(scene);
  const Image first = painted(scene.record(), settings_with({"meshes"}));
  HandMadeRecord moved;
  add_bent(moved, {0.3, 0.0, 0.0});
  const Image second = painted(moved.record(), settings_with({"meshes"}));
  CHECK(count_unlike(first, second, 10) > 500);
  CHECK(painted(scene.record(), settings_with({"meshes"})) == first);
  // the same body far away: the same picture, but for roundings along edges
  HandMadeRecord far_away;
  const Vec3 shift(1e6, 2e6, -3e6);
  add_bent(far_away, shift);
  ViewSettings settings = settings_with({"meshes"});
  settings.camera.look_at(settings.camera.eye + shift, settings.camera.target + shift);
  CHECK(count_unlike(painted(far_away.record(), settings), first, 6) < 40);
}

TEST_CASE("what is turned inside out is not left out of the picture") {
  HandMadeRecord upright, everted;
  add_bent(upright);
  const Caged& c = caged_lump();
  everted.add_soft("lump", c.surface, c.cage.mesh, c.cage.embedding, [](const Vec3& p) {
    const Vec3 q = bent(p);
    return Vec3(-q.x(), q.y(), q.z());  // the mirror image: all triangles face inwards
  });
  ViewSettings settings = settings_with({"meshes"});
  settings.camera.look_at({0.0, 1.0, 4.0}, Vec3::Zero());
  const int right = covered_pixels(painted(upright.record(), settings)),
            mirrored = covered_pixels(painted(everted.record(), settings));
  CHECK(mirrored == Approx(right).epsilon(0.01));
  // and marked among the tetrahedra
  ViewSettings tetrahedra = settings_with({"tetrahedra"});
  tetrahedra.camera = settings.camera;
  const auto red = [](const Image& image) {
    int count = 0;
    for (std::size_t i = 0; i < image.rgb.size(); i += 3)
      count += image.rgb[i] > 180 && image.rgb[i + 1] < 100 && image.rgb[i + 2] < 100;
    return count;
  };
  for (const char* style : {"wire", "shrunk"}) {
    CAPTURE(style);
    set(tetrahedra, "view.tetrahedra.style", style);
    CHECK(red(painted(everted.record(), tetrahedra)) > 300);
    CHECK(red(painted(upright.record(), tetrahedra)) == 0);
  }
}

TEST_CASE("a cut sphere shows what rays meet on the side that is left", "[renderer]") {
  const double radius = 0.9;
  HandMadeRecord scene;
  scene.add("ball", BodyKind::dynamic, surface(icosphere(4, radius)), Vec3::Zero());
  ViewSettings settings = settings_with({"meshes"});
  settings.antialiasing = false;
  settings.camera.look_at({0.6, 0.9, 3.0}, Vec3::Zero());
  const Image whole = painted(scene.record(), settings), nothing = painted(StepRecord{}, settings);
  const Mat3 axes = settings.camera.view_rotation();
  const double tangent = std::tan(0.5 * settings.camera.fov_deg * M_PI / 180.0);
  enum Seen { unsure, front, back, gone_by_cut };
  for (const auto& [normal, offset] : {std::pair{Vec3(0, 0, 2.0), 0.2},
                                       {Vec3(1, 1, 1), -0.3},
                                       {Vec3(0, -1, 0), 0.0},
                                       {Vec3(0, 0, 1), 2.0},
                                       {Vec3(0, 0, 1), -2.0}}) {
    settings.clip = {true, normal, offset};
    const Image cut = painted(scene.record(), settings);
    const auto seen = [&](int x, int y) {
      const Vec3 ray = axes.transpose() * Vec3((2.0 * x + 1.0 - cut.width) / cut.height * tangent,
                                               (cut.height - 2.0 * y - 1.0) / cut.height * tangent, -1.0);
      const Vec3 d = ray.normalized(), e = settings.camera.eye;
      const double b = d.dot(e), under = b * b - e.squaredNorm() + radius * radius;
      if (under < 0.02) return unsure;  // near the outline a polyhedron is no sphere
      if (settings.clip.height(e + (-b - std::sqrt(under)) * d) < 0.0) return front;
      return settings.clip.height(e + (-b + std::sqrt(under)) * d) < 0.0 ? back : gone_by_cut;
    };
    int wrong = 0, fronts = 0, backs = 0, gone = 0;
    for (int y = 0; y < cut.height; ++y)
      for (int x = 0; x < cut.width; ++x) {
        const Seen expected = seen(x, y);
        bool sure = expected != unsure;  // and not on the line along the cut
        for (const auto& [dx, dy] : {std::pair{3, 0}, {-3, 0}, {0, 3}, {0, -3}})
          sure = sure && seen(x + dx, y + dy) == expected;
        if (!sure) continue;
        const bool is_background = std::equal(cut.pixel(x, y), cut.pixel(x, y) + 3, nothing.pixel(x, y));
        const bool is_front = std::equal(cut.pixel(x, y), cut.pixel(x, y) + 3, whole.pixel(x, y));
        fronts += expected == front, backs += expected == back, gone += expected == gone_by_cut;
        wrong += expected == front ? !is_front : expected == back ? is_front || is_background : !is_background;
      }
    CAPTURE(normal.transpose(), offset, fronts, backs, gone);
    CHECK(wrong == 0);
    CHECK(fronts + backs + gone > 5000);
  }
}

TEST_CASE("with backs only, a closed body covers the same pixels with its inside") {
  HandMadeRecord scene;
  add_bent(scene);
  ViewSettings settings = settings_with({"meshes"});
  settings.antialiasing = false;
  const Image fronts = painted(scene.record(), settings);
  settings.backs = Backs::hidden;
  CHECK(painted(scene.record(), settings) == fronts);
  settings.backs = Backs::only;
  const Image backs = painted(scene.record(), settings);
  CHECK(covered_pixels(backs) == Approx(covered_pixels(fronts)).margin(4));
  CHECK(count_unlike(fronts, backs, 10) > 0.9 * covered_pixels(fronts));
}

TEST_CASE("marks are not cut") {
  ViewSettings settings = settings_with({"contacts", "contact_forces"});
  const Image whole = painted(soft_record(), settings);
  settings.clip = {true, Vec3::UnitY(), -5.0};
  CHECK(painted(soft_record(), settings) == whole);
}

TEST_CASE("a heated surface has the colour of its value, in the light and in the shade") {
  // uniaxial stretch: one stress everywhere, so one colour; its place in the bar follows the setting
  HandMadeRecord scene;
  const Caged& c = caged_lump();
  scene.add_soft("bar", c.surface, c.cage.mesh, c.cage.embedding,
                 [](const Vec3& p) { return Vec3(1.1 * p.x(), p.y(), p.z()); });
  ViewSettings settings = settings_with({"meshes", "strain"});
  std::vector<double> lightness;
  const Image nothing = painted(StepRecord{}, settings);
  for (const double high : {1.0, 0.2, 0.1, 0.06}) {
    set(settings, "view.strain.max", shortest(high));
    const Image image = painted(scene.record(), settings);
    double sum = 0.0;
    int count = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const std::uint8_t* p = image.pixel(x, y);
        if (std::equal(p, p + 3, nothing.pixel(x, y))) continue;
        sum += 0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2];
        ++count;
      }
    REQUIRE(count > 2000);
    lightness.push_back(sum / count);
  }
  for (std::size_t i = 1; i < lightness.size(); ++i) CHECK(lightness[i] > lightness[i - 1] + 15.0);
}
