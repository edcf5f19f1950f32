// What the view computes for deformable bodies before anything is drawn.
#include <catch2/catch.hpp>

#include <set>

#include "engine/geometry/tets/tet_cage.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/mechanics/fem.hpp"
#include "tests/support/pictures/hand_made_record.hpp"
#include "tests/support/pictures/view_scenes.hpp"
#include "viewer/draw/moved_surface.hpp"
#include "viewer/draw/tet_shapes.hpp"
#include "viewer/layers/body_style.hpp"
#include "viewer/layers/contact_measures.hpp"
#include "viewer/layers/heat_map.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

VecX positions_of(const TetMesh& mesh, const std::function<Vec3(const Vec3&)>& place) {
  VecX x(3 * static_cast<Eigen::Index>(mesh.vertices.size()));
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    x.segment<3>(3 * static_cast<Eigen::Index>(i)) = place(mesh.vertices[i]);
  return x;
}

}  // namespace

TEST_CASE("a shrunk tetrahedron keeps its centre and faces outwards, turned inside out or not") {
  TetMesh mesh = make_tet_box({1.0, 0.8, 0.6}, 3, 2, 2);
  shake_inside(mesh, {1.0, 0.8, 0.6}, 0.05, 31);
  std::vector<int> all;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) all.push_back(static_cast<int>(t));
  const Vec3 origin(0.4, -0.2, 0.1);
  for (const double side : {1.0, -1.0})
    for (const double factor : {0.5, 0.75, 1.0}) {
      const VecX x =
          positions_of(mesh, [&](const Vec3& p) { return Vec3(side * p.x() + 0.2 * p.y(), p.y(), 1.3 * p.z()); });
      const ShadedSurface solids = shrunk_tets(mesh, x, all, factor, origin);
      REQUIRE(solids.triangles.size() == 4 * mesh.tets.size());
      for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
        std::array<Vec3, 4> corner;
        Vec3 center = Vec3::Zero();
        for (int k = 0; k < 4; ++k) corner[k] = x.segment<3>(3 * mesh.tets[t][k]), center += 0.25 * corner[k];
        double volume = 0.0;
        Vec3 mean = Vec3::Zero();
        for (std::size_t f = 4 * t; f < 4 * t + 4; ++f) {
          std::array<Vec3, 3> p;
          for (int k = 0; k < 3; ++k) {
            p[k] = solids.positions[solids.triangles[f][k]].cast<double>() + origin - center;
            mean += p[k] / 12.0;
          }
          volume += p[0].dot(p[1].cross(p[2])) / 6.0;
          const Vec3 normal = solids.normals[solids.triangles[f][0]].cast<double>();
          CHECK(normal.dot(p[0]) > 0.0);
          CHECK(normal.dot(p[1] - p[0]) == Approx(0.0).margin(1e-6));
        }
        CHECK(mean.norm() < 1e-6);
        CHECK(volume ==
              Approx(factor * factor * factor * std::abs(tet_volume(corner[0], corner[1], corner[2], corner[3])))
                  .epsilon(1e-4));
      }
    }
}

TEST_CASE("every edge of the tetrahedra is there once, those of the hull among the outer ones") {
  const int nx = 3, ny = 2, nz = 4;
  const TetMesh mesh = make_tet_box({3, 2, 4}, nx, ny, nz);
  const TetEdges edges = make_tet_edges(mesh);
  std::set<std::pair<int, int>> expected, found;
  for (const Tet& t : mesh.tets)
    for (int a = 0; a < 4; ++a)
      for (int b = a + 1; b < 4; ++b) expected.insert(std::minmax(t[a], t[b]));
  int outer_by_place = 0;
  for (const auto& [a, b] : expected) {
    // an edge lies in the hull where both ends are on one side of the box
    const Vec3 &p = mesh.vertices[static_cast<std::size_t>(a)], &q = mesh.vertices[static_cast<std::size_t>(b)];
    bool on_hull = false;
    for (int axis = 0; axis < 3; ++axis)
      for (const double side : {0.0, axis == 0 ? 3.0 : axis == 1 ? 2.0 : 4.0})
        on_hull = on_hull || (p[axis] == side && q[axis] == side);
    outer_by_place += on_hull;
  }
  for (const auto& list : {edges.outer, edges.inner})
    for (const auto& e : list) CHECK(found.insert({e[0], e[1]}).second);
  CHECK(found == expected);
  CHECK(static_cast<int>(edges.outer.size()) == outer_by_place);
}

