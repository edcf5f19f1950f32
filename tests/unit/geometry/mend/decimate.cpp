// Fewer triangles, held against counts of its own, brute force over all pairs of triangles, and formulas of the solids.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <map>

#include "engine/core/parallel.hpp"
#include "engine/geometry/distance.hpp"
#include "engine/geometry/mass_properties.hpp"
#include "engine/geometry/mend/decimate.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// Every side of a triangle is run along once, and once the other way.
bool is_closed(const TriangleMesh& mesh) {
  std::map<std::pair<int, int>, int> runs;
  for (const Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) ++runs[{t[k], t[(k + 1) % 3]}];
  for (const auto& [side, count] : runs)
    if (count != 1 || runs.count({side.second, side.first}) == 0) return false;
  return true;
}

/// Vertices − edges + triangles: 2 for each part, 2 less for each handle.
int euler(const TriangleMesh& mesh) {
  return static_cast<int>(mesh.vertices.size()) - static_cast<int>(mesh.triangles.size()) / 2;
}

/// Six times the volume of a tetrahedron, its sign right but for ties.
long double side(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  long double m[3][3];
  for (int i = 0; i < 3; ++i) {
    m[0][i] = static_cast<long double>(b[i]) - a[i];
    m[1][i] = static_cast<long double>(c[i]) - a[i];
    m[2][i] = static_cast<long double>(d[i]) - a[i];
  }
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

bool pierces(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  if ((side(a, b, c, p) > 0) == (side(a, b, c, q) > 0)) return false;
  const bool first = side(p, q, a, b) > 0;
  return (side(p, q, b, c) > 0) == first && (side(p, q, c, a) > 0) == first;
}

/// Pairs of triangles of which a side of one pierces the other, but for sides that end in it.
int crossings(const TriangleMesh& mesh) {
  int count = 0;
  const auto at = [&](int v) { return mesh.vertices[static_cast<std::size_t>(v)]; };
  const auto goes_through = [&](const Triangle& s, const Triangle& t) {
    for (int k = 0; k < 3; ++k) {
      const int p = s[static_cast<std::size_t>(k)], q = s[static_cast<std::size_t>((k + 1) % 3)];
      const auto ends_in = [&](int v) { return v == t[0] || v == t[1] || v == t[2]; };
      if (!ends_in(p) && !ends_in(q) && pierces(at(p), at(q), at(t[0]), at(t[1]), at(t[2]))) return true;
    }
    return false;
  };
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      if (goes_through(mesh.triangles[i], mesh.triangles[k]) || goes_through(mesh.triangles[k], mesh.triangles[i]))
        ++count;
  return count;
}

/// The farthest of random points of the one surface from the other, over all triangles.
double farthest(const TriangleMesh& from, const TriangleMesh& to, int points) {
  Random random(5);
  double most = 0.0;
  for (int i = 0; i < points; ++i) {
    const Triangle& t = from.triangles[static_cast<std::size_t>(random.below(static_cast<int>(from.triangles.size())))];
    double u = random.u(), v = random.u();
    if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
    const auto at = [](const TriangleMesh& mesh, int k) { return mesh.vertices[static_cast<std::size_t>(k)]; };
    const Vec3 x = (1.0 - u - v) * at(from, t[0]) + u * at(from, t[1]) + v * at(from, t[2]);
    double nearest_sq = std::numeric_limits<double>::infinity();
    for (const Triangle& s : to.triangles)
      nearest_sq =
          std::min(nearest_sq, closest_on_triangle(x, {at(to, s[0]), at(to, s[1]), at(to, s[2])}).squared_distance);
    most = std::max(most, std::sqrt(nearest_sq));
  }
  return most;
}

void check_sound(const TriangleMesh& mesh, const DecimatedMesh& few, int most) {
  CAPTURE(mesh.triangles.size(), most);
  CHECK(few.mesh.triangles.size() <= static_cast<std::size_t>(most));
  CHECK(is_closed(few.mesh));
  CHECK(euler(few.mesh) == euler(mesh));
  CHECK(crossings(few.mesh) == 0);
  CHECK(few.report.triangles_before == static_cast<int>(mesh.triangles.size()));
  CHECK(few.report.triangles_after == static_cast<int>(few.mesh.triangles.size()));
  CHECK(few.report.volume_after == signed_volume(few.mesh));
}

}  // namespace

