#include <catch2/catch.hpp>

#include "engine/geometry/inside.hpp"
#include "engine/world/judge.hpp"
#include "tests/support/mechanics/worlds.hpp"
#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

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
