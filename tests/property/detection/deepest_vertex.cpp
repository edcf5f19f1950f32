// What max_penetration says of meshes that overlap, beside the judge, which shares nothing with it.
#include "engine/detection/contacts/deepest_vertex.hpp"

#include <catch2/catch.hpp>

#include "engine/geometry/inside.hpp"
#include "engine/world/judge.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/geometry/sample_shapes.hpp"
#include "tests/support/mechanics/worlds.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

TriangleMesh mesh_number(int k) {
  if (k == 0) return box(Vec3(0.3, 0.2, 0.25), {3, 2, 4});
  if (k == 1) return icosphere(2, 0.3);
  if (k == 2) return bumpy_sphere(3, 0.25);
  return torus(0.4, 0.12, 24, 10);
}

/// Within 2 of how deep vertices are, as judged_penetration_m is of those; where they hardly are, of edges.
void check_shown(const World& world, const OverlapVerdict& truth) {
  const auto extent = [&](int body) { return world.bodies()[body].bounds().extent().norm(); };
  const double shown = world.record().stats.max_penetration;
  CAPTURE(shown, truth.penetration, truth.deepest);
  CHECK(shown >= truth.penetration * (1.0 - 1e-9));
  const double most = truth.penetration > 1e-6 * std::min(extent(0), extent(1)) ? 2.0 * truth.penetration : INFINITY;
  CHECK(shown >= std::min(truth.deepest / 1.06, most * (1.0 - 1e-9)));  // edges are searched to 5 %
  CHECK(shown <= 2.0 * truth.deepest * (1.0 + 1e-9));
  if (truth.penetration > 1e-6) CHECK(shown <= 2.0 * truth.penetration * (1.0 + 1e-9));
}

BodyDescription posed(const char* name, MeshPointer mesh, const Vec3& at, Random& random) {
  BodyDescription d = dynamic_body(name, std::move(mesh), at);
  d.rotation = 120.0 * random.vector();
  return d;
}

}  // namespace

TEST_CASE("max_penetration of 300 random poses of two meshes is the judge's, edges between their ends included") {
  Random random(20);
  int overlapping = 0, by_edges = 0;
  for (int i = 0; i < 300; ++i) {
    World world;
    world.parameters.simulation.gravity.setZero();
    world.add_body(posed("a", surface(mesh_number(random.below(4))), Vec3::Zero(), random));
    world.add_body(
        posed("b", surface(mesh_number(random.below(4))), random.in(0.05, 0.7) * random.direction(), random));
    world.start();
    const OverlapVerdict truth = judge_overlap(world.bodies());
    const double shown = world.record().stats.max_penetration;
    CAPTURE(i, truth.penetration, truth.intersections, shown);
    if (truth.intersections == 0) continue;  // apart, or the one wholly inside the other
    if (truth.deepest > 1e-6) {
      ++overlapping;
      if (truth.deepest > 1.1 * truth.penetration) ++by_edges;
      check_shown(world, truth);
    }
    double deepest = 0.0;
    for (const ContactRecord& c : world.record().contacts) {
      CHECK(c.gap == Approx(c.normal.dot(c.point_a - c.point_b)).margin(1e-12));
      CHECK(c.normal.norm() == Approx(1.0));
      deepest = std::max(deepest, -c.gap);
    }
    CHECK(shown == deepest);
  }
  CHECK(overlapping > 150);
  CHECK(by_edges > 10);
}

TEST_CASE("plates, bars and rings of meshes that cross show how deep their edges are in one another") {
  Random random(26);
  const TriangleMesh thin[] = {box(Vec3(0.4, 0.01, 0.3), {3, 1, 2}), box(Vec3(0.5, 0.04, 0.03), {1, 1, 1}),
                               torus(0.2, 0.02, 20, 6)};
  int by_edges = 0;
  for (int i = 0; i < 200; ++i) {
    World world;
    world.parameters.simulation.gravity.setZero();
    world.add_body(posed("a", surface(thin[random.below(3)]), Vec3::Zero(), random));
    world.add_body(posed("b", surface(thin[random.below(3)]), random.in(0.0, 0.25) * random.direction(), random));
    world.start();
    const OverlapVerdict truth = judge_overlap(world.bodies());
    CAPTURE(i);
    if (truth.deepest > 1.1 * std::max(truth.penetration, 1e-6)) ++by_edges;
    if (truth.deepest <= 1e-6) continue;
    check_shown(world, truth);
  }
  CHECK(by_edges > 60);
}

