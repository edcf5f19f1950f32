#include <catch2/catch.hpp>

#include "engine/geometry/inside.hpp"
#include "engine/geometry/triangle_intersection.hpp"
#include "engine/world/judge.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/mechanics/worlds.hpp"
#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

OverlapVerdict verdict_of(const SharedShape& a, const Vec3& xa, const SharedShape& b) {
  Bodies bodies;
  bodies.add(make_body(dynamic_body("a", a, xa)));
  bodies.add(make_body(dynamic_body("b", b, Vec3::Zero())));
  return judge_overlap(bodies);
}

double penetration(const SharedShape& a, const Vec3& xa, const Vec3& ra, const SharedShape& b, const Vec3& xb,
                   std::int64_t* crossings = nullptr) {
  BodyDescription da = dynamic_body("a", a, xa), db = dynamic_body("b", b, xb);
  da.rotation = ra;
  if (b->as<Plane>() != nullptr) db.kind = BodyKind::fixed;
  Bodies bodies;
  bodies.add(make_body(da));
  bodies.add(make_body(db));
  const OverlapVerdict verdict = judge_overlap(bodies);
  if (crossings) *crossings = verdict.intersections;
  return verdict.penetration;
}

}  // namespace

TEST_CASE("the overlap judge agrees with formulas for every pair of exact shapes") {
  const Plane floor{Vec3::UnitY(), 0.0};
  const Box unit{Vec3::Constant(0.5)};
  const Capsule capsule{0.2, 0.3};
  const Vec3 o = Vec3::Zero();
  CHECK(penetration(Sphere{0.5}, {0, 0.4, 0}, o, floor, o) == Approx(0.1));
  CHECK(penetration(unit, {0, 0.45, 0}, o, floor, o) == Approx(0.05));
  CHECK(penetration(unit, {0, 0.6, 0}, {0, 0, 45}, floor, o) == Approx(std::sqrt(0.5) - 0.6));
  CHECK(penetration(capsule, {0, 0.15, 0}, {0, 0, 90}, floor, o) == Approx(0.05));
  CHECK(penetration(capsule, {0, 0.45, 0}, o, floor, o) == Approx(0.05));
  CHECK(penetration(Sphere{0.5}, {0.8, 0, 0}, o, Sphere{0.4}, o) == Approx(0.1));
  CHECK(penetration(Sphere{0.5}, {0.9, 0.2, -0.3}, o, unit, o) == Approx(0.1));
  CHECK(penetration(Sphere{0.1}, {0.3, 0, 0}, o, unit, o) == Approx(0.3));  // its centre lies 0.2 inside
  CHECK(penetration(capsule, {0.65, 0, 0.1}, o, unit, o) == Approx(0.05));
  CHECK(penetration(capsule, {0.35, 0.2, 0}, o, capsule, o) == Approx(0.05));
  CHECK(penetration(unit, {0.9, 0.3, 0.2}, o, unit, o) == Approx(0.1));
  CHECK(penetration(unit, {0.5 + std::sqrt(0.5) - 0.02, 0, 0}, {0, 45, 0}, unit, o) == Approx(0.02));
  for (const SharedShape& s : {SharedShape(Sphere{0.5}), SharedShape(unit), SharedShape(capsule)})
    for (const SharedShape& t : {SharedShape(Sphere{0.5}), SharedShape(unit), SharedShape(capsule)})
      CHECK(penetration(s, {2.1, 0, 0}, {10, 20, 30}, t, o) == 0.0);
}

TEST_CASE("the overlap judge agrees with the exact box when boxes are given as meshes") {
  Random random(11);
  const Vec3 half(0.5, 0.4, 0.3);
  for (int i = 0; i < 30; ++i) {
    const Vec3 turn = 180.0 * random.vector();
    const Vec3 place = random.direction() * random.in(0.55, 0.9);
    const Sphere ball{0.25};
    CHECK(penetration(make_box_mesh(half), place, turn, ball, Vec3::Zero()) ==
          Approx(penetration(Box{half}, place, turn, ball, Vec3::Zero())).margin(1e-12));
  }
  std::int64_t crossings = 0;
  CHECK(penetration(make_box_mesh(half), {0.97, 0.1, 0.08}, {0, 0, 0}, make_box_mesh(half), Vec3::Zero(), &crossings) ==
        Approx(0.03));
  CHECK(crossings > 0);
  CHECK(penetration(make_box_mesh(half), {1.05, 0, 0}, {0, 0, 0}, make_box_mesh(half), Vec3::Zero(), &crossings) ==
        0.0);
  CHECK(crossings == 0);
}