TEST_CASE(
    "a moved surface has the normals of its new form, smooth where it was smooth and creased where it was creased") {
  const auto place = [](const Vec3& p) { return Vec3(2.0 * p.x() + 5.0, p.y() - 3.0, 0.5 * p.z() + 0.3 * p.x()); };
  Mat3 gradient;
  gradient << 2, 0, 0, 0, 1, 0, 0.3, 0, 0.5;
  const TriangleMesh ball = icosphere(4, 1.0);
  const ShadedSurface rest = make_shaded_surface(ball, make_topology(ball), 50.0);
  std::vector<Vec3> moved;
  for (const Vec3& v : ball.vertices) moved.push_back(place(v));
  const MovedSurface now = move_surface(rest, moved, false);
  CHECK(now.solid);
  for (std::size_t i = 0; i < rest.positions.size(); ++i) {
    const Vec3& before = ball.vertices[rest.source[i]];
    CHECK((now.positions[i].cast<double>() + now.origin - place(before)).norm() < 1e-5);
    // a sphere's normals under a linear map: the inverse transpose
    const Vec3 expected = (gradient.inverse().transpose() * before).normalized();
    CHECK(now.normals[i].cast<double>().dot(expected) > 0.998);
  }
  CHECK_FALSE(move_surface(rest, moved, true).solid);

  const TriangleMesh crate = box({1, 1, 1});
  const ShadedSurface sharp = make_shaded_surface(crate, make_topology(crate), 50.0);
  moved.clear();
  for (const Vec3& v : crate.vertices) moved.push_back(place(v));
  const MovedSurface sheared = move_surface(sharp, moved, false);
  for (const auto& t : sharp.triangles) {
    const auto at = [&](int k) { return Vec3(sheared.positions[t[k]].cast<double>()); };
    const Vec3 normal = (at(1) - at(0)).cross(at(2) - at(0)).normalized();
    for (int k = 0; k < 3; ++k) CHECK(sheared.normals[t[k]].cast<double>().dot(normal) > 0.99999);
  }
}

TEST_CASE("values at a surface's vertices are those of a linear field") {
  const TriangleMesh lump = scaled_to(bumpy_sphere(3), 1.0);
  const TetCage cage = make_tet_cage(lump, {.cells = 5, .rays_per_cell = 4});
  const auto field = [](const Vec3& p) { return 3.0 + p.dot(Vec3(1.0, -2.0, 0.5)); };
  std::vector<double> nodes;
  for (const Vec3& v : cage.mesh.vertices) nodes.push_back(field(v));
  const std::vector<double> values = values_at_points(cage.embedding, cage.mesh, nodes);
  REQUIRE(values.size() == lump.vertices.size());
  for (std::size_t i = 0; i < values.size(); ++i) CHECK(values[i] == Approx(field(lump.vertices[i])).epsilon(1e-9));
}

TEST_CASE("the colour bar ends at a round number that covers what is shown, or where it is told to") {
  for (const auto& [value, expected] : {std::pair{1.0, 1.0},
                                        {1.01, 2.0},
                                        {2.0, 2.0},
                                        {3.0, 5.0},
                                        {5.1, 10.0},
                                        {0.013, 0.02},
                                        {7e5, 1e6},
                                        {9.99e-7, 1e-6}})
    CHECK(rounded_up(value) == Approx(expected).epsilon(1e-12));

  // stretched by 1.3 % with free sides: the stress is E times the strain (the hand-made material's E is 1e5 Pa, ν 0.45)
  HandMadeRecord scene;
  const MeshPointer cube = surface(box({0.5, 0.5, 0.5}));
  TetMesh mesh = make_tet_box({1, 1, 1}, 2, 2, 2);
  for (Vec3& v : mesh.vertices) v -= Vec3::Constant(0.5);
  scene.add_soft("bar", cube, mesh, embed(mesh, cube->mesh.vertices),
                 [](const Vec3& p) { return Vec3(1.013 * p.x(), (1.0 - 0.00585) * p.y(), (1.0 - 0.00585) * p.z()); });
  ViewSettings settings = make_view_settings();
  for (const double stress : heat_of_elements(*scene.record().bodies[0].deformable, HeatQuantity::von_mises))
    CHECK(stress == Approx(1300.0).epsilon(0.02));
  for (const double stress : heat_of_elements(*scene.record().bodies[0].deformable, HeatQuantity::mean_stress))
    CHECK(stress == Approx(1300.0 / 3.0).epsilon(0.02));  // two of the three principal stresses are zero
  for (const double change : heat_of_elements(*scene.record().bodies[0].deformable, HeatQuantity::volume_change))
    CHECK(change == Approx(1.013 * (1.0 - 0.00585) * (1.0 - 0.00585) - 1.0).epsilon(1e-9));
  CHECK(heat_scale(scene.record(), settings, HeatQuantity::mean_stress).low == Approx(-500.0));
  CHECK(heat_scale(scene.record(), settings, HeatQuantity::von_mises).high == Approx(2000.0).epsilon(1e-12));
  CHECK(heat_scale(scene.record(), settings, HeatQuantity::equivalent_strain).high == Approx(0.02).epsilon(1e-9));
  set(settings, "view.stress.max", "4321");
  CHECK(heat_scale(scene.record(), settings, HeatQuantity::von_mises).high == 4321.0);
  const ColorBar bar = heat_bar(HeatQuantity::von_mises, {ScaleForm::linear, 0.0, 2e5}, ColorMap::dusk);
  CHECK(bar.unit == "kPa");
  CHECK(bar.factor * bar.scale.high == Approx(200.0));
}