TEST_CASE("max_penetration of meshes that meet faster than contacts see is the judge's") {
  Random random(21);
  int overlapping = 0;
  for (int i = 0; i < 60; ++i) {
    World world;
    world.parameters.simulation.gravity.setZero();
    world.parameters.simulation.substeps = 1;
    world.parameters.narrow_phase.continuous = Continuous::off;
    world.add_body(posed("a", surface(mesh_number(random.below(4))), Vec3::Zero(), random));
    BodyDescription b = posed("b", surface(mesh_number(random.below(4))), 0.8 * random.direction(), random);
    b.velocity = -random.in(2.0, 8.0) * b.position / b.position.norm();
    b.angular_velocity = 5.0 * random.vector();
    world.add_body(b);
    world.start();
    for (int frame = 0; frame < 12; ++frame) {
      world.step();
      const OverlapVerdict truth = judge_overlap(world.bodies());
      if (truth.intersections == 0 || truth.penetration < 1e-6) continue;
      ++overlapping;
      CAPTURE(i, frame, truth.intersections);
      check_shown(world, truth);
      CHECK(world.record().stats.substep_penetration >= world.record().stats.max_penetration);
    }
  }
  CHECK(overlapping > 100);
}

TEST_CASE("a mesh that falls past an exact shape in one sub-step is shown to overlap it no more than it does") {
  // its contacts' points are a hand apart afterwards, and what lies between them along the normal is nobody's overlap
  Random random(23);
  const SharedShape pegs[] = {cylinder(0.03, 0.6), cone(0.03, 0.6), Capsule{0.03, 0.27}, Box{Vec3(0.03, 0.3, 0.03)}};
  int met = 0;
  for (int i = 0; i < 40; ++i) {
    World world;
    world.parameters.simulation.substeps = 1;
    BodyDescription peg = dynamic_body("peg", pegs[i % 4], {0.0, 0.3, 0.0});
    peg.kind = BodyKind::fixed;
    world.add_body(peg);
    BodyDescription ring = dynamic_body("ring", surface(torus(0.05, 0.012, 16, 8)), {0.004, 0.45, 0.004});
    ring.rotation = 10.0 * random.vector();
    ring.velocity = {0.3 * random.sym(), -random.in(1.0, 4.0), 0.3 * random.sym()};
    world.add_body(ring);
    world.start();
    for (int frame = 0; frame < 25; ++frame) {
      world.step();
      met += world.record().stats.contacts > 0 ? 1 : 0;
      CAPTURE(i, frame);
      CHECK(world.record().stats.max_penetration <= 2.0 * judge_overlap(world.bodies()).deepest + 1e-6);
    }
  }
  CHECK(met > 100);
}

TEST_CASE("of a bending surface that has folded over no vertex is in that it doesn't wind round") {
  Random random(22);
  ColliderSet bodies;
  const MeshPointer cube = surface(box({0.5, 0.5, 0.5}, {4, 4, 4}));
  const int bending = bodies.add(cube), ball = bodies.add(surface(icosphere(2, 0.2)));
  std::vector<TrianglePair> all;
  for (int ta = 0; ta < static_cast<int>(cube->mesh.triangles.size()); ++ta)
    for (int tb = 0; tb < static_cast<int>(bodies[ball].mesh().mesh.triangles.size()); ++tb)
      all.push_back({BodyIndex(bending), BodyIndex(ball), TriangleIndex(ta), TriangleIndex(tb)});
  int overlapping = 0, only_edges = 0;
  for (int i = 0; i < 600; ++i) {
    std::vector<Vec3> vertices = cube->mesh.vertices;
    for (Vec3& v : vertices)  // of the top, over their neighbours, which are 0.25 away
      if (v.y() == 0.5 && random.sym() > 0.5) v += Vec3(0.5, 0.02, 0.5).cwiseProduct(random.vector());
    bodies.place(bending, vertices);
    bodies.place(ball,
                 Pose{random.rotation(), Vec3(0.3 * random.sym(), 0.7 + 0.02 * random.sym(), 0.3 * random.sym())});
    double truth = 0.0;
    const auto take = [&](const Collider& own, const Collider& other) {
      for (const Vec3& x : own.vertices)
        if (winding_number(x, other.vertices, other.mesh().mesh.triangles) > 0.5)
          truth = std::max(truth, distance_to_surface(x, other.vertices, other.mesh().mesh.triangles));
    };
    take(bodies[bending], bodies[ball]);
    take(bodies[ball], bodies[bending]);
    const MeshOverlap found = find_overlap(bodies.all(), {BodyIndex(bending), BodyIndex(ball)}, all);
    const double shown = found.deepest ? -found.deepest->gap : 0.0;
    CAPTURE(i, truth, shown);
    CHECK(shown <= truth + 1e-12);
    overlapping += shown > 0.0, only_edges += found.crosses && truth == 0.0;
  }
  CHECK(overlapping > 100);
  CHECK(only_edges > 5);
}