namespace {

/// Two meshes where they are.
struct Meshes {
  Bodies bodies;
  Meshes(const TriangleMesh& a, const TriangleMesh& b) {
    for (const TriangleMesh* mesh : {&a, &b}) bodies.add(make_body(dynamic_body("m", surface(*mesh), Vec3::Zero())));
  }
};

/// The deepest inside b of `samples` points of every edge of a that has an end outside, metres.
double deepest_sample(const Body& a, const Body& b, int samples) {
  const std::vector<Triangle>&of_a = a.shape->mesh()->mesh.triangles, &of_b = b.shape->mesh()->mesh.triangles;
  double deepest = 0.0;
  for (const Triangle& t : of_a)
    for (int k = 0; k < 3; ++k) {
      const Vec3 &p = a.world_vertices[t[k]], &q = a.world_vertices[t[(k + 1) % 3]];
      const auto is_inside = [&](const Vec3& x) { return winding_number(x, b.world_vertices, of_b) > 0.5; };
      for (int i = 0; i < samples && !(is_inside(p) && is_inside(q)); ++i)
        if (const Vec3 x = p + i / (samples - 1.0) * (q - p); is_inside(x))
          deepest = std::max(deepest, distance_to_surface(x, b.world_vertices, of_b));
    }
  return deepest;
}

}  // namespace

TEST_CASE("plates of meshes that cross like an X are known to cross, though no vertex of either is in the other") {
  for (const double thick : {2e-4, 2e-3, 2e-2}) {
    const Meshes plates(box({0.5, 0.5 * thick, 0.3}), box({0.5 * thick, 0.5, 0.2}));
    const OverlapVerdict verdict = judge_overlap(plates.bodies);
    CHECK(verdict.penetration == 0.0);
    CHECK(verdict.crossing.depth == Approx(0.5 * thick));  // the middle of what runs through the plate
    CHECK(verdict.crossing.share() == Approx(0.5));
  }
}

TEST_CASE("edges of a mesh that run through an exact shape are known to, by the formula of a cube's edge") {
  const double half = 0.5 * std::sqrt(2.0);  // of a cube of 1 m that stands on its edge
  for (const double depth : {1e-4, 1e-2, 0.1})
    for (const double turn : {17.0, 60.0, 90.0}) {
      BodyDescription lower = dynamic_body("lower", Box{Vec3::Constant(0.5)}, Vec3::Zero()), upper = lower;
      lower.rotation = {45.0, 0.0, 0.0};
      upper.name = "upper", upper.shape = make_box_mesh(Vec3::Constant(0.5));
      upper.position = {0.0, 2.0 * half - depth, 0.0};
      upper.rotation = {45.0, turn, 0.0};
      Bodies bodies;
      bodies.add(make_body(lower));
      bodies.add(make_body(upper));
      const OverlapVerdict verdict = judge_overlap(bodies);
      CAPTURE(depth, turn);
      CHECK(verdict.penetration == 0.0);
      CHECK(verdict.deepest == Approx(depth / std::sqrt(2.0)));  // below both faces that slope by 45 degrees
    }
}

TEST_CASE("how deep edges of two meshes run through one another is what points of all edges say") {
  Random random(23);
  int edges_alone = 0;
  for (int i = 0; i < 100; ++i) {
    const Mat3 turn = Eigen::AngleAxisd(random.in(0.0, 3.0), random.direction()).toRotationMatrix();
    TriangleMesh turned = i % 2 == 0 ? box({0.5, 0.4, 0.3}) : icosphere(1, 0.4);
    const Vec3 place = random.direction() * random.in(0.6, 0.9);
    for (Vec3& v : turned.vertices) v = turn * v + place;
    const Meshes pair(turned, box({0.45, 0.3, 0.5}));
    const Body &a = pair.bodies[BodyIndex(0)], &b = pair.bodies[BodyIndex(1)];
    const int samples = 201;
    const OverlapVerdict verdict = judge_overlap(pair.bodies);
    const double sampled =
        std::max({deepest_sample(a, b, samples), deepest_sample(b, a, samples), verdict.penetration});
    CAPTURE(i, sampled, verdict.penetration, verdict.deepest);
    CHECK(verdict.deepest >= sampled - 1e-12);
    CHECK(verdict.deepest <= sampled + 0.6 * std::sqrt(2.0) / samples);  // half the way between two of them
    edges_alone += sampled > verdict.penetration + 1e-3;
  }
  CHECK(edges_alone >= 20);
}

