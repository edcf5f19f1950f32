// Gaps, normals and masses of cylinder, cone, hull and compound against formulas, and against a search of their own.
#include <catch2/catch.hpp>

#include "engine/geometry/convex/convex_gap.hpp"
#include "engine/world/judge_convex.hpp"
#include "tests/support/geometry/sample_shapes.hpp"
#include "tests/support/geometry/shapes.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

const ContactQuery kAll{true, 10.0, 0.0};

std::vector<Collision> contacts_of(const SharedShape& a, const Pose& pose_a, const SharedShape& b, const Pose& pose_b) {
  TestColliders bodies;
  bodies.add(a, pose_a);
  bodies.add(b, pose_b);
  return bodies.contacts(0, 1, kAll);
}

double gap_of(const SharedShape& a, const Pose& pose_a, const SharedShape& b, const Pose& pose_b) {
  return smallest_gap(contacts_of(a, pose_a, b, pose_b));
}

/// Distance in a half-plane: how far two intervals are apart along the axis and across it.
double apart(double beside, double above) {
  return std::hypot(std::max(beside, 0.0), std::max(above, 0.0)) + std::min(std::max(beside, above), 0.0);
}

const ConvexSet* set_of(const SharedShape& shape) { return std::get<const ConvexSet*>(shape->form()); }

}  // namespace

TEST_CASE("cylinder and cone over a plane are as high as their lowest point") {
  Random r(51);
  for (int i = 0; i < 400; ++i) {
    const double radius = r.in(0.1, 1.0), length = r.in(0.1, 2.0);
    Pose pose = random_pose(r, 1.0);
    if (i % 4 == 0) pose.rotation = Eigen::AngleAxisd(M_PI / 2 * r.below(4), Vec3::UnitZ()).toRotationMatrix();
    if (i % 4 == 1)
      pose.rotation = Eigen::AngleAxisd(std::pow(10.0, r.in(-14.0, -2.0)), r.direction()).toRotationMatrix();
    const SharedShape floor = Plane(Vec3::UnitY(), 0.3);
    const Vec3 axis = pose.rotation.col(1);
    const double across = std::sqrt(std::max(0.0, 1.0 - axis.y() * axis.y()));
    const double of_cylinder = pose.position.y() - 0.5 * length * std::abs(axis.y()) - radius * across - 0.3;
    const double base = pose.position.y() - 0.5 * length * axis.y() - radius * across,
                 apex = pose.position.y() + 0.5 * length * axis.y();
    const auto rests = contacts_of(floor, {}, cylinder(radius, length), pose);
    CAPTURE(i);
    CHECK(smallest_gap(rests) == Approx(of_cylinder).margin(1e-9));
    CHECK(gap_of(floor, {}, cone(radius, length), pose) == Approx(std::min(base, apex) - 0.3).margin(1e-9));
    for (const Collision& c : rests) CHECK((c.normal + Vec3::UnitY()).norm() < 1e-12);
  }
}

