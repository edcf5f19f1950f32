// Vertex–face and edge–edge in motion against formulas, planted meetings and the exact answers of a published set.
#include "engine/geometry/continuous.hpp"

#include <catch2/catch.hpp>

#include "tests/support/geometry/meshes.hpp"
#include "tests/support/random.hpp"
#include "viewer/study/verify_ccd.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

using Find = std::optional<Impact> (*)(const MovingCorners&, const ContinuousSettings&);

const Find kVertexFace[] = {vertex_face_impact, vertex_face_advancement};
const Find kEdgeEdge[] = {edge_edge_impact, edge_edge_advancement};

/// A vertex falls from z = 1 to z = -1 on a triangle in z = 0.
MovingCorners falling() {
  MovingCorners c;
  c.start = {Vec3(0.2, 0.2, 1.0), Vec3(0.0, 0.0, 0.0), Vec3(1.0, 0.0, 0.0), Vec3(0.0, 1.0, 0.0)};
  c.end = c.start;
  c.end[0].z() = -1.0;
  return c;
}

MovingCorners crossing_edges() {
  MovingCorners c;
  c.start = {Vec3(-1.0, 0.0, 1.0), Vec3(1.0, 0.0, 1.0), Vec3(0.0, -1.0, 0.0), Vec3(0.0, 1.0, 0.0)};
  c.end = c.start;
  c.end[0].z() = c.end[1].z() = -1.0;
  return c;
}

/// Four corners moving at random of which the features meet at a time and place that are known, to rounding.
MovingCorners planted(Random& r, bool edges, double& time) {
  MovingCorners c;
  const double size = std::pow(10.0, r.in(-3.0, 3.0)), far = r.below(4) == 0 ? 1e3 * size : 0.0;
  const Vec3 shift = far * r.vector();
  for (int k = 0; k < 4; ++k) c.start[k] = size * r.vector() + shift, c.end[k] = size * r.vector() + shift;
  if (r.below(5) == 0) c.end[1] = c.start[1], c.end[2] = c.start[2], c.end[3] = c.start[3];
  time = r.in(0.05, 1.0);
  double u = r.u(), v = r.u();
  if (!edges && u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
  std::array<Vec3, 4> p;
  for (int k = 0; k < 4; ++k) p[k] = c.start[k] + time * (c.end[k] - c.start[k]);
  const Vec3 meeting = edges ? Vec3(p[2] + v * (p[3] - p[2])) : Vec3(p[1] + u * (p[2] - p[1]) + v * (p[3] - p[1]));
  // the first corner's end is chosen so that it is there, or that its edge is
  const Vec3 corner = edges ? Vec3((meeting - u * p[1]) / (1.0 - std::min(u, 0.9))) : meeting;
  if (edges && u > 0.9) return planted(r, edges, time);
  c.end[0] = c.start[0] + (corner - c.start[0]) / time;
  return c;
}

}  // namespace

TEST_CASE("a point that falls on a triangle, and crossing edges, meet halfway", "[continuous]") {
  for (const double separation : {0.0, 0.1}) {
    const ContinuousSettings settings{separation, 1e-7};
    const double truth = 0.5 - 0.5 * separation;
    for (const Find find : kVertexFace) {
      const std::optional<Impact> impact = find(falling(), settings);
      REQUIRE(impact);
      CHECK(impact->time <= truth);
      CHECK(impact->time == Approx(truth).margin(1e-6));
      CHECK((impact->place - Vec2(0.2, 0.2)).norm() < (separation == 0.0 ? 1e-5 : 0.2));
    }
    for (const Find find : kEdgeEdge) {
      const std::optional<Impact> impact = find(crossing_edges(), settings);
      REQUIRE(impact);
      CHECK(impact->time <= truth);
      CHECK(impact->time == Approx(truth).margin(1e-6));
    }
  }
  MovingCorners beside = falling();
  beside.start[0].x() = beside.end[0].x() = 1.2;
  for (const Find find : kVertexFace) CHECK_FALSE(find(beside, {}));
  MovingCorners still = falling();
  still.end = still.start;
  for (const Find find : kVertexFace) CHECK_FALSE(find(still, {}));
}

