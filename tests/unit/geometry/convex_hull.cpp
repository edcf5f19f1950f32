// The convex hull of points and the exact sign that it decides by.
#include "engine/geometry/convex/convex_hull.hpp"

#include <catch2/catch.hpp>

#include "engine/geometry/convex/convex_polyhedron.hpp"
#include "engine/geometry/convex/orientation.hpp"
#include "engine/geometry/mass_properties.hpp"
#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// Closed, and no point of the input in front of any of its triangles.
void check_hull(const std::vector<Vec3>& points, const ConvexHull& hull) {
  REQUIRE(hull.problem == "");
  REQUIRE(make_topology(hull.mesh).is_closed());
  CHECK(hull.mesh.triangles.size() == 2 * hull.mesh.vertices.size() - 4);  // Euler
  CHECK(signed_volume(hull.mesh) > 0.0);
  bool holds = true;
  for (const auto& [a, b, c] : hull.mesh.triangles)
    for (const Vec3& x : points)
      holds = holds && orientation(hull.mesh.vertices[a], hull.mesh.vertices[b], hull.mesh.vertices[c], x) >= 0;
  CHECK(holds);
  for (std::size_t v = 0; v < hull.source.size(); ++v) CHECK(hull.mesh.vertices[v] == points[hull.source[v]]);
}

double hull_volume(const std::vector<Vec3>& points) { return signed_volume(convex_hull(points).mesh); }

}  // namespace

TEST_CASE("the sign of an orientation is exact") {
  // integer coordinates: the determinant is a whole number that 128 bits hold
  Random r(1);
  int zeros = 0, close = 0;
  for (int i = 0; i < 20000; ++i) {
    // points on a plane through large numbers, then moved by a few units
    std::array<std::array<std::int64_t, 3>, 4> p;
    const std::int64_t size = std::int64_t{1} << 30;
    for (auto& x : p)
      for (auto& k : x) k = static_cast<std::int64_t>(size * r.sym());
    if (i % 2) {
      const std::int64_t s = r.below(7) - 3, t = r.below(7) - 3;
      for (int k = 0; k < 3; ++k)
        p[3][k] = p[0][k] + s * (p[1][k] - p[0][k]) + t * (p[2][k] - p[0][k]) + (i % 4 == 1 ? r.below(3) - 1 : 0);
    }
    const auto d = [&](int row, int k) { return static_cast<__int128>(p[row][k] - p[3][k]); };
    const __int128 det = d(0, 0) * (d(1, 1) * d(2, 2) - d(1, 2) * d(2, 1)) +
                         d(0, 1) * (d(1, 2) * d(2, 0) - d(1, 0) * d(2, 2)) +
                         d(0, 2) * (d(1, 0) * d(2, 1) - d(1, 1) * d(2, 0));
    const int sign = det > 0 ? 1 : det < 0 ? -1 : 0;
    const auto point = [&](int row) {
      return Vec3(std::ldexp(p[row][0], -30), std::ldexp(p[row][1], -30), std::ldexp(p[row][2], -30));
    };
    const Vec3 a = point(0), b = point(1), c = point(2), e = point(3);
    CHECK(orientation(a, b, c, e) == sign);
    CHECK(orientation(b, a, c, e) == -sign);
    zeros += sign == 0 ? 1 : 0;
    close += sign != 0 && std::abs((a - e).dot((b - e).cross(c - e))) < 1e-7 ? 1 : 0;
  }
  CHECK(zeros > 4000);
  CHECK(close > 1000);
}

TEST_CASE("a cross product of nearly parallel vectors keeps its digits") {
  const Vec3 u(1.0, 1e-9, 3.0), v(1.0 + 0x1p-40, 1e-9, 3.0);
  // v = u + 2^-40 e_x, so u × v = 2^-40 u × e_x
  const Vec3 truth = 0x1p-40 * Vec3(0.0, 3.0, -1e-9);
  CHECK((accurate_cross(u, v) - truth).norm() < 1e-15 * truth.norm());
}

TEST_CASE("the hull of random points holds them all and has no other corner") {
  Random r(2);
  for (int i = 0; i < 200; ++i) {
    std::vector<Vec3> points;
    const int count = 4 + r.below(60);
    for (int k = 0; k < count; ++k) points.push_back(i % 2 ? r.vector() : Vec3(r.direction()));
    const double shift = i % 5 == 0 ? 1e5 : 0.0;
    for (Vec3& x : points) x += Vec3::Constant(shift);
    const ConvexHull hull = convex_hull(points);
    check_hull(points, hull);
    if (i % 2 == 0 && shift == 0.0) CHECK(hull.mesh.vertices.size() == points.size());  // on a sphere: all are corners
    if (count > 14) continue;
    // brute force: three points are a face if all others lie on one side
    double six_volumes = 0.0;
    for (int a = 0; a < count; ++a)
      for (int b = 0; b < count; ++b)
        for (int c = 0; c < count; ++c) {
          if (a >= b || a >= c || b == c) continue;
          bool is_face = true;
          for (int x = 0; x < count && is_face; ++x)
            is_face = x == a || x == b || x == c || orientation(points[a], points[b], points[c], points[x]) > 0;
          if (is_face) six_volumes += (points[a] - points[0]).dot((points[b] - points[0]).cross(points[c] - points[0]));
        }
    CHECK(signed_volume(hull.mesh) == Approx(six_volumes / 6.0).epsilon(shift > 0.0 ? 1e-9 : 1e-12));
  }
}

