// Exact contacts against values worked out by hand.
#include <catch2/catch.hpp>

#include <algorithm>

#include "tests/support/geometry/shapes.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {
const ContactQuery kClose{true, 1e-3, 0.0};

Pose at(double x, double y, double z) { return {Mat3::Identity(), {x, y, z}}; }
Pose turned(const Vec3& position, double degrees, const Vec3& axis) {
  return {Eigen::AngleAxisd(degrees * M_PI / 180.0, axis).toRotationMatrix(), position};
}
}  // namespace

TEST_CASE("a plane meets a sphere, a box and a capsule where they are deepest") {
  TestColliders bodies;
  bodies.add(Plane{Vec3::UnitY(), 0.5});
  bodies.add(Sphere{0.3}, at(1, 0.79, 2));
  bodies.add(Box{Vec3(0.1, 0.2, 0.3)}, at(0, 0.7, 0));
  bodies.add(Capsule{0.1, 0.4}, turned({0, 0.6, 0}, 90, Vec3::UnitX()));

  const auto sphere = bodies.contacts(0, 1, kClose);
  REQUIRE(sphere.size() == 1);
  CHECK(sphere[0].gap == Approx(-0.01).margin(1e-14));
  CHECK((sphere[0].normal + Vec3::UnitY()).norm() < 1e-15);  // from the sphere (b) towards the plane (a)
  CHECK((sphere[0].point_a - Vec3(1, 0.5, 2)).norm() < 1e-14);
  CHECK((sphere[0].point_b - Vec3(1, 0.49, 2)).norm() < 1e-14);
  CHECK(sphere[0].normal_owner == 0);

  const auto box = bodies.contacts(0, 2, kClose);
  REQUIRE(box.size() == 4);
  for (const Collision& c : box) CHECK(std::abs(c.gap) < 1e-15);

  const auto capsule = bodies.contacts(0, 3, kClose);
  REQUIRE(capsule.size() == 2);
  for (const Collision& c : capsule) CHECK(std::abs(c.gap) < 1e-15);
  CHECK(std::abs(std::abs(capsule[0].point_b.z() - capsule[1].point_b.z()) - 0.8) < 1e-14);
}

TEST_CASE("a plane is placed by its body's pose") {
  TestColliders bodies;
  bodies.add(Plane{Vec3::UnitY(), 0.0},
             turned({0, 1, 0}, 90, Vec3::UnitZ()));  // now x <= ... : normal -x through (0, 1, 0)
  bodies.add(Sphere{0.5}, at(-0.4, 7, 0));
  const auto contacts = bodies.contacts(0, 1, kClose);
  REQUIRE(contacts.size() == 1);
  CHECK(contacts[0].gap == Approx(-0.1));
  CHECK((contacts[0].normal - Vec3::UnitX()).norm() < 1e-15);
}

TEST_CASE("stacked equal boxes touch at four corners whose names last") {
  Random r(3);
  std::vector<std::uint64_t> names;
  for (int step = 0; step < 200; ++step) {
    // rounding-sized and then solver-sized disturbances, apart and in overlap
    const double noise = step < 100 ? 1e-16 : 1e-6;
    TestColliders bodies;
    bodies.add(Box{Vec3(0.5, 0.5, 0.5)}, turned(noise * r.vector(), noise * r.sym(), r.direction()));
    bodies.add(Box{Vec3(0.5, 0.5, 0.5)},
               turned(Vec3(0, 1.0 + 1e-5 * r.sym(), 0) + noise * r.vector(), noise * r.sym(), r.direction()));
    const auto contacts = bodies.contacts(0, 1, kClose);
    INFO("step " << step);
    REQUIRE(contacts.size() == 4);
    Vec3 middle = Vec3::Zero();
    std::vector<std::uint64_t> now;
    for (const Collision& c : contacts) {
      CHECK((c.normal + Vec3::UnitY()).norm() < 1e-6);
      CHECK(std::abs(std::abs(c.point_a.x()) - 0.5) < 1e-5);
      CHECK(std::abs(std::abs(c.point_a.z()) - 0.5) < 1e-5);
      middle += 0.25 * c.point_a;
      now.push_back(c.feature);
    }
    CHECK(std::abs(middle.x()) < 1e-5);
    CHECK(std::abs(middle.z()) < 1e-5);
    std::sort(now.begin(), now.end());
    if (names.empty()) names = now;
    CHECK(now == names);
  }
}