TEST_CASE("a cylinder rests on eight points or more, on its side on two, so does a cone") {
  const SharedShape floor = Plane();
  const auto count = [&](const SharedShape& shape, const Vec3& axis, double height) {
    Pose pose;
    pose.rotation = Quat::FromTwoVectors(Vec3::UnitY(), axis).toRotationMatrix();
    pose.position.y() = height;
    TestColliders bodies;
    bodies.add(floor);
    bodies.add(shape, pose);
    int touching = 0;
    for (const Collision& c : bodies.contacts(0, 1, {true, 1e-3, 0.0})) touching += std::abs(c.gap) < 1e-9 ? 1 : 0;
    return touching;
  };
  CHECK(count(cylinder(0.3, 0.8), Vec3::UnitY(), 0.4) == 8);
  CHECK(count(cylinder(0.3, 0.8), -Vec3::UnitY(), 0.4) == 8);
  CHECK(count(cylinder(0.3, 0.8), Vec3::UnitX(), 0.3) == 2);
  CHECK(count(cylinder(0.3, 0.8), Vec3(1, 1, 0).normalized(), std::sqrt(0.5) * 0.7) == 1);
  CHECK(count(cone(0.3, 0.8), Vec3::UnitY(), 0.4) == 8);
  CHECK(count(cone(0.3, 0.8), -Vec3::UnitY(), 0.4) == 1);
  // on its side the axis leans by the half angle at the apex
  const double half_angle = std::atan2(0.3, 0.8);
  CHECK(count(cone(0.3, 0.8), Vec3(std::cos(half_angle), -std::sin(half_angle), 0), 0.4 * std::sin(half_angle)) == 2);
  // over another body as over the floor
  const SharedShape slab = Box(Vec3(2, 0.5, 2)), hull = made_hull(box_corners(Vec3(2, 0.5, 2))),
                    mesh = surface(box(Vec3(2, 0.5, 2), {5, 1, 5}));
  for (const SharedShape& ground : {slab, hull, mesh}) {
    CAPTURE(ground->name());
    for (const auto& [shape, height, expected] :
         {std::tuple(cylinder(0.3, 0.8), 0.9, 8), std::tuple(cone(0.3, 0.8), 0.9, 8)}) {
      TestColliders bodies;
      bodies.add(ground);
      bodies.add(shape, {Mat3::Identity(), Vec3(0.1, height, 0.05)});
      const auto found = bodies.contacts(0, 1, {true, 1e-3, 0.0});
      CHECK(static_cast<int>(found.size()) == expected);
      for (const Collision& c : found) CHECK((std::abs(c.gap) < 1e-9 && (c.normal + Vec3::UnitY()).norm() < 1e-9));
    }
    TestColliders bodies;
    bodies.add(ground);
    bodies.add(cylinder(0.3, 0.8),
               {Eigen::AngleAxisd(M_PI / 2, Vec3::UnitX()).toRotationMatrix(), Vec3(0.1, 0.8, 0.05)});
    const auto found = bodies.contacts(0, 1, {true, 1e-3, 0.0});
    CHECK(found.size() == 2);
    for (const Collision& c : found) CHECK((std::abs(c.gap) < 1e-9 && (c.normal + Vec3::UnitY()).norm() < 1e-9));
  }
}

TEST_CASE("a ball is as far from cylinder and cone as its centre, less its radius") {
  Random r(52);
  for (int i = 0; i < 400; ++i) {
    const double radius = r.in(0.1, 1.0), length = r.in(0.2, 2.0), ball = r.in(0.05, 0.5);
    const SharedShape sphere = Sphere(ball), drum = cylinder(radius, length), hat = cone(radius, length);
    const Pose pose = random_pose(r, 1.0);
    Vec3 x = 1.5 * r.vector();
    if (i % 5 == 0) x = Vec3(0, r.sym(), 0);                                                         // on the axis
    if (i % 5 == 1) x = (radius + 1e-7 * r.sym()) * Vec3(1, 0, 0) + Vec3(0, 0.5 * length, 0);        // at the rim
    if (i % 5 == 2) x = Vec3(0, 0.5 * length, 0) + std::pow(10.0, r.in(-9.0, 0.0)) * r.direction();  // at the apex
    const double beside = std::hypot(x.x(), x.z());
    CAPTURE(i, x.transpose());
    const Pose place{r.rotation(), pose.apply(x)};
    CHECK(gap_of(sphere, place, drum, pose) ==
          Approx(apart(beside - radius, std::abs(x.y()) - 0.5 * length) - ball).margin(1e-6));
    // the cone in its half-plane: inside the nearer of wall and base, outside the nearest of their points
    const double slant = std::hypot(radius, length), h = x.y() + 0.5 * length;
    const double wall = ((beside - radius) * length + h * radius) / slant;
    double exact = std::max(wall, -h);
    if (wall > 0.0 || h < 0.0) {
      exact = 1e300;
      for (int k = 0; k <= 200000; ++k) {  // the outline, point by point
        const double t = k / 200000.0;
        exact = std::min(
            {exact, std::hypot(beside - radius * (1.0 - t), h - length * t), std::hypot(beside - radius * t, h)});
        if (i % 20 != 0) break;  // a few are enough
      }
      if (i % 20 != 0) continue;
      CHECK(gap_of(sphere, place, hat, pose) == Approx(exact - ball).margin(2e-5));
    } else {
      CHECK(gap_of(sphere, place, hat, pose) == Approx(exact - ball).margin(1e-6));
    }
  }
}

