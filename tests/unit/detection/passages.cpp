// The earliest passage of two surfaces against what a formula says of it.
#include "engine/detection/continuous/passages.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "engine/geometry/rotation.hpp"
#include "tests/support/geometry/meshes.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

SurfacePath moving(const PathSurface& surface, const Pose& from, const Pose& to) {
  SurfacePath path;
  path.of = &surface;
  path.poses = {from, to};
  return path;
}

Pose moved_to(double x, double y, double z) { return {Mat3::Identity(), Vec3(x, y, z)}; }

const Passage& first(const std::vector<Passage>& passages) {
  return *std::min_element(passages.begin(), passages.end(),
                           [](const Passage& l, const Passage& r) { return l.time < r.time; });
}

double first_time(const std::vector<Passage>& passages) { return first(passages).time; }

}  // namespace

TEST_CASE("a ball that flies through a plate is seen at the moment of its meeting, from both sides", "[continuous]") {
  const MeshPointer ball = surface(icosphere(3, 0.05)), plate = surface(box(Vec3(0.5, 1e-3, 0.5), {10, 1, 10}));
  const PathSurface of_ball(*ball), of_plate(*plate);
  double lowest = 0.0;
  for (const Vec3& x : ball->mesh.vertices) lowest = std::min(lowest, x.y());
  Random r(5);
  for (int i = 0; i < 50; ++i) {
    const double y0 = r.in(0.06, 0.5), y1 = r.in(-3.0, -0.1), x = r.in(-0.3, 0.3);
    const SurfacePath flies = moving(of_ball, moved_to(x, y0, 0.02), moved_to(x + r.in(-0.1, 0.1), y1, 0.02)),
                      stands = moving(of_plate, moved_to(0, 0, 0), moved_to(0, 0, 0));
    const double truth = (y0 + lowest - 1e-3) / (y0 - y1);
    const std::vector<Passage> found = first_passages(flies, stands, {}), other = first_passages(stands, flies, {});
    REQUIRE_FALSE(found.empty());
    CHECK(first_time(found) <= truth + 1e-12);
    CHECK(first_time(found) == Approx(truth).margin(2e-6));
    CHECK(first_time(other) == Approx(first_time(found)).margin(1e-9));
    CHECK(first(found).normal.y() > 0.9);
    CHECK((first(other).normal + first(found).normal).norm() < 1e-6);
  }
}

TEST_CASE("what comes near, rests or leaves is no passage", "[continuous]") {
  const MeshPointer cube = surface(box(Vec3::Constant(0.05))), plate = surface(box(Vec3(0.5, 1e-3, 0.5), {10, 1, 10}));
  const PathSurface of_cube(*cube), of_plate(*plate);
  const SurfacePath stands = moving(of_plate, moved_to(0, 0, 0), moved_to(0, 0, 0));
  const double rest = 0.051;
  CHECK(first_passages(moving(of_cube, moved_to(0.01, 0.3, 0), moved_to(0.01, rest + 1e-9, 0)), stands, {}).empty());
  CHECK(first_passages(moving(of_cube, moved_to(0.01, rest, 0), moved_to(0.31, rest, 0.1)), stands, {}).empty());
  for (const double overlap : {-1e-9, 1e-12, 5e-8})
    for (const double turn : {0.0, 0.3}) {  // a cube that slides over edges and corners of the plate's squares
      const Mat3 turned = rotation_exp(Vec3(0, turn, 0));
      const SurfacePath slides =
          moving(of_cube, {turned, Vec3(-0.3, rest - overlap, 0.02)}, {turned, Vec3(0.31, rest - 1.1 * overlap, -0.1)});
      CHECK(first_passages(slides, stands, {}).empty());
    }
  CHECK(first_passages(moving(of_cube, moved_to(0.01, rest - 1e-5, 0), moved_to(0.01, 0.4, 0)), stands, {}).empty());
  CHECK(first_passages(moving(of_cube, moved_to(0.7, 0.3, 0), moved_to(0.7, -0.3, 0)), stands, {}).empty());
  CHECK_FALSE(
      first_passages(moving(of_cube, moved_to(0.01, rest, 0), moved_to(0.01, rest - 1e-5, 0)), stands, {}).empty());
}

