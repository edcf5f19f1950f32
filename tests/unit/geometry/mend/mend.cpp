// Mending: each fault planted into a solid whose volume a formula knows, alone and all together.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <algorithm>

#include "engine/core/parallel.hpp"
#include "engine/geometry/mass_properties.hpp"
#include "engine/geometry/mend/mend.hpp"
#include "engine/geometry/mend/mesh_facts.hpp"
#include "engine/geometry/surface/mesh_checks.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

TriangleMesh cube(double half = 0.5, int cells = 1) {
  return box(Vec3::Constant(half), Eigen::Vector3i::Constant(cells));
}

/// Three vertices a triangle, each moved by up to `noise` on each axis.
TriangleMesh soup(const TriangleMesh& mesh, double noise, std::uint64_t seed = 1) {
  Random random(seed);
  TriangleMesh out;
  for (const Triangle& t : mesh.triangles) {
    const int first = static_cast<int>(out.vertices.size());
    for (const int v : t) out.vertices.push_back(mesh.vertices[v] + noise * random.vector());
    out.triangles.push_back({first, first + 1, first + 2});
  }
  return out;
}

MendedMesh mended(const TriangleMesh& mesh, const MendSettings& settings = {}) {
  MendedMesh result = mend(mesh, settings);
  INFO(result.problem.value_or(""));
  CHECK_FALSE(result.problem);
  return result;
}

}  // namespace

TEST_CASE("a sound surface comes out of mending as it went in, to the bit") {
  for (const TriangleMesh& mesh : {cube(), torus(1.0, 0.3, 24, 12), bumpy_sphere(3)}) {
    const MendedMesh result = mended(mesh);
    CHECK(result.mesh.vertices == mesh.vertices);
    CHECK(result.mesh.triangles == mesh.triangles);
    CHECK_FALSE(result.report.is_changed());
    CHECK(result.report.largest_move == 0.0);
    CHECK(result.report.volume_before == result.report.volume_after);
  }
}

TEST_CASE("vertices of a border within the tolerance become one, and no others") {
  const TriangleMesh sphere = icosphere(3);
  const MendedMesh near = mended(soup(sphere, 1e-7));
  CHECK(near.mesh.triangles.size() == sphere.triangles.size());
  CHECK(near.mesh.vertices.size() == sphere.vertices.size());
  CHECK(near.report.largest_move > 1e-8);
  CHECK(near.report.largest_move < 2.0 * std::sqrt(3.0) * 1e-7);
  CHECK(near.report.volume_after == Approx(signed_volume(sphere)).epsilon(1e-5));
  // farther apart than a thousandth of the diagonal: the scene has to say so
  MendSettings settings;
  settings.weld = 0.03;
  CHECK(mended(soup(sphere, 6e-3), settings).mesh.vertices.size() == sphere.vertices.size());
  CHECK(mend(soup(sphere, 6e-3), {}).mesh.vertices.size() > sphere.vertices.size());
}

TEST_CASE("triangles without area, and those twice there, go, flat ones are flipped so that no hole is left") {
  TriangleMesh mesh = cube();
  mesh.triangles.push_back({0, 0, 3});
  mesh.triangles.push_back(mesh.triangles[2]);
  mesh.triangles.push_back({mesh.triangles[5][1], mesh.triangles[5][2], mesh.triangles[5][0]});
  MendedMesh result = mended(mesh);
  CHECK(result.report.collapsed == 1);
  CHECK(result.report.duplicates == 2);
  CHECK(result.report.volume_after == Approx(1.0));

  // a vertex in the middle of a side of one of its triangles, and a triangle without area that closes the gap
  mesh = cube();
  const Triangle t = mesh.triangles[0];
  const int middle = static_cast<int>(mesh.vertices.size());
  mesh.vertices.push_back(0.5 * (mesh.vertices[t[0]] + mesh.vertices[t[1]]));
  mesh.triangles[0] = {t[0], middle, t[2]};
  mesh.triangles.push_back({middle, t[1], t[2]});
  mesh.triangles.push_back({t[0], t[1], middle});
  result = mended(mesh);
  CHECK(result.report.flipped_flat == 1);
  CHECK(result.report.volume_after == Approx(1.0));
  for (const Triangle& s : result.mesh.triangles) {
    const Vec3& a = result.mesh.vertices[s[0]];
    CHECK((result.mesh.vertices[s[1]] - a).cross(result.mesh.vertices[s[2]] - a).norm() > 0.1);
  }
}