TEST_CASE("cylinders with one axis or parallel axes are as far apart as their outlines") {
  Random r(53);
  for (int i = 0; i < 600; ++i) {
    const double ra = r.in(0.1, 1.0), rb = r.in(0.1, 1.0), ha = r.in(0.1, 1.0), hb = r.in(0.1, 1.0);
    const Pose pose = random_pose(r, 1.0);
    Vec3 offset(0.0, r.in(-2.5, 2.5), 0.0);
    if (i % 3 != 0) offset += Vec3(r.in(-2.0, 2.0), 0.0, r.in(-2.0, 2.0));
    if (i % 3 == 2) {  // touching, along the axis or across it
      const Vec3 beside = Vec3(offset.x(), 0, offset.z()).normalized();
      offset = r.below(2) ? Vec3((ra + rb) * beside + Vec3(0, 0.5 * r.sym() * (ha + hb), 0))
                          : Vec3(0.5 * r.u() * (ra + rb) * beside + Vec3(0, ha + hb, 0));
    }
    Pose other{pose.rotation, pose.apply(offset)};
    if (i % 2) other.rotation = pose.rotation * Eigen::AngleAxisd(r.in(0.0, 6.0), Vec3::UnitY()).toRotationMatrix();
    const double exact = apart(std::hypot(offset.x(), offset.z()) - ra - rb, std::abs(offset.y()) - ha - hb);
    CAPTURE(i, offset.transpose());
    const auto found = contacts_of(cylinder(ra, 2.0 * ha), pose, cylinder(rb, 2.0 * hb), other);
    CHECK(smallest_gap(found) == Approx(exact).margin(1e-6));
    CHECK(found.size() <= 9);
  }
}

TEST_CASE("a cone touches with its apex, its rim or its wall where geometry says") {
  const double radius = 0.3, length = 0.8;
  const SharedShape hat = cone(radius, length), slab = Box(Vec3(2, 0.5, 2));
  for (const double gap : {0.1, 1e-4, 1e-9, 0.0, -1e-9, -1e-4, -0.05}) {
    CAPTURE(gap);
    // upside down over a slab: the apex
    Pose pose{Eigen::AngleAxisd(M_PI, Vec3::UnitX()).toRotationMatrix(), Vec3(0.2, 0.5 + 0.5 * length + gap, 0.1)};
    auto found = contacts_of(slab, {}, hat, pose);
    REQUIRE(found.size() == 1);
    CHECK(found[0].gap == Approx(gap).margin(1e-9));
    CHECK((found[0].normal + Vec3::UnitY()).norm() < 1e-6);
    CHECK((found[0].point_b - Vec3(0.2, 0.5 + gap, 0.1)).norm() < 1e-6);
    // leaning by 40 degrees: a point of the rim
    const double lean = 40.0 * M_PI / 180.0;
    pose.rotation = Eigen::AngleAxisd(lean, Vec3::UnitZ()).toRotationMatrix();
    const double low = 0.5 * length * std::cos(lean) + radius * std::sin(lean);
    pose.position.y() = 0.5 + low + gap;
    found = contacts_of(slab, {}, hat, pose);
    CHECK(smallest_gap(found) == Approx(gap).margin(1e-9));
    // apex against apex
    Pose over{Mat3::Identity(), Vec3(0, length + gap, 0)};
    over.rotation = Eigen::AngleAxisd(M_PI, Vec3::UnitX()).toRotationMatrix();
    if (gap >= 0.0) CHECK(gap_of(hat, {}, hat, over) == Approx(gap).margin(1e-9));
    // wall against wall, side by side and upside down: the walls are parallel, a slant's width apart
    const double slant = std::hypot(radius, length);
    Pose beside{over.rotation, Vec3(radius + gap * slant / length, 0, 0)};
    CHECK(gap_of(hat, {}, hat, beside) == Approx(gap).margin(1e-6));
  }
}