TEST_CASE("a rod that turns meets a post when its face gets there", "[continuous]") {
  const MeshPointer rod = surface(box(Vec3(0.5, 0.01, 0.01), {20, 1, 1})), post = surface(box(Vec3(0.005, 0.2, 0.005)));
  const PathSurface of_rod(*rod), of_post(*post);
  constexpr int kPieces = 16;
  constexpr double kTurn = 3.0;  // radians about +y, which brings +x to -z
  SurfacePath turning;
  turning.of = &of_rod;
  for (int i = 0; i <= kPieces; ++i)
    turning.poses.push_back({rotation_exp(Vec3(0, kTurn * i / kPieces, 0)), Vec3::Zero()});
  for (const double angle : {0.4, 1.1, 2.0, 2.7}) {
    const Vec3 place(0.4 * std::cos(angle), 0.0, -0.4 * std::sin(angle));
    SurfacePath stands =
        moving(of_post, {rotation_exp(Vec3(0, angle, 0)), place}, {rotation_exp(Vec3(0, angle, 0)), place});
    const std::vector<Passage> found = first_passages(turning, stands, {});
    REQUIRE_FALSE(found.empty());
    // the post's nearest corner, in axes along and across the rod as it meets: across = 0.4 sin(rest) ... = 0.01
    double truth = INFINITY;
    for (int i = 0; i <= 3'000'000; ++i) {
      const double turn = kTurn * i / 3e6, left = angle - turn;
      double across = INFINITY;
      for (const double u : {-0.005, 0.005})
        for (const double v : {-0.005, 0.005})
          across = std::min(across, (0.4 + u) * std::sin(left) + v * std::cos(left));
      if (across <= 0.01) {
        truth = turn / kTurn;
        break;
      }
    }
    CHECK(first_time(found) == Approx(truth).margin(2e-3));
    CHECK(first_time(found) <= truth + 1e-5);
  }
}

TEST_CASE("two parts of one deforming surface meet when and where two surfaces of their own would", "[continuous]") {
  // parts, as one mesh and as two; each vertex goes its own way
  const TriangleMesh ball = icosphere(2, 0.05), block = box(Vec3(0.05, 0.03, 0.04), {3, 2, 3});
  TriangleMesh both = ball;
  const int first = static_cast<int>(ball.vertices.size());
  both.vertices.insert(both.vertices.end(), block.vertices.begin(), block.vertices.end());
  for (const Triangle& t : block.triangles) both.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  const MeshPointer one = surface(both), of_ball = surface(ball), of_block = surface(block);
  const PathSurface path_one(*one), path_ball(*of_ball), path_block(*of_block);
  Random r(11);
  int met = 0;
  for (int i = 0; i < 40; ++i) {
    std::vector<Vec3> start = both.vertices, end;
    const Vec3 way(r.in(-0.02, 0.02), r.in(-0.3, 0.05), r.in(-0.02, 0.02));
    for (int v = 0; v < static_cast<int>(start.size()); ++v) {
      if (v < first) start[v] += Vec3(0.01, 0.1, 0.0);
      end.push_back(start[v] + (v < first ? way : Vec3::Zero()) + 2e-3 * Vec3(r.in(-1, 1), r.in(-1, 1), r.in(-1, 1)));
    }
    const std::span<const Vec3> from(start), to(end);
    SurfacePath all, upper, lower;
    all.of = &path_one, all.start = from, all.end = to;
    upper.of = &path_ball, upper.start = from.first(first), upper.end = to.first(first);
    lower.of = &path_block, lower.start = from.subspan(first), lower.end = to.subspan(first);
    const std::vector<Passage> own = first_self_passages(all, {}), apart = first_passages(upper, lower, {});
    CHECK(own.empty() == apart.empty());
    if (own.empty() || apart.empty()) continue;
    ++met;
    CHECK(first_time(own) == Approx(first_time(apart)).margin(1e-5));
  }
  CHECK(met > 10);
}

TEST_CASE("a surface that only bends, shakes or flies does not pass itself", "[continuous]") {
  const TriangleMesh ball = icosphere(3, 0.05);
  const MeshPointer of_ball = surface(ball);
  const PathSurface path(*of_ball);
  Random r(12);
  for (int i = 0; i < 10; ++i) {
    std::vector<Vec3> end;
    const Mat3 turn = rotation_exp(Vec3(r.in(-0.5, 0.5), r.in(-0.5, 0.5), r.in(-0.5, 0.5)));
    for (const Vec3& x : ball.vertices)
      end.push_back(turn * x + Vec3(30.0, 0, 0) + 5e-4 * Vec3(r.in(-1, 1), r.in(-1, 1), r.in(-1, 1)));
    SurfacePath moves;
    moves.of = &path, moves.start = ball.vertices, moves.end = end;
    CHECK(first_self_passages(moves, {}).empty());
  }
}