TEST_CASE("coplanar, collinear and repeated points are no trouble to the hull") {
  std::vector<Vec3> lattice;
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 5; ++j)
      for (int k = 0; k < 5; ++k) lattice.emplace_back(i, 0.1 * j, 7.0 * k);
  for (int i = 0; i < 50; ++i) lattice.push_back(lattice[2 * i]);
  check_hull(lattice, convex_hull(lattice));
  CHECK(hull_volume(lattice) == Approx(4.0 * 0.4 * 28.0).epsilon(1e-14));

  Random r(3);
  for (int i = 0; i < 100; ++i) {
    // turned, so that nothing is coplanar in doubles any more, and with noise of every size
    const Mat3 turn = r.rotation();
    const double noise = i % 3 == 0 ? 0.0 : std::pow(10.0, r.in(-17.0, -6.0));
    std::vector<Vec3> points;
    for (int k = 0; k < 200; ++k) {
      Vec3 x(r.below(4), r.below(4), r.below(4));
      if (k < 8) x = Vec3(k & 1 ? 3 : 0, k & 2 ? 3 : 0, k & 4 ? 3 : 0);
      points.push_back(turn * x + noise * r.vector());
    }
    const ConvexHull hull = convex_hull(points);
    check_hull(points, hull);
    CHECK(signed_volume(hull.mesh) == Approx(27.0).epsilon(1e-12 + 10.0 * noise));
    const ConvexPolyhedron solid(hull.mesh);
    // what a body rests on is the square, whatever triangles rounding made of it
    const ContactFace face = solid.facing(turn * Vec3::UnitZ());
    if (noise > 1e-8) continue;
    REQUIRE(face.count >= 4);
    CHECK((face.normal - turn * Vec3::UnitZ()).norm() < 1e-6);
    double low = 1e300, high = -1e300;
    for (int k = 0; k < face.count; ++k) {
      const Vec3 x = turn.transpose() * face.point[k];
      low = std::min(low, x.x() + x.y()), high = std::max(high, x.x() + x.y());
    }
    CHECK(low == Approx(0.0).margin(1e-7));
    CHECK(high == Approx(6.0).margin(1e-7));
    if (noise == 0.0) CHECK(solid.faces().size() == 6);
    if (noise == 0.0) CHECK(solid.edges().size() >= 12);
  }
}

TEST_CASE("points without a hull are named") {
  const Vec3 a(0, 0, 0), b(1, 0, 0), c(0, 1, 0), d(1, 1, 0), up(0.3, 0.3, 1e-12), high(0.3, 0.3, 1e-3);
  CHECK(convex_hull(std::vector<Vec3>{}).problem == "has 0 different points");
  CHECK(convex_hull(std::vector<Vec3>{a, a, a, a, a}).problem == "has 1 different point");
  CHECK(convex_hull(std::vector<Vec3>{a, b, c, b}).problem == "has 3 different points");
  CHECK(convex_hull(std::vector<Vec3>{a, b, 2 * b, 3 * b, 5 * b}).problem == "has all points on a line");
  CHECK(convex_hull(std::vector<Vec3>{a, b, c, d}).problem.find("has all points in a plane") == 0);
  CHECK(convex_hull(std::vector<Vec3>{a, b, c, d, up}).problem.find("has all points in a plane") == 0);
  CHECK(convex_hull(std::vector<Vec3>{a, b, c, d, high}).problem == "");
  // zeros of either sign are one point
  CHECK(convex_hull(std::vector<Vec3>{a, -a, b, c, high}).mesh.vertices.size() == 4);
}

TEST_CASE("the farthest corner of a polyhedron is found by climbing as by looking at all") {
  Random r(4);
  for (int i = 0; i < 20; ++i) {
    std::vector<Vec3> points;
    const int count = i % 2 ? 300 : 25;
    for (int k = 0; k < count; ++k)
      points.push_back(Vec3(1.0, 0.1, 3.0).cwiseProduct(i % 4 < 2 ? r.direction() : r.vector()));
    const ConvexPolyhedron solid(convex_hull(points).mesh);
    for (int k = 0; k < 500; ++k) {
      const Vec3 d = r.direction();
      double most = -1e300;
      for (const Vec3& v : solid.vertices()) most = std::max(most, d.dot(v));
      CHECK(d.dot(solid.vertices()[solid.support_vertex(d)]) == Approx(most).epsilon(1e-15).margin(1e-15));
    }
    // each face is a supporting plane, and each edge lies in its two faces, the first on its left
    for (const ConvexPolyhedron::Face& f : solid.faces()) {
      double most = -1e300;
      for (const Vec3& v : solid.vertices()) most = std::max(most, f.normal.dot(v));
      CHECK(most == Approx(f.offset).margin(1e-12));
    }
    for (const ConvexPolyhedron::Edge& e : solid.edges()) {
      const auto &f0 = solid.faces()[e.face0], &f1 = solid.faces()[e.face1];
      const Vec3 along = solid.vertices()[e.vertex1] - solid.vertices()[e.vertex0];
      CHECK(std::abs(f0.normal.dot(along)) < 1e-12);
      CHECK(f0.normal.cross(f1.normal).dot(along) > 0.0);
    }
  }
}