TEST_CASE("edges without length are drawn together, and the triangles beside them go") {
  TriangleMesh mesh = cube();
  const std::size_t triangles = mesh.triangles.size();
  // vertex 0 becomes two in one place: from one of its edges to another, its triangles have the copy
  const MeshTopology topology = make_topology(mesh);
  const int copy = static_cast<int>(mesh.vertices.size()), first = topology.vertex_triangles[0];
  mesh.vertices.push_back(mesh.vertices[0]);
  Triangle& own = mesh.triangles[static_cast<std::size_t>(first)];
  const int k = static_cast<int>(std::find(own.begin(), own.end(), 0) - own.begin());
  const int next = own[(k + 1) % 3], last = own[(k + 2) % 3];
  own[k] = copy;
  mesh.triangles.push_back({0, next, copy});
  mesh.triangles.push_back({0, copy, last});
  REQUIRE(make_topology(mesh).is_closed());
  const MendedMesh result = mended(mesh);
  CHECK(result.report.joined == 1);
  CHECK(result.report.volume_after == Approx(1.0));
  CHECK(make_topology(result.mesh).is_closed());
  REQUIRE(result.mesh.triangles.size() == triangles);
  for (const Triangle& s : result.mesh.triangles) {
    const Vec3& a = result.mesh.vertices[s[0]];
    CHECK((result.mesh.vertices[s[1]] - a).cross(result.mesh.vertices[s[2]] - a).norm() > 0.1);
  }
}

TEST_CASE("a finely cut side on a coarse solid shares its vertices with it, and nothing moves") {
  for (const double noise : {0.0, 1e-7})
    for (const int cells : {2, 4, 9}) {
      // of the coarse cube all but the side at y = 0.5, of the fine one that side alone
      TriangleMesh mesh = cube(), fine = cube(0.5, cells);
      const auto is_top = [](const TriangleMesh& m) {
        return [&m](const Triangle& t) {
          return std::all_of(t.begin(), t.end(), [&](int v) { return m.vertices[v].y() == 0.5; });
        };
      };
      std::erase_if(mesh.triangles, is_top(mesh));
      std::erase_if(fine.triangles, std::not_fn(is_top(fine)));
      Random random(static_cast<std::uint64_t>(cells));
      for (Vec3& x : fine.vertices) x += noise * random.vector();
      append(mesh, fine);
      CAPTURE(cells, noise);
      const MendedMesh result = mended(mesh);
      CHECK(result.report.split_edges >= 4);  // two triangles beside it have one such side, one has two
      CHECK(result.report.holes == 0);
      CHECK(result.report.sheets == 0);
      CHECK(result.report.largest_move <= 2.0 * std::sqrt(3.0) * noise);
      CHECK(result.report.volume_after == Approx(1.0).epsilon(1e-12 + 4.0 * noise));
      // four sides of two triangles, of which each has so many more as its border has vertices more, the floor, the top
      CHECK(result.mesh.triangles.size() == static_cast<std::size_t>(2 * cells * cells + 4 * (2 + cells - 1) + 2));
      double area = 0.0;
      for (const Triangle& t : result.mesh.triangles) {
        const Vec3& a = result.mesh.vertices[t[0]];
        const double own = 0.5 * (result.mesh.vertices[t[1]] - a).cross(result.mesh.vertices[t[2]] - a).norm();
        CHECK(own > 0.1 / (cells * cells));
        area += own;
      }
      CHECK(area == Approx(6.0).epsilon(1e-12 + 8.0 * noise));
    }
}

