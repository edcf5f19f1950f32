// The triangle test against exact integer arithmetic: two triangles meet iff the origin lies in the convex hull of the
// nine differences of their corners, that is (Carathéodory) in that of at most four of them.
#include <catch2/catch.hpp>

#include <algorithm>

#include "engine/geometry/triangle_intersection.hpp"
#include "tests/support/random.hpp"

using namespace impinge;
using test::Random;

namespace {

using Int3 = Eigen::Matrix<std::int64_t, 3, 1>;
using IntTriangle = std::array<Int3, 3>;

std::int64_t det(const Int3& a, const Int3& b, const Int3& c) { return a.dot(b.cross(c)); }

bool origin_in_two(const Int3& p, const Int3& q) { return p.cross(q).isZero() && p.dot(q) <= 0; }

bool origin_in_three(const Int3& p, const Int3& q, const Int3& r) {
  const Int3 n = (q - p).cross(r - p);
  if (n.isZero() || det(p, q, r) != 0) return false;  // no area: its edges are tested as pairs
  return p.cross(q).dot(n) >= 0 && q.cross(r).dot(n) >= 0 && r.cross(p).dot(n) >= 0;
}

bool origin_in_four(const Int3& p, const Int3& q, const Int3& r, const Int3& s) {
  const std::int64_t whole = det(q - p, r - p, s - p);
  if (whole == 0) return false;  // flat: its faces are tested as triples
  const std::int64_t sign = whole > 0 ? 1 : -1;
  return sign * det(q, r, s) >= 0 && -sign * det(p, r, s) >= 0 && sign * det(p, q, s) >= 0 && -sign * det(p, q, r) >= 0;
}

bool exactly_intersect(const IntTriangle& a, const IntTriangle& b) {
  std::array<Int3, 9> d;
  for (int i = 0; i < 9; ++i) d[i] = a[i / 3] - b[i % 3];
  for (int i = 0; i < 9; ++i) {
    if (d[i].isZero()) return true;
    for (int j = i + 1; j < 9; ++j) {
      if (origin_in_two(d[i], d[j])) return true;
      for (int k = j + 1; k < 9; ++k) {
        if (origin_in_three(d[i], d[j], d[k])) return true;
        for (int l = k + 1; l < 9; ++l)
          if (origin_in_four(d[i], d[j], d[k], d[l])) return true;
      }
    }
  }
  return false;
}

IntTriangle integer_triangle(Random& random, int reach) {
  IntTriangle t;
  for (Int3& c : t)
    for (int d = 0; d < 3; ++d) c[d] = random.below(2 * reach + 1) - reach;
  return t;
}

TriangleCorners placed(const IntTriangle& t, const Pose& pose) {
  return {pose.apply(t[0].cast<double>()), pose.apply(t[1].cast<double>()), pose.apply(t[2].cast<double>())};
}

// corners drawn from a small grid, so that shared corners, touching edges, one plane and no area are all common; some
// corners are copied on purpose
std::pair<IntTriangle, IntTriangle> random_pair(Random& random) {
  IntTriangle a = integer_triangle(random, 2), b = integer_triangle(random, 2);
  switch (random.below(6)) {
    case 0:
      b[0] = a[0];
      break;
    case 1:
      b[0] = a[0], b[1] = a[1];
      break;
    case 2:
      for (Int3& c : a) c[1] = 0;
      for (Int3& c : b) c[1] = 0;
      break;
    case 3:
      a[1] = a[0];
      break;
    default:
      break;
  }
  return {a, b};
}

}  // namespace

TEST_CASE("triangle test equals exact arithmetic on lattice triangles", "[triangle]") {
  Random random(1001);
  int hits = 0;
  for (int i = 0; i < 30000; ++i) {
    const auto [a, b] = random_pair(random);
    const bool expected = exactly_intersect(a, b);
    hits += expected ? 1 : 0;
    const bool found = triangles_intersect(placed(a, {}), placed(b, {}));
    CAPTURE(i, expected);
    REQUIRE(found == expected);
  }
  CHECK(hits > 5000);
  CHECK(hits < 25000);
}

TEST_CASE("triangle test misses no touching pair at any pose, and invents none", "[triangle]") {
  // lattice triangles that are apart are apart by far more than the tolerance, also 1e5 m from the origin
  Random random(1002);
  for (int i = 0; i < 20000; ++i) {
    const auto [a, b] = random_pair(random);
    const Mat3 rotation = random.rotation();
    const double reach = i % 3 == 0 ? 0.0 : i % 3 == 1 ? 10.0 : 1e5;
    const Pose pose{rotation, reach * random.vector()};
    const bool expected = exactly_intersect(a, b);
    const bool found = triangles_intersect(placed(a, pose), placed(b, pose));
    CAPTURE(i, reach, expected);
    REQUIRE(found == expected);
  }
}