TEST_CASE("a box on a shifted, turned or larger one") {
  TestColliders bodies;
  bodies.add(Box{Vec3(0.5, 0.5, 0.5)});
  bodies.add(Box{Vec3(0.5, 0.5, 0.5)}, at(0.25, 1.0005, 0.125));
  auto contacts = bodies.contacts(0, 1, kClose);
  REQUIRE(contacts.size() == 4);  // the common rectangle
  for (const Collision& c : contacts) {
    CHECK(c.gap == Approx(0.0005).epsilon(1e-9));
    CHECK((std::abs(c.point_a.x() - 0.5) < 1e-12 || std::abs(c.point_a.x() + 0.25) < 1e-12));
    CHECK((std::abs(c.point_a.z() - 0.5) < 1e-12 || std::abs(c.point_a.z() + 0.375) < 1e-12));
  }
  bodies.place(1, turned({0, 0.9995, 0}, 45, Vec3::UnitY()));
  contacts = bodies.contacts(0, 1, kClose);
  REQUIRE(contacts.size() == 8);  // a regular octagon
  for (const Collision& c : contacts) {
    CHECK(c.gap == Approx(-0.0005).epsilon(1e-9));
    CHECK(std::hypot(c.point_a.x(), c.point_a.z()) == Approx(0.5 / std::cos(M_PI / 8.0)).epsilon(1e-9));
  }
  bodies.add(Box{Vec3(5, 0.1, 5)}, at(0, -0.6, 0));
  contacts = bodies.contacts(0, 2, kClose);
  REQUIRE(contacts.size() == 4);
  for (const Collision& c : contacts) CHECK((c.normal - Vec3::UnitY()).norm() < 1e-15);
}

TEST_CASE("boxes corner to corner, corner to edge and edge to edge") {
  TestColliders bodies;
  bodies.add(Box{Vec3(0.5, 0.5, 0.5)});
  bodies.add(Box{Vec3(0.5, 0.5, 0.5)}, at(1.03, 1.04, 1.12));
  auto contacts = bodies.contacts(0, 1, {true, 1.0, 0.0});
  REQUIRE(contacts.size() == 1);
  CHECK(contacts[0].gap == Approx(0.13).epsilon(1e-12));  // 0.03² + 0.04² + 0.12² = 0.13²
  CHECK((contacts[0].normal + Vec3(0.03, 0.04, 0.12) / 0.13).norm() < 1e-12);

  bodies.place(1, at(1.03, 1.04, 0.3));  // parallel edges, z from -0.2 to 0.5 in common
  contacts = bodies.contacts(0, 1, {true, 0.06, 0.0});
  REQUIRE(contacts.size() == 2);
  for (const Collision& c : contacts) CHECK(c.gap == Approx(0.05).epsilon(1e-12));
  CHECK(std::abs(contacts[0].point_a.z() - contacts[1].point_a.z()) == Approx(0.7));

  // crossed ridges: 45 degrees about z below, 45 about x above
  const double ridge = 0.5 * std::sqrt(2.0);
  bodies.place(0, turned(Vec3::Zero(), 45, Vec3::UnitZ()));
  for (double gap : {0.01, 0.0005, -0.01}) {
    bodies.place(1, turned({0.05, 2 * ridge + gap, 0.07}, 45, Vec3::UnitX()));
    contacts = bodies.contacts(0, 1, {true, 0.02, 0.0});
    REQUIRE(contacts.size() == 1);
    CHECK(contacts[0].gap == Approx(gap).epsilon(1e-9));
    CHECK((contacts[0].normal + Vec3::UnitY()).norm() < 1e-12);
    CHECK((contacts[0].point_a - Vec3(0, ridge, 0.07)).norm() < 0.06);
  }
}

TEST_CASE("a sphere at a box's face, edge, corner and inside") {
  TestColliders bodies;
  bodies.add(Sphere{0.25}, at(0, 0.75, 0));
  bodies.add(Box{Vec3(0.5, 0.5, 0.5)});
  auto only = [&](const Vec3& center) {
    bodies.place(0, at(center.x(), center.y(), center.z()));
    const auto contacts = bodies.contacts(0, 1, {true, 1.0, 0.0});
    REQUIRE(contacts.size() == 1);
    return contacts[0];
  };
  CHECK(std::abs(only({0.1, 0.75, 0.2}).gap) < 1e-15);
  CHECK(only({0.1, 0.75, 0.2}).normal_owner == 1);
  CHECK(only({0.8, 0.9, 0.1}).gap == Approx(0.25));
  CHECK((only({0.8, 0.9, 0.1}).normal - Vec3(0.6, 0.8, 0)).norm() < 1e-12);
  CHECK(only({0.6, 0.7, 0.7}).gap == Approx(0.05));
  CHECK(only({0.1, 0.4, 0.2}).gap == Approx(-0.35));
  CHECK((only({0.1, 0.4, 0.2}).normal - Vec3::UnitY()).norm() < 1e-15);
  CHECK((only({0.1, 0.5, 0.2}).normal - Vec3::UnitY()).norm() < 1e-15);  // centre on the face
  CHECK(only({0, 0, 0}).gap == Approx(-0.75));
}