TEST_CASE("curved shapes apart are as far as alternating projections find, overlapping as deep as the judge finds") {
  Random r(54);
  int deep = 0, apart_pairs = 0;
  for (int i = 0; i < 240; ++i) {
    const auto sample = [&](int kind) -> SharedShape {
      switch (kind) {
        case 0:
          return cylinder(r.in(0.2, 0.8), r.in(0.3, 1.5));
        case 1:
          return cone(r.in(0.2, 0.8), r.in(0.3, 1.5));
        case 2:
          return Box(Vec3(r.in(0.2, 0.8), r.in(0.2, 0.8), r.in(0.2, 0.8)));
        case 3:
          return Capsule(r.in(0.1, 0.4), r.in(0.1, 0.8));
        default: {
          std::vector<Vec3> points;
          for (int k = 0; k < 14; ++k) points.push_back(Vec3(0.7 * r.direction()));
          return made_hull(points);
        }
      }
    };
    const SharedShape a = sample(i % 2), b = sample(r.below(5));
    const Pose pose_a = random_pose(r, 1.0), pose_b{r.rotation(), pose_a.position + r.in(0.3, 2.0) * r.direction()};
    const PlacedConvex placed_a{set_of(a), pose_a}, placed_b{set_of(b), pose_b};
    const ConvexGap gap = convex_gap(placed_a, placed_b);
    CAPTURE(i, a->name(), b->name(), gap.gap);
    CHECK((gap.point_a - gap.point_b - gap.gap * gap.normal).norm() < 1e-5);
    CHECK(std::abs(a->signed_distance(pose_a.apply_inverse(gap.point_a))) < 1e-5);
    CHECK(std::abs(b->signed_distance(pose_b.apply_inverse(gap.point_b))) < 1e-5);
    if (gap.gap < 0.0) {
      ++deep;
      CHECK(least_overlap(placed_a, placed_b) == Approx(-gap.gap).margin(1e-6));
    } else {
      ++apart_pairs;
      CHECK(least_overlap(placed_a, placed_b) == 0.0);
      // the nearest points are each other's: no way along either surface leads closer
      CHECK(a->signed_distance(pose_a.apply_inverse(gap.point_b)) == Approx(gap.gap).margin(1e-6));
      CHECK(b->signed_distance(pose_b.apply_inverse(gap.point_a)) == Approx(gap.gap).margin(1e-6));
    }
  }
  CHECK(deep > 60);
  CHECK(apart_pairs > 60);
}

TEST_CASE("a box as a convex hull meets everything as the box does") {
  Random r(55);
  for (int i = 0; i < 300; ++i) {
    const Vec3 half(r.in(0.2, 0.8), r.in(0.2, 0.8), r.in(0.2, 0.8));
    const SharedShape crate = Box(half), hull = made_hull(box_corners(half));
    const Pose pose = random_pose(r, 0.5), place = random_pose(r, 1.2);
    const SharedShape others[] = {Sphere(0.4), Capsule(0.2, 0.4), Plane(r.direction(), -0.5),
                                  surface(box({0.5, 0.3, 0.4}, {2, 2, 2}))};
    for (const SharedShape& other : others) {
      const Pose at = other->as<Plane>() != nullptr ? Pose{} : place;
      const double of_box = gap_of(other, at, crate, pose), of_hull = gap_of(other, at, hull, pose);
      CAPTURE(i, other->name());
      // a capsule deep in an edge is held by a face that is up to 2 % deeper
      CHECK(of_hull == Approx(of_box).epsilon(of_box < 0.0 ? 0.03 : 0.0).margin(1e-8));
    }
    // two boxes apart: their distance
    const SharedShape second = Box(Vec3(0.3, 0.4, 0.2));
    const double of_box = gap_of(second, place, crate, pose), of_hull = gap_of(second, place, hull, pose);
    if (of_box > 0.0) CHECK(of_hull == Approx(of_box).margin(1e-8));
  }
}