TEST_CASE("winding number and distance of a box are those of the box") {
  const Vec3 half(0.5, 1.0, 0.25);
  const MeshPointer box = make_box_mesh(half);
  Random random(12);
  for (int i = 0; i < 300; ++i) {
    const Vec3 x = 1.5 * random.vector();
    const Vec3 q = x.cwiseAbs() - half;
    CHECK(winding_number(x, box->mesh.vertices, box->mesh.triangles) ==
          Approx(q.maxCoeff() < 0.0 ? 1.0 : 0.0).margin(1e-9));
    const double distance = q.maxCoeff() < 0.0 ? -q.maxCoeff() : q.cwiseMax(0.0).norm();
    CHECK(distance_to_surface(x, box->mesh.vertices, box->mesh.triangles) == Approx(distance).margin(1e-12));
  }
}

TEST_CASE("meshes in one place overlap, though every vertex and edge of the one is on the other's surface") {
  const SharedShape ball = surface(icosphere(2, 0.1)), ring = surface(torus(0.1, 0.02, 24, 12));
  const Vec3 o = Vec3::Zero();
  for (const SharedShape& shape : {ball, ring}) {
    const OverlapVerdict verdict = verdict_of(shape, o, shape);
    CHECK(verdict.penetration < 1e-12);  // of vertices, as ever
    CHECK(verdict.deepest > 0.3 * shape->thickness());
    CHECK(verdict.deepest <= 0.5 * shape->thickness());
    CHECK(verdict.crossing.share() > 0.1);
  }
  const SharedShape cube = make_box_mesh(Vec3::Constant(0.1));
  // boxes that share the planes of four sides; points half way through tell two thirds of the 0.05 and 0.1 m at least
  CHECK(verdict_of(cube, {0.1, 0.0, 0.0}, cube).deepest > 0.033);
  CHECK(verdict_of(cube, o, Box{Vec3::Constant(0.1)}).deepest > 0.066);
  // and those that only touch don't
  CHECK(verdict_of(cube, {0.2, 0.0, 0.0}, cube).deepest < 1e-12);
  CHECK(verdict_of(cube, {0.0, 0.2, 0.05}, cube).deepest < 1e-12);
  CHECK(verdict_of(cube, {0.2, 0.0, 0.0}, Box{Vec3::Constant(0.1)}).deepest < 1e-12);
}

TEST_CASE("how much of a thickness an overlap is goes by the wall of a hollow body") {
  TriangleMesh shell = icosphere(3, 0.2);
  append(shell, inside_out(icosphere(3, 0.19)));
  // a ball of 50 mm whose side is 2 mm in the wall from within
  const OverlapVerdict verdict = verdict_of(surface(icosphere(3, 0.05)), {0.142, 0.0, 0.0}, surface(std::move(shell)));
  CHECK(verdict.deepest == Approx(2e-3).epsilon(0.2));
  CHECK(verdict.crossing.thickness == Approx(0.01).epsilon(0.1));
  CHECK(verdict.crossing.share() > 0.1);
}

namespace {

/// An open heightfield with hills, 2 m × 2 m.
TriangleMesh hilly_ground(int n) {
  TriangleMesh mesh = sheet(1.0, n);
  for (Vec3& v : mesh.vertices)
    v.y() = 0.1 * std::sin(9.0 * v.x()) * std::cos(7.0 * v.z()) - 0.6 * (v.x() * v.x() + v.z() * v.z());
  return mesh;
}

double deepest_of_vertices(const std::vector<Vec3>& points, const Body& mesh) {
  double deepest = 0.0;
  const std::vector<Triangle>& triangles = mesh.shape->mesh()->mesh.triangles;
  for (const Vec3& x : points)
    if (winding_number(x, mesh.world_vertices, triangles) > 0.5)
      deepest = std::max(deepest, distance_to_surface(x, mesh.world_vertices, triangles));
  return deepest;
}

}  // namespace