TEST_CASE("parallel capsules touch at both ends of what they have in common") {
  TestColliders bodies;
  bodies.add(Capsule{0.1, 0.5});
  bodies.add(Capsule{0.2, 0.5}, at(0.3005, 0.4, 0));
  auto contacts = bodies.contacts(0, 1, kClose);
  REQUIRE(contacts.size() == 2);
  for (const Collision& c : contacts) {
    CHECK(c.gap == Approx(0.0005).epsilon(1e-9));
    CHECK((c.normal + Vec3::UnitX()).norm() < 1e-12);
  }
  CHECK(std::abs(contacts[0].point_a.y() - contacts[1].point_a.y()) == Approx(0.6));
  bodies.place(1, turned({0.25, 0, 0}, 90, Vec3::UnitX()));
  contacts = bodies.contacts(0, 1, kClose);
  REQUIRE(contacts.size() == 1);
  CHECK(contacts[0].gap == Approx(-0.05));
  bodies.place(1, at(0, 1.2999, 0));  // end to end
  contacts = bodies.contacts(0, 1, kClose);
  REQUIRE(contacts.size() == 1);
  CHECK(contacts[0].gap == Approx(-0.0001).epsilon(1e-9));
}

TEST_CASE("a capsule lies on a box") {
  TestColliders bodies;
  bodies.add(Capsule{0.1, 0.3}, turned({0.05, 0.5995, 0.1}, 90, Vec3::UnitZ()));
  bodies.add(Box{Vec3(0.5, 0.5, 0.5)});
  auto contacts = bodies.contacts(0, 1, kClose);
  REQUIRE(contacts.size() == 2);
  for (const Collision& c : contacts) {
    CHECK(c.gap == Approx(-0.0005).epsilon(1e-9));
    CHECK((c.normal - Vec3::UnitY()).norm() < 1e-15);
    CHECK(c.normal_owner == 1);
  }
  CHECK(std::abs(contacts[0].point_a.x() - contacts[1].point_a.x()) == Approx(0.6));
  bodies.place(0, turned({0.4, 0.6, 0.1}, 90, Vec3::UnitZ()));  // 0.2 beyond the edge: the face ends at x = 0.5
  contacts = bodies.contacts(0, 1, kClose);
  REQUIRE(contacts.size() == 2);
  CHECK(std::max(contacts[0].point_a.x(), contacts[1].point_a.x()) == Approx(0.5));
  bodies.place(0, turned({0, 0, 0}, 90, Vec3::UnitZ()));  // through the middle
  contacts = bodies.contacts(0, 1, kClose);
  REQUIRE(!contacts.empty());
  CHECK(smallest_gap(contacts) < -0.5);
  bodies.place(0, at(0, 0.8999, 0));  // standing
  contacts = bodies.contacts(0, 1, kClose);
  REQUIRE(contacts.size() == 1);
  CHECK(contacts[0].gap == Approx(-0.0001).epsilon(1e-9));
}

TEST_CASE("degenerate overlaps give finite unit normals") {
  TestColliders bodies;
  const SharedShape shapes[] = {Sphere{0.5}, Box{Vec3(0.5, 0.5, 0.5)}, Capsule{0.2, 0.5}, Sphere{0.0},
                                Capsule{0.2, 0.0}};
  for (const SharedShape& a : shapes)
    for (const SharedShape& b : shapes)
      for (const Vec3& offset :
           {Vec3(0, 0, 0), Vec3(0, 0.5, 0), Vec3(0.5, 0.5, 0.5), Vec3(0, 0.25, 0), Vec3(1e-17, 0, -1e-200)}) {
        TestColliders pair;
        Pose pose;
        pose.position = offset;
        pair.add(a);
        pair.add(b, pose);
        const auto contacts = pair.contacts(0, 1, {true, 2.0, 0.0});
        INFO(a->name() << " " << b->name() << " " << offset.transpose());
        REQUIRE(!contacts.empty());
        for (const Collision& c : contacts) {
          CHECK(c.normal.norm() == Approx(1.0).epsilon(1e-12));
          CHECK(std::isfinite(c.gap));
        }
      }
}

TEST_CASE("a fast sphere is seen before it passes a thin box, a plane or another sphere") {
  TestColliders bodies;
  bodies.add(Sphere{0.05}, at(0.2, 3, 0.1));
  bodies.add(Box{Vec3(1, 0.01, 1)});
  bodies.add(Plane{Vec3::UnitY(), 0.0});
  bodies.add(Sphere{0.05}, at(0.2, 0, 0.1));
  const ContactQuery step{true, 1e-3, 0.01};
  bodies[0].velocity = {0, -400, 0};  // 4 m a step
  for (int other : {1, 2, 3}) CHECK(bodies.contacts(0, other, step).size() == 1);
  bodies[0].velocity = {0, -200, 0};  // 2 m: does not get there
  for (int other : {1, 2, 3}) CHECK(bodies.contacts(0, other, step).empty());
  bodies[0].velocity = {0, 400, 0};
  for (int other : {1, 2, 3}) CHECK(bodies.contacts(0, other, step).empty());
}