TEST_CASE("masses of cylinder, cone, hull and compound are the formulas'") {
  const double r = 0.3, l = 0.8, rho = 700.0, pi = M_PI;
  const MassProperties drum = cylinder(r, l)->mass(rho), hat = cone(r, l)->mass(rho);
  CHECK(drum.mass == Approx(rho * pi * r * r * l).epsilon(1e-13));
  CHECK(drum.inertia(1, 1) == Approx(0.5 * drum.mass * r * r).epsilon(1e-13));
  CHECK(drum.inertia(0, 0) == Approx(drum.mass * (3.0 * r * r + l * l) / 12.0).epsilon(1e-13));
  CHECK(drum.inertia(2, 2) == drum.inertia(0, 0));
  CHECK(drum.center.norm() == 0.0);
  CHECK(hat.mass == Approx(rho * pi * r * r * l / 3.0).epsilon(1e-13));
  CHECK((hat.center - Vec3(0, -0.25 * l, 0)).norm() < 1e-15);
  CHECK(hat.inertia(1, 1) == Approx(0.3 * hat.mass * r * r).epsilon(1e-13));
  CHECK(hat.inertia(0, 0) == Approx(3.0 / 80.0 * hat.mass * (4.0 * r * r + l * l)).epsilon(1e-13));

  // a box as a hull, moved; a tetrahedron
  std::vector<Vec3> corners = box_corners(Vec3(0.1, 0.2, 0.4));
  for (Vec3& x : corners) x += Vec3(1, 2, 3);
  const MassProperties hull = made_hull(corners)->mass(rho), crate = box_mass(Vec3(0.1, 0.2, 0.4), rho);
  CHECK(hull.mass == Approx(crate.mass).epsilon(1e-12));
  CHECK((hull.center - Vec3(1, 2, 3)).norm() < 1e-12);
  CHECK((hull.inertia - crate.inertia).norm() < 1e-12 * crate.inertia.norm());
  const MassProperties tetrahedron =
      made_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.1, 0.1, 0.1}})->mass(1.0);
  CHECK(tetrahedron.mass == Approx(1.0 / 6.0).epsilon(1e-13));
  CHECK((tetrahedron.center - Vec3::Constant(0.25)).norm() < 1e-13);
  // about its centre: 1/60 - 1/96 twice on the diagonal, 1/120 - 1/96 with the other sign beside it
  CHECK(tetrahedron.inertia(0, 0) == Approx(2.0 * (1.0 / 60.0 - 1.0 / 96.0)).epsilon(1e-12));
  CHECK(tetrahedron.inertia(0, 1) == Approx(1.0 / 96.0 - 1.0 / 120.0).epsilon(1e-12));

  // two halves of a box, one of them turned over, are the box; a dumb-bell by parallel axes
  const SharedShape half_box = Box(Vec3(0.1, 0.2, 0.2));
  const Mat3 turned = Eigen::AngleAxisd(M_PI / 2, Vec3::UnitX()).toRotationMatrix();
  const MassProperties both =
      made_compound({{half_box, {Mat3::Identity(), Vec3(-0.1, 0, 0)}}, {half_box, {turned, Vec3(0.1, 0, 0)}}})
          ->mass(rho);
  const MassProperties whole = box_mass(Vec3(0.2, 0.2, 0.2), rho);
  CHECK(both.mass == Approx(whole.mass).epsilon(1e-13));
  CHECK(both.center.norm() < 1e-15);
  CHECK((both.inertia - whole.inertia).norm() < 1e-12 * whole.inertia.norm());
  const MassProperties bell = made_compound({{Sphere(0.1), {Mat3::Identity(), Vec3(0, 0.5, 0)}},
                                             {Sphere(0.2), {Mat3::Identity(), Vec3(0, -0.5, 0)}}})
                                  ->mass(rho);
  const double m1 = sphere_mass(0.1, rho).mass, m2 = sphere_mass(0.2, rho).mass;
  CHECK(bell.mass == Approx(m1 + m2).epsilon(1e-13));
  CHECK(bell.center.y() == Approx(0.5 * (m1 - m2) / (m1 + m2)).epsilon(1e-13));
  CHECK(bell.inertia(0, 0) == Approx(0.4 * m1 * 0.01 + 0.4 * m2 * 0.04 + m1 * m2 / (m1 + m2)).epsilon(1e-13));
  CHECK(bell.inertia(1, 1) == Approx(0.4 * m1 * 0.01 + 0.4 * m2 * 0.04).epsilon(1e-13));
  // a cone as a part keeps its own centre in mind
  const MassProperties placed = made_compound({{cone(r, l), {Mat3::Identity(), Vec3(1, 0, 0)}}})->mass(rho);
  CHECK((placed.center - Vec3(1, -0.25 * l, 0)).norm() < 1e-14);
  CHECK((placed.inertia - hat.inertia).norm() < 1e-12 * hat.inertia.norm());
}