TEST_CASE("what stands on an open ground of many triangles is judged as all of them say, one by one") {
  Random random(41);
  const SharedShape fine = surface(hilly_ground(32)), coarse = surface(hilly_ground(12));
  const Vec3 half(0.08, 0.05, 0.11);
  const double radius = 0.1;
  int overlaps = 0, crossings = 0, edges_alone = 0;
  for (int i = 0; i < 60; ++i) {
    const SharedShape& ground = i % 2 == 0 ? fine : coarse;  // of which edges alone may run through what stands there
    const double x = random.in(-0.7, 0.7), z = random.in(-0.7, 0.7);
    const Vec3 place(x, 0.1 * std::sin(9.0 * x) * std::cos(7.0 * z) - 0.6 * (x * x + z * z) + random.in(-0.05, 0.13),
                     z);
    const SharedShape shape = i % 3 == 0   ? SharedShape(Sphere{radius})
                              : i % 3 == 1 ? SharedShape(Box{half})
                                           : SharedShape(make_box_mesh(half));
    BodyDescription on = dynamic_body("on", shape, place), below = dynamic_body("ground", ground, Vec3::Zero());
    on.rotation = 180.0 * random.vector();
    below.kind = BodyKind::fixed;
    Bodies bodies;
    bodies.add(make_body(below));
    bodies.add(make_body(on));
    const Body &b = bodies[BodyIndex(0)], &a = bodies[BodyIndex(1)];
    const std::vector<Triangle>& triangles = ground->mesh()->mesh.triangles;
    double depth = 0.0, of_edges = 0.0, longest = 0.0;
    std::int64_t crossing = 0;
    const auto in_solid = [&](const Vec3& p) { return -shape->signed_distance(a.pose.apply_inverse(p)); };
    if (i % 3 < 2)
      for (const Triangle& t : triangles)
        for (int k = 0; k < 3; ++k) {
          const Vec3 &p = b.world_vertices[t[k]], &q = b.world_vertices[t[(k + 1) % 3]];
          depth = std::max(depth, in_solid(p));
          longest = std::max(longest, (q - p).norm());
          if ((p - place).norm() < 0.3)
            for (int s = 0; s <= 50; ++s) of_edges = std::max(of_edges, in_solid(p + s / 50.0 * (q - p)));
        }
    if (i % 3 == 0) {
      const double away = distance_to_surface(place, b.world_vertices, triangles);
      const bool is_inside = winding_number(place, b.world_vertices, triangles) > 0.5;
      depth = std::max(depth, radius + (is_inside ? away : -away));
    } else {
      std::vector<Vec3> corners;
      for (int k = 0; k < 8; ++k)
        corners.push_back(a.pose.apply(half.cwiseProduct(Vec3(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1))));
      depth = std::max(depth, deepest_of_vertices(corners, b));
    }
    if (i % 3 == 2) {
      depth = std::max(depth, deepest_of_vertices(b.world_vertices, a));
      for (const Triangle& s : shape->mesh()->mesh.triangles)
        for (const Triangle& t : triangles)
          crossing += triangles_intersect({a.world_vertices[s[0]], a.world_vertices[s[1]], a.world_vertices[s[2]]},
                                          {b.world_vertices[t[0]], b.world_vertices[t[1]], b.world_vertices[t[2]]});
    }
    JudgeMemory memory;
    const OverlapVerdict verdict = judge_overlap(bodies, memory), again = judge_overlap(bodies, memory);
    CAPTURE(i, place, depth, of_edges);
    CHECK(verdict.penetration == Approx(depth).margin(1e-12));
    CHECK(verdict.intersections == crossing);
    CHECK(verdict.deepest >= std::max(depth, of_edges) - 1e-12);
    if (i % 3 < 2) CHECK(verdict.deepest <= std::max(depth, of_edges + longest / 100.0) + 1e-12);
    CHECK(again.penetration == verdict.penetration);
    CHECK(again.deepest == verdict.deepest);
    overlaps += depth > 0.0;
    crossings += crossing > 0;
    edges_alone += of_edges > depth + 1e-6;
  }
  CHECK(overlaps > 20);
  CHECK(crossings > 5);
  CHECK(edges_alone > 0);
}