TEST_CASE("a slit whose borders are not near enough to be one is filled without triangles that have no area") {
  // a plate of three by one whose long side is cut at other places above and below, so far apart that nothing is welded
  MendSettings settings;
  settings.weld = 0.0;
  TriangleMesh mesh = cube(), fine = cube(0.5, 4);
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return std::all_of(t.begin(), t.end(), [&](int v) { return mesh.vertices[v].y() == 0.5; });
  });
  // the fine side's own vertices, but for the corners, which it has in common: four slits in one border
  std::vector<int> index(fine.vertices.size(), -1);
  for (std::size_t v = 0; v < index.size(); ++v) {
    for (int w = 0; w < 8; ++w)
      if (mesh.vertices[w] == fine.vertices[v]) index[v] = w;
    if (index[v] >= 0 || fine.vertices[v].y() != 0.5) continue;
    index[v] = static_cast<int>(mesh.vertices.size());
    mesh.vertices.push_back(fine.vertices[v]);
  }
  // one corner is a vertex of its own: one border in all
  const auto corner = std::find(fine.vertices.begin(), fine.vertices.end(), Vec3(0.5, 0.5, 0.5));
  index[static_cast<std::size_t>(corner - fine.vertices.begin())] = static_cast<int>(mesh.vertices.size());
  mesh.vertices.push_back(*corner);
  for (const Triangle& t : fine.triangles)
    if (std::all_of(t.begin(), t.end(), [&](int v) { return fine.vertices[v].y() == 0.5; }))
      mesh.triangles.push_back({index[t[0]], index[t[1]], index[t[2]]});
  const MendedMesh result = mended(mesh, settings);
  CHECK(result.report.volume_after == Approx(1.0).epsilon(0.011));  // where it was taken apart a sheet is left
  for (const Triangle& t : result.mesh.triangles) {
    const Vec3 &a = result.mesh.vertices[t[0]], &b = result.mesh.vertices[t[1]], &c = result.mesh.vertices[t[2]];
    CHECK((b - a).cross(c - a).norm() > 1e-9 * std::max({(b - a).norm(), (c - a).norm(), (c - b).norm()}));
  }
}

TEST_CASE("a sheet within the thickness of another goes, one beside it stays") {
  for (const double height : {1e-3, 0.5}) {
    CAPTURE(height);
    TriangleMesh mesh = sheet(1.0, 4);
    append(mesh, sheet(0.1, 2), {0.2, height, 0.2});
    const MendedMesh result = mended(mesh);
    const bool is_inside = height < 0.01;
    CHECK(result.report.inner_parts == (is_inside ? 1 : 0));
    // a hundredth of their sides thick
    CHECK(result.report.volume_after == Approx(4.0 * 0.02 + (is_inside ? 0.0 : 0.04 * 0.002)).epsilon(1e-9));
  }
}

TEST_CASE("neighbours are turned alike, parts outwards, whatever the file had") {
  Random random(7);
  for (int i = 0; i < 20; ++i) {
    TriangleMesh mesh = bumpy_torus(24, 12);
    for (Triangle& t : mesh.triangles)
      if (random.below(2) == 0) std::swap(t[1], t[2]);
    const MendedMesh result = mended(mesh);
    CHECK(result.report.volume_after == Approx(signed_volume(bumpy_torus(24, 12))).epsilon(1e-12));
  }
  TriangleMesh two = cube();
  append(two, inside_out(cube(0.25)), {3.0, 0.0, 0.0});
  const MendedMesh result = mended(two);
  CHECK(result.report.turned_parts == 1);
  CHECK(result.report.volume_after == Approx(1.0 + 0.125));
}

TEST_CASE("a wall that faces into a solid is a cavity's, a part that faces outwards in it adds nothing") {
  TriangleMesh hollow = cube();
  append(hollow, inside_out(cube(0.25)));
  CHECK(mended(hollow).report.volume_after == Approx(1.0 - 0.125));
  CHECK(mended(inside_out(hollow)).report.volume_after == Approx(1.0 - 0.125));

  TriangleMesh filled = cube();
  append(filled, cube(0.25));
  const MendedMesh without = mended(filled);
  CHECK(without.report.inner_parts == 1);
  CHECK(without.report.volume_after == Approx(1.0));
  MendSettings settings;
  settings.drop_inner = false;
  CHECK(mended(filled, settings).report.volume_after == Approx(1.0 - 0.125));

  append(hollow, cube(0.1));  // a solid of its own in the cavity
  CHECK(mended(hollow).report.volume_after == Approx(1.0 - 0.125 + 0.008));
}