TEST_CASE("triangle test does not depend on the order of triangles or corners", "[triangle]") {
  Random random(1003);
  for (int i = 0; i < 400; ++i) {
    const auto [ia, ib] = random_pair(random);
    const Mat3 rotation = random.rotation();
    const Pose pose{rotation, random.vector()};
    TriangleCorners a = placed(ia, pose), b = placed(ib, pose);
    // within a few roundings of touching, where an answer that depends on order would show
    if (i % 2 == 0) b[0] += 1e-14 * random.vector();
    const bool expected = triangles_intersect(a, b);
    std::array<int, 3> p{0, 1, 2};
    do {
      std::array<int, 3> q{0, 1, 2};
      do {
        const TriangleCorners pa{a[p[0]], a[p[1]], a[p[2]]}, qb{b[q[0]], b[q[1]], b[q[2]]};
        REQUIRE(triangles_intersect(pa, qb) == expected);
        REQUIRE(triangles_intersect(qb, pa) == expected);
      } while (std::next_permutation(q.begin(), q.end()));
    } while (std::next_permutation(p.begin(), p.end()));
  }
}

TEST_CASE("triangle test decides slivers and coplanar triangles", "[triangle]") {
  const TriangleCorners floor{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 0, 1)};
  const auto above = [](const TriangleCorners& t, double h) {
    TriangleCorners r = t;
    for (Vec3& c : r) c.y() += h;
    return r;
  };
  CHECK(triangles_intersect(floor, floor));
  CHECK_FALSE(triangles_intersect(floor, above(floor, 1e-9)));
  CHECK_FALSE(triangles_intersect(floor, above(floor, 1e-12)));
  const TriangleCorners inner{Vec3(0.2, 0, 0.2), Vec3(0.3, 0, 0.2), Vec3(0.2, 0, 0.3)};
  CHECK(triangles_intersect(floor, inner));  // contained, no edges cross
  const TriangleCorners beside{Vec3(0.6, 0, 0.6), Vec3(1, 0, 0.6), Vec3(0.6, 0, 1)};
  CHECK_FALSE(triangles_intersect(floor, beside));  // coplanar, boxes overlap
  const TriangleCorners needle{Vec3(0.3, -1, 0.3), Vec3(0.3, 1, 0.3), Vec3(0.3 + 1e-13, 0, 0.3)};
  CHECK(triangles_intersect(floor, needle));
  const TriangleCorners segment{Vec3(0.3, -1, 0.3), Vec3(0.3, 1, 0.3), Vec3(0.3, 0.5, 0.3)};
  CHECK(triangles_intersect(floor, segment));
  const TriangleCorners point{Vec3(0.25, 0, 0.25), Vec3(0.25, 0, 0.25), Vec3(0.25, 0, 0.25)};
  CHECK(triangles_intersect(floor, point));
  CHECK(triangles_intersect(segment, segment));
  CHECK_FALSE(triangles_intersect(above(point, 1e-9), floor));
  CHECK_FALSE(triangles_intersect(above(segment, 2.0), floor));
}

TEST_CASE("a line meets the triangle where its barycentric coordinates say", "[triangle]") {
  Random random(1004);
  int hits = 0;
  for (int i = 0; i < 2000; ++i) {
    const TriangleCorners c{random.vector(), random.vector(), random.vector()};
    const Vec3 origin = random.vector(), direction = random.vector();
    const std::optional<RayHit> hit = intersect_line(origin, direction, c);
    if (!hit) continue;
    ++hits;
    const Vec3 from_line = origin + hit->t * direction;
    const Vec3 from_corners = (1.0 - hit->u - hit->v) * c[0] + hit->u * c[1] + hit->v * c[2];
    CHECK(hit->u >= 0.0);
    CHECK(hit->v >= 0.0);
    CHECK(hit->u + hit->v <= 1.0);
    REQUIRE((from_line - from_corners).norm() < 1e-9 * (1.0 + std::abs(hit->t)));
  }
  CHECK(hits > 100);
  const TriangleCorners flat{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 0, 1)};
  CHECK_FALSE(intersect_line(Vec3(0, 1, 0), Vec3(1, 0, 0), flat).has_value());
  CHECK_FALSE(intersect_line(Vec3(0, 1, 0), Vec3(0, 0, 0), flat).has_value());
}