TEST_CASE("a decimated solid is closed, has its handles, crosses itself nowhere and keeps its volume") {
  const TriangleMesh meshes[] = {icosphere(4), bumpy_sphere(4), bumpy_torus(48, 24), box({1.0, 0.2, 0.5}, {12, 3, 6})};
  for (const TriangleMesh& mesh : meshes)
    for (const int most : {600, 150, 40}) {
      const DecimatedMesh few = decimate(mesh, most);
      check_sound(mesh, few, most);
      CHECK(signed_volume(few.mesh) == Approx(signed_volume(mesh)).epsilon(1e-9));
      CHECK(few.mesh.triangles.size() + 2 > std::min(static_cast<std::size_t>(most), mesh.triangles.size()));
    }
}

TEST_CASE("decimated surfaces lie where the surface was") {
  // of a sphere in equal triangles: twice a third of a triangle's area over √3 is the sagitta
  const TriangleMesh sphere = icosphere(5);
  for (const int most : {2000, 500, 100}) {
    const DecimatedMesh few = decimate(sphere, most);
    const double sagitta = 8.0 * M_PI / (3.0 * std::sqrt(3.0) * most);
    const double off = std::max(farthest(few.mesh, sphere, 300), farthest(sphere, few.mesh, 300));
    CAPTURE(most, off, sagitta);
    CHECK(off < 3.0 * sagitta);
    CHECK(few.report.farthest < 3.0 * sagitta);
    CHECK(few.report.farthest > 0.1 * sagitta);
  }
  // flat sides and straight edges cost nothing: of a box its twelve triangles are left
  const TriangleMesh brick = box({1.0, 0.2, 0.5}, {20, 4, 10});
  const DecimatedMesh few = decimate(brick, 12);
  CHECK(few.mesh.triangles.size() == 12);
  CHECK(few.mesh.vertices.size() == 8);
  CHECK(farthest(few.mesh, brick, 300) < 1e-6);
  for (const Vec3& x : few.mesh.vertices) CHECK(x.cwiseAbs().isApprox(Vec3(1.0, 0.2, 0.5), 1e-6));
}

TEST_CASE("walls that are nearer than the new triangles are long don't come through each other") {
  TriangleMesh shell = bumpy_sphere(4);
  TriangleMesh inner = inside_out(shell);
  for (Vec3& x : inner.vertices) x *= 0.99;
  append(shell, inner);
  REQUIRE(euler(shell) == 4);
  for (const int most : {1000, 400}) {
    const DecimatedMesh few = decimate(shell, most);
    check_sound(shell, few, most);
  }
  // and beside one another: discs in a pile
  TriangleMesh pile;
  for (int i = 0; i < 4; ++i) {
    TriangleMesh disc = icosphere(3);
    for (Vec3& x : disc.vertices) x.y() = 0.05 * x.y() + 0.101 * i;
    append(pile, disc);
  }
  check_sound(pile, decimate(pile, 200), 200);
}

TEST_CASE("no part vanishes and no handle closes, however few triangles are asked for") {
  TriangleMesh three = icosphere(2);
  append(three, icosphere(2), {5.0, 0.0, 0.0});
  append(three, torus(1.0, 0.3, 20, 10), {10.0, 0.0, 0.0});
  const DecimatedMesh few = decimate(three, 4);
  CHECK(is_closed(few.mesh));
  CHECK(euler(few.mesh) == 4);
  CHECK(crossings(few.mesh) == 0);
  CHECK(few.mesh.triangles.size() >= 4 + 4 + 14);  // tetrahedra, and the least of a torus
  CHECK(few.mesh.triangles.size() <= 60);
  CHECK(decimate(icosphere(3), 4).mesh.triangles.size() == 4);
}