TEST_CASE("sheets that meet in an edge or a vertex are taken apart, each with the solid that it bounds") {
  TriangleMesh edge = cube();
  append(edge, cube(), {1.0, 1.0, 0.0});
  edge = weld(edge).mesh;
  REQUIRE(make_topology(edge).nonmanifold_edges == 1);
  MendedMesh result = mended(edge);
  CHECK(result.report.cut_edges == 1);
  CHECK(result.report.volume_after == Approx(2.0));
  CHECK(result.report.largest_move == 0.0);

  TriangleMesh vertex = cube();
  append(vertex, cube(), {1.0, 1.0, 1.0});
  result = mended(weld(vertex).mesh);
  CHECK(result.mesh.vertices.size() == 16);
  CHECK(result.report.volume_after == Approx(2.0));

  // a wall between two solids, there once for each: neither is part of the skin of both together
  TriangleMesh wall = cube();
  append(wall, cube(), {1.0, 0.0, 0.0});
  result = mended(weld(wall).mesh);
  CHECK(result.report.volume_after == Approx(2.0));
  CHECK(result.mesh.vertices.size() == 12);

  // an inner wall, there once
  TriangleMesh room = weld(wall).mesh;
  const auto same = std::find_if(room.triangles.begin(), room.triangles.end(), [&](const Triangle& t) {
    return std::all_of(t.begin(), t.end(), [&](int v) { return room.vertices[v].x() == 0.5; });
  });
  REQUIRE(same != room.triangles.end());
  const Triangle kept = *same;
  std::erase_if(room.triangles, [&](const Triangle& t) {
    return t != kept && std::all_of(t.begin(), t.end(), [&](int v) { return room.vertices[v].x() == 0.5; });
  });
  CHECK(mended(room).report.volume_after == Approx(2.0).epsilon(0.03));
}

TEST_CASE("holes are filled, flat ones exactly, whatever their form") {
  // a cube without a face of 8 x 8 cells, and the same with an L of cells gone
  for (const bool whole : {true, false}) {
    TriangleMesh mesh = cube(0.5, 8);
    std::erase_if(mesh.triangles, [&](const Triangle& t) {
      Vec3 middle = Vec3::Zero();
      for (const int v : t) middle += mesh.vertices[v] / 3.0;
      return middle.y() > 0.499 && (whole || middle.x() < -0.25 || (middle.z() < -0.25 && middle.x() < 0.3));
    });
    const MendedMesh result = mended(mesh);
    CHECK(result.report.holes == 1);
    CHECK(result.report.volume_after == Approx(1.0).epsilon(1e-12));
  }
  // two borders of 400 corners, so wide that they are a sheet's unless they are said to be holes: flat lids
  TriangleMesh tube = torus(1.0, 0.3, 400, 12);
  const double whole = signed_volume(tube);
  std::erase_if(tube.triangles, [&](const Triangle& t) {
    return std::all_of(t.begin(), t.end(), [&](int v) { return tube.vertices[v].y() > 0.2; });
  });
  MendSettings wide;
  wide.largest_hole = 1.0;
  const double lidded = mended(tube, wide).report.volume_after;
  CHECK(lidded < whole);
  CHECK(lidded == Approx(whole).epsilon(0.1));
  CHECK(mended(tube).report.volume_after < 0.2 * whole);
}

TEST_CASE("what is mostly open is a sheet of the thickness that is asked for") {
  MendSettings settings;
  settings.thickness = 0.02;
  const MendedMesh flat = mended(sheet(1.0, 8), settings);
  CHECK(flat.report.sheets == 1);
  CHECK(flat.report.volume_after == Approx(4.0 * 0.02));
  CHECK(flat.report.largest_move == Approx(0.01));
  CHECK(mended(sheet(1.0, 8)).report.volume_after == Approx(4.0 * 0.02));  // a hundredth of the side is the same

  TriangleMesh bowl = icosphere(4);
  std::erase_if(bowl.triangles, [&](const Triangle& t) {
    return std::all_of(t.begin(), t.end(), [&](int v) { return bowl.vertices[v].y() > -0.01; });
  });
  CHECK(mended(bowl, settings).report.volume_after == Approx(2.0 * M_PI * 0.02).epsilon(0.05));
  settings.largest_hole = 1.0;  // the lid is half of the bowl's area: the half ball
  CHECK(mended(bowl, settings).report.volume_after == Approx(2.0 / 3.0 * M_PI).epsilon(0.03));
}

TEST_CASE("damage of all kinds at once leaves the volume to within what was torn out") {
  Random random(3);
  for (int trial = 0; trial < 30; ++trial) {
    const TriangleMesh sound = trial % 2 == 0 ? bumpy_sphere(4) : torus(1.0, 0.4, 40, 20);
    TriangleMesh mesh = sound;
    std::erase_if(mesh.triangles, [&](const Triangle&) { return random.below(50) == 0; });
    for (Triangle& t : mesh.triangles)
      if (random.below(3) == 0) std::swap(t[1], t[2]);
    const std::size_t count = mesh.triangles.size();
    for (int i = 0; i < 30; ++i) mesh.triangles.push_back(mesh.triangles[random.below(static_cast<int>(count))]);
    for (int i = 0; i < 10; ++i) {
      const int v = mesh.triangles[random.below(static_cast<int>(count))][0];
      mesh.triangles.push_back({v, v, random.below(static_cast<int>(mesh.vertices.size()))});
    }
    const MendedMesh result = mended(soup(mesh, trial % 3 == 0 ? 0.0 : 1e-7, trial));
    CHECK(result.report.volume_after == Approx(signed_volume(sound)).epsilon(0.02));
    CHECK(result.report.holes > 0);
  }
}