TEST_CASE("what degenerates is met or not, and no number is lost", "[continuous]") {
  MovingCorners flat = falling();  // a triangle without area
  flat.start[3] = flat.end[3] = Vec3(0.5, 0.0, 0.0);
  flat.start[0] = Vec3(0.4, 0.0, 1.0), flat.end[0] = Vec3(0.4, 0.0, -1.0);
  MovingCorners parallel = crossing_edges();
  parallel.start[2] = parallel.end[2] = Vec3(-1.0, 0.0, 0.0);
  parallel.start[3] = parallel.end[3] = Vec3(1.0, 0.0, 0.0);
  for (const Find find : kVertexFace) {
    const std::optional<Impact> impact = find(flat, {0.0, 1e-6, 100'000});
    REQUIRE(impact);
    CHECK(impact->time == Approx(0.5).margin(1e-3));
    CHECK(impact->place.allFinite());
  }
  for (const Find find : kEdgeEdge) {
    const std::optional<Impact> impact = find(parallel, {0.0, 1e-6, 100'000});
    REQUIRE(impact);
    CHECK(impact->time <= 0.5);
    CHECK(impact->time > 0.45);
    CHECK(impact->place.allFinite());
  }
}

namespace {

void check_planted(int count, std::uint64_t seed) {
  Random r(seed);
  int missed = 0, late = 0;
  for (int i = 0; i < count; ++i) {
    const bool edges = i % 2 == 1;
    double time = 0.0;
    const MovingCorners c = planted(r, edges, time);
    double size = 0.0;
    for (int k = 0; k < 4; ++k) size = std::max({size, (c.start[k] - c.start[1]).norm(), (c.end[k] - c.end[1]).norm()});
    const double rounding = 1e-13 * (size + c.start[0].norm() + c.end[0].norm());
    for (const Find find : edges ? kEdgeEdge : kVertexFace) {
      const std::optional<Impact> impact = find(c, {rounding, 1e-3 * size, 1'000'000});
      if (!impact) ++missed;
      if (impact && impact->time > time + 1e-12) ++late;
    }
  }
  INFO("seed " << seed << ", " << count << " planted meetings");
  CHECK(missed == 0);
  CHECK(late == 0);
}

}  // namespace

TEST_CASE("no planted meeting is missed or found too late", "[continuous]") { check_planted(20'000, 1); }

TEST_CASE("no planted meeting of a million is missed or found too late", "[continuous][long]") {
  check_planted(1'000'000, 2);
}

TEST_CASE("no meeting of the published queries is missed, and few others are called one", "[continuous]") {
  const std::string readme = shared_file("ccd-queries/README.md");
  if (readme.empty()) {
    WARN("skipped: no ccd-queries in the shared data folder");
    return;
  }
  int meetings = 0, missed = 0, others = 0, alarms = 0;
  for (const CcdScore& score :
       score_ccd(read_ccd_sets(std::filesystem::path(readme).parent_path()), {0.0, 1e-6, 20'000})) {
    missed += score.missed;
    if (score.method != "inclusion") continue;
    if (score.set == "all") meetings = score.meetings;
    if (score.set == "unit-tests") CHECK(score.alarms == 0);
    if (score.set != "all" && score.set != "unit-tests") others += score.others, alarms += score.alarms;
  }
  CHECK(meetings == 302);
  CHECK(missed == 0);
  CHECK(others == 2358);
  CHECK(alarms <= 7);
}

namespace {

Vec3 whole(Random& r, int most) {  // divisible by four
  return Vec3(4.0 * (r.below(2 * most + 1) - most), 4.0 * (r.below(2 * most + 1) - most),
              4.0 * (r.below(2 * most + 1) - most));
}

}  // namespace

TEST_CASE("what meets exactly is found with no separation at all, also in a plane or on a line", "[continuous]") {
  Random r(3);
  int missed = 0;
  for (int i = 0; i < 20'000; ++i) {
    const bool edges = i % 2 == 1;
    MovingCorners c;
    for (auto* p : {&c.start, &c.end})
      for (Vec3& x : *p) x = whole(r, 1 << r.below(12));
    // at half the time, exactly: the vertex in the face, or the middles of the edges in one point
    const auto twice = [&](int k) { return Vec3(c.start[k] + c.end[k]); };
    c.end[0] = edges ? Vec3(twice(2) + twice(3) - twice(1) - c.start[0])
                     : Vec3(0.5 * twice(1) + 0.25 * (twice(2) + twice(3)) - c.start[0]);
    for (auto* p : {&c.start, &c.end})
      for (Vec3& x : *p) {
        if (i % 3 == 1) x.z() = x.x() + x.y();
        if (i % 3 == 2) x = Vec3(x.x(), x.x(), -x.x());
      }
    const auto find = edges ? edge_edge_impact : vertex_face_impact;
    if (!find(c, {0.0, 1.0, 2000})) ++missed;
  }
  CHECK(missed == 0);
}

TEST_CASE("what slides along each other a rounding apart is not taken for a contact", "[continuous]") {
  Random r(4);
  int alarms = 0;
  constexpr int kQueries = 3000;
  for (int i = 0; i < kQueries; ++i) {
    const bool edges = i % 2 == 1;
    const int of_first = edges ? 2 : 1;
    MovingCorners c;
    for (auto* p : {&c.start, &c.end})
      for (int k = 0; k < 4; ++k) {
        Vec3& x = (*p)[k] = whole(r, 8);
        x.z() = 3.0 * x.x() - 2.0 * x.y();                // all in one plane,
        if (k < of_first) x.z() += std::ldexp(1.0, -45);  // and the first feature a few roundings above it
      }
    const auto find = edges ? edge_edge_impact : vertex_face_impact;
    if (find(c, {0.0, 1e-6, 2000})) ++alarms;
  }
  CHECK(alarms == 0);
}