TEST_CASE("an open sheet keeps its border and its area") {
  const TriangleMesh flat = sheet(1.0, 20);
  const DecimatedMesh few = decimate(flat, 8);
  CHECK(few.mesh.triangles.size() <= 8);
  double area = 0.0;
  for (const Triangle& t : few.mesh.triangles) {
    const Vec3& a = few.mesh.vertices[static_cast<std::size_t>(t[0])];
    const Vec3 normal = (few.mesh.vertices[static_cast<std::size_t>(t[1])] - a)
                            .cross(few.mesh.vertices[static_cast<std::size_t>(t[2])] - a);
    CHECK(normal.y() > 0.0);
    area += 0.5 * normal.norm();
  }
  CHECK(area == Approx(4.0).epsilon(1e-6));
  TriangleMesh bent = sheet(1.0, 30);
  for (Vec3& x : bent.vertices) x.y() = 0.2 * std::sin(3.0 * x.x()) * std::cos(2.0 * x.z());
  const DecimatedMesh rough = decimate(bent, 200);
  CHECK(rough.mesh.triangles.size() <= 200);
  CHECK(farthest(rough.mesh, bent, 300) < 0.02);
  CHECK(farthest(bent, rough.mesh, 300) < 0.02);
}

TEST_CASE("the same triangles come of the same mesh, for any number of threads, and all of them where there are few") {
  const TriangleMesh mesh = bumpy_torus(60, 30);
  const DecimatedMesh first = decimate(mesh, 500);
  for (const int threads : {1, 2, 5}) {
    set_thread_count(threads);
    const DecimatedMesh again = decimate(mesh, 500);
    CHECK(again.mesh.vertices == first.mesh.vertices);
    CHECK(again.mesh.triangles == first.mesh.triangles);
  }
  set_thread_count(0);
  for (const int most : {3600, 100000}) {
    const DecimatedMesh same = decimate(mesh, most);
    CHECK(same.mesh.vertices == mesh.vertices);
    CHECK(same.mesh.triangles == mesh.triangles);
    CHECK(same.report.farthest == 0.0);
  }
}

TEST_CASE("far from the origin, and tiny, a surface is decimated as well") {
  TriangleMesh far = bumpy_sphere(4);
  for (Vec3& x : far.vertices) x = 1e-3 * x + Vec3(200.0, -300.0, 100.0);
  const DecimatedMesh few = decimate(far, 200);
  check_sound(far, few, 200);
  CHECK(farthest(few.mesh, far, 200) < 1e-4);
}

TEST_CASE("what crosses already, or is not manifold, is decimated round that") {
  TriangleMesh two = icosphere(4);
  append(two, icosphere(4), {1.0, 0.1, 0.2});
  const DecimatedMesh few = decimate(two, 1000);
  CHECK(few.mesh.triangles.size() <= 1000);
  CHECK(is_closed(few.mesh));
  CHECK(signed_volume(few.mesh) == Approx(signed_volume(two)).epsilon(1e-9));
  // a book of three pages: its back stays
  TriangleMesh book = sheet(1.0, 16);
  const std::size_t back = book.vertices.size();
  append(book, sheet(1.0, 16));
  for (std::size_t v = back; v < book.vertices.size(); ++v) {
    const Vec3 x = book.vertices[v];
    book.vertices[v] = {0.0, x.x() + 1.0, x.z()};
  }
  for (Triangle& t : book.triangles)
    for (int& v : t)
      if (static_cast<std::size_t>(v) >= back && book.vertices[static_cast<std::size_t>(v)].y() < 1e-12)
        for (std::size_t w = 0; w < back; ++w)
          if ((book.vertices[w] - book.vertices[static_cast<std::size_t>(v)]).norm() < 1e-12) v = static_cast<int>(w);
  const DecimatedMesh pages = decimate(book, 200);
  CHECK(pages.mesh.triangles.size() <= 200);
  CHECK(farthest(book, pages.mesh, 300) < 1e-6);
}