TEST_CASE("of any soup mending makes solids, or says that it can't") {
  Random random(11);
  int solids = 0;
  for (int trial = 0; trial < 400; ++trial) {
    TriangleMesh mesh;
    const int vertices = 4 + random.below(20);
    // few places, so that much coincides
    for (int v = 0; v < vertices; ++v)
      mesh.vertices.push_back(Vec3(random.below(4), random.below(4), random.below(trial % 5 == 0 ? 1 : 4)));
    for (int t = 4 + random.below(60); t > 0; --t)
      mesh.triangles.push_back({random.below(vertices), random.below(vertices), random.below(vertices)});
    const MendedMesh result = mend(mesh, {});
    CAPTURE(trial, result.problem.value_or(""));
    for (const Vec3& v : result.mesh.vertices) REQUIRE(v.allFinite());
    if (result.problem) continue;
    ++solids;
    REQUIRE_FALSE(check_mesh(result.mesh, make_topology(result.mesh)));
    REQUIRE(signed_volume(result.mesh) > 0.0);
  }
  CHECK(solids > 320);
}

TEST_CASE("mending gives the same bits for any number of threads") {
  TriangleMesh mesh = soup(bumpy_sphere(4), 1e-7);
  std::erase_if(mesh.triangles, [&](const Triangle& t) { return t[0] % 150 == 0; });
  append(mesh, sheet(0.3, 6), {2.0, 0.0, 0.0});
  MendSettings settings;
  settings.remesh = 24;
  std::vector<MendedMesh> results;
  for (const int threads : {1, 3}) {
    set_thread_count(threads);
    results.push_back(mend(mesh, settings));
  }
  set_thread_count(0);
  CHECK(results[0].mesh.vertices == results[1].mesh.vertices);
  CHECK(results[0].mesh.triangles == results[1].mesh.triangles);
}

TEST_CASE("corners that were rounded one by one become one without being told how far they lie apart") {
  for (const double noise : {1e-7, 1e-6, 1e-5, 1e-4})  // of a surface of size 2
    for (const TriangleMesh& whole : {icosphere(3), bumpy_torus(40, 20)}) {
      CAPTURE(noise);
      const MendedMesh result = mended(soup(whole, noise));
      CHECK(result.mesh.triangles.size() == whole.triangles.size());
      CHECK(result.mesh.vertices.size() == whole.vertices.size());
      CHECK(result.report.volume_after == Approx(signed_volume(whole)).epsilon(10.0 * noise));
      CHECK(result.report.sheets + result.report.holes == 0);
    }
}

TEST_CASE("with a new skin parts that are open enclose together what they enclose, and a sheet alone stays whole") {
  TriangleMesh walls;  // of a cube of 2 m: six plates that end 4 cm before its edges and face inwards
  for (int side = 0; side < 6; ++side) {
    TriangleMesh plate = sheet(0.96, 6);
    const int axis = side / 2;
    const double sign = side % 2 == 0 ? 1.0 : -1.0;
    for (Vec3& v : plate.vertices) {
      const Vec3 flat = v;
      v[axis] = sign, v[(axis + 1) % 3] = flat.x(), v[(axis + 2) % 3] = sign * (flat.y() + flat.z());
    }
    const int first = static_cast<int>(walls.vertices.size());
    walls.vertices.insert(walls.vertices.end(), plate.vertices.begin(), plate.vertices.end());
    for (const Triangle& t : plate.triangles) walls.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  MendSettings settings;
  settings.remesh = 60;
  const MendedMesh closed = mended(walls, settings);
  CHECK(closed.report.volume_after == Approx(8.0).epsilon(0.02));
  CHECK(closed.report.sheets == 0);
  const MendedMesh alone = mended(sheet(1.0, 6), settings);
  CHECK(alone.report.sheets == 1);
  CHECK(measure(alone.mesh).components == 1);
  CHECK(alone.report.volume_after > 4.0 * 2.0 / 60.0);
}