TEST_CASE("the legend explains only what the scene has") {
  HandMadeRecord rigid, soft;
  rigid.add("floor", BodyKind::fixed, Plane{Vec3::UnitY(), 0.0}, Vec3::Zero());
  rigid.add("ball", BodyKind::dynamic, Sphere{0.5}, {0, 1, 0});
  CHECK_FALSE(has_deformable(rigid.record()));
  CHECK(has_rigid(rigid.record()));
  const MeshPointer cube = surface(box({0.5, 0.5, 0.5}));
  TetMesh mesh = make_tet_box({1, 1, 1}, 1, 1, 1);
  for (Vec3& v : mesh.vertices) v -= Vec3::Constant(0.5);
  const Embedding embedding = embed(mesh, cube->mesh.vertices);
  soft.add_soft("cube", cube, mesh, embedding, [](const Vec3& p) { return p; }, {0, 3});
  CHECK(has_deformable(soft.record()));
  CHECK(has_held_nodes(soft.record()));
  CHECK_FALSE(has_rigid(soft.record()));
  CHECK_FALSE(has_everted(soft.record()));
  CHECK_FALSE(has_outside_vertices(soft.record()));
  soft.add_soft("mirrored", cube, mesh, embedding, [](const Vec3& p) { return Vec3(-p.x(), p.y(), p.z()); });
  CHECK(has_everted(soft.record()));
}

TEST_CASE("a clip plane keeps the part of a segment that lies on its side") {
  Random random(77);
  const ClipPlane off{false, Vec3::UnitX(), -10.0}, none{true, Vec3::Zero(), -10.0};
  int cut = 0;
  for (int i = 0; i < 300; ++i) {
    const ClipPlane clip{true, 3.0 * random.vector(), 0.3 * random.vector().x()};
    const Vec3 a = random.vector(), b = random.vector();
    Vec3 p = a, q = b;
    const bool left = clip.trim(p, q);
    // points along the segment are kept if and only if they lie between the ends that are left
    for (int k = 0; k <= 50; ++k) {
      const Vec3 x = a + (b - a) * (k / 50.0);
      const double along = (x - p).dot(q - p) / (q - p).squaredNorm();
      if (std::abs(clip.height(x)) > 1e-9) CHECK(clip.removes(x) == !(left && along > -1e-9 && along < 1.0 + 1e-9));
    }
    cut += left && (p != a || q != b);
    for (const ClipPlane& idle : {off, none}) {
      p = a, q = b;
      CHECK(idle.trim(p, q));
      CHECK((p == a && q == b && !idle.removes(a)));
    }
  }
  CHECK(cut > 50);
}

TEST_CASE("thinning keeps an even choice, and all where there are few") {
  CHECK(thinned(10, 20).size() == 10);
  CHECK(thinned(0, 20).empty());
  for (const std::size_t count : {21u, 1000u, 435545u}) {
    const std::vector<std::size_t> kept = thinned(count, 20);
    CHECK(kept.size() <= 20);
    CHECK(kept.size() > 9);
    CHECK(kept.back() < count);
    for (std::size_t i = 1; i < kept.size(); ++i) CHECK(kept[i] - kept[i - 1] == kept[1] - kept[0]);
  }
}
