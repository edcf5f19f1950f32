// Closest points against the conditions that make a point of a convex set closest: no way within the set leads nearer.
// Such a condition at the corners proves the whole, so the tests need no second implementation.
#include <catch2/catch.hpp>

#include "engine/geometry/distance.hpp"
#include "tests/support/random.hpp"

using namespace impinge;
using test::Random;

namespace {

// also thin and flat ones
TriangleCorners random_triangle(Random& random, int i) {
  TriangleCorners c{random.vector(), random.vector(), random.vector()};
  if (i % 7 == 1) c[2] = c[0] + 0.3 * (c[1] - c[0]) + 1e-7 * random.vector();
  if (i % 7 == 2) c[2] = c[0] + 0.3 * (c[1] - c[0]);
  if (i % 7 == 3) c[1] = c[0];
  if (i % 7 == 4) c[1] = c[2] = c[0];
  if (i % 7 == 5) c[2] = c[1] + 1e-4 * random.vector();
  return c;
}

}  // namespace

TEST_CASE("closest point of a triangle is a point of it and no corner leads nearer", "[distance]") {
  Random random(2001);
  for (int i = 0; i < 20000; ++i) {
    const TriangleCorners c = random_triangle(random, i);
    const Vec3 x = 2.0 * random.vector();
    const PointTriangle p = closest_on_triangle(x, c);
    REQUIRE(p.point.allFinite());
    CHECK(std::abs(p.squared_distance - (x - p.point).squaredNorm()) < 1e-12);
    for (const Vec3& corner : c) REQUIRE((x - p.point).dot(corner - p.point) < 1e-10);
    // in the triangle: the closest point to itself
    CHECK(closest_on_triangle(p.point, c).squared_distance < 1e-20);
    if (is_corner(p.feature)) CHECK(p.point == c[feature_number(p.feature)]);
    if (is_edge(p.feature)) {
      const int k = feature_number(p.feature);
      CHECK(closest_on_segment(p.point, c[k], c[(k + 1) % 3]).squared_distance < 1e-24);
    }
    if (p.feature == TriangleFeature::face)
      for (const Vec3& corner : c) CHECK(std::abs((x - p.point).dot(corner - c[0])) < 1e-10);
  }
}

TEST_CASE("each of the seven features of a triangle is found", "[distance]") {
  const TriangleCorners c{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 0, 1)};
  CHECK(closest_on_triangle(Vec3(0.2, 3, 0.2), c).feature == TriangleFeature::face);
  CHECK(closest_on_triangle(Vec3(-1, 1, -1), c).feature == TriangleFeature::corner0);
  CHECK(closest_on_triangle(Vec3(3, 1, -1), c).feature == TriangleFeature::corner1);
  CHECK(closest_on_triangle(Vec3(-1, 1, 3), c).feature == TriangleFeature::corner2);
  CHECK(closest_on_triangle(Vec3(0.5, 1, -1), c).feature == TriangleFeature::edge0);
  CHECK(closest_on_triangle(Vec3(1, 1, 1), c).feature == TriangleFeature::edge1);
  CHECK(closest_on_triangle(Vec3(-1, 1, 0.5), c).feature == TriangleFeature::edge2);
  CHECK(closest_on_triangle(Vec3(0.2, 3, 0.2), c).squared_distance == Approx(9.0).epsilon(1e-15));
}

TEST_CASE("closest points of two segments satisfy the conditions of a minimum", "[distance]") {
  Random random(2002);
  int interior = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 p0 = random.vector(), q0 = random.vector(), p1 = random.vector();
    Vec3 q1 = random.vector();
    if (i % 5 == 1) q1 = p1 + 0.7 * (q0 - p0);
    if (i % 5 == 2) q1 = p1 + 0.7 * (q0 - p0) + 1e-9 * random.vector();
    if (i % 5 == 3) q1 = p1;
    const SegmentSegment s = closest_between_segments(p0, q0, p1, q1);
    interior += s.interior ? 1 : 0;
    REQUIRE((s.point0 - (p0 + s.s * (q0 - p0))).norm() < 1e-14);
    REQUIRE((s.point1 - (p1 + s.t * (q1 - p1))).norm() < 1e-14);
    const Vec3 r = s.point0 - s.point1;
    for (const Vec3& end : {p0, q0}) REQUIRE(r.dot(end - s.point0) > -1e-8);
    for (const Vec3& end : {p1, q1}) REQUIRE(r.dot(end - s.point1) < 1e-8);
    const SegmentSegment other = closest_between_segments(p1, q1, p0, q0);
    REQUIRE(other.squared_distance == s.squared_distance);
    REQUIRE(other.point0 == s.point1);
    REQUIRE(other.point1 == s.point0);
    REQUIRE(other.interior == s.interior);
  }
  CHECK(interior > 1000);
}

TEST_CASE("distance of triangles is that of the planes that separate them", "[distance]") {
  Random random(2003);
  int apart = 0;
  for (int i = 0; i < 20000; ++i) {
    TriangleCorners a = random_triangle(random, i);
    const TriangleCorners b = random_triangle(random, i / 7);
    const Vec3 shift = 1.5 * random.vector();
    for (Vec3& c : a) c += shift;
    const double distance = triangle_distance(a, b);
    const TriangleTriangle f = closest_features(a, b);
    CHECK(triangle_distance(b, a) == Approx(distance).margin(1e-15));
    if (distance == 0.0) continue;
    ++apart;
    REQUIRE(distance == Approx((f.point0 - f.point1).norm()).epsilon(1e-12));
    // a supporting plane of each at that distance: nothing of them can be nearer
    const Vec3 n = (f.point0 - f.point1) / distance;
    double low = 1e9, high = -1e9;
    for (const Vec3& c : a) low = std::min(low, n.dot(c));
    for (const Vec3& c : b) high = std::max(high, n.dot(c));
    REQUIRE(low - high == Approx(distance).epsilon(1e-9).margin(1e-10));
    CHECK(features_within(a, b, distance * (1.0 + 1e-12)));
    CHECK_FALSE(features_within(a, b, distance * (1.0 - 1e-12)));
  }
  CHECK(apart > 5000);
}
