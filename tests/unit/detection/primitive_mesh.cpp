// Exact shapes against meshes: against the exact shapes that the meshes stand for, and on surfaces where a wrong
// contact would be felt.
#include <catch2/catch.hpp>

#include "engine/detection/contacts/surface_view.hpp"
#include "engine/geometry/inside.hpp"
#include "tests/support/geometry/shapes.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {
Pose at(const Vec3& x) { return {Mat3::Identity(), x}; }
}  // namespace

TEST_CASE("a sphere on a tessellated plane has one upright contact wherever it is") {
  Random r(5);
  TestColliders bodies;
  bodies.add(Sphere{0.4});
  bodies.add(surface(box({1.0, 0.5, 1.0}, {8, 1, 8})), at({0, -0.5, 0}));
  for (int i = 0; i < 2000; ++i) {
    Vec3 x(0.9 * r.sym(), 0.4 + 1e-4 * r.sym(), 0.9 * r.sym());
    // often right above an edge or a vertex, or off it by rounding
    if (i % 3 == 0) x.x() = 0.25 * std::round(4.0 * x.x()) + (i % 2 ? 1e-15 * r.sym() : 0.0);
    if (i % 5 == 0) x.z() = 0.25 * std::round(4.0 * x.z());
    bodies.place(0, at(x));
    const auto contacts = bodies.contacts(0, 1, {true, 1e-3, 0.01});
    INFO(x.transpose());
    REQUIRE(contacts.size() == 1);
    REQUIRE((contacts[0].normal - Vec3::UnitY()).norm() < 1e-9);
    REQUIRE(std::abs(contacts[0].gap - (x.y() - 0.4)) < 1e-12);
  }
}

TEST_CASE("a sphere against a cube's mesh is the sphere against the box") {
  Random r(6);
  const Vec3 half(0.5, 0.4, 0.3);
  TestColliders bodies;
  bodies.add(Sphere{0.2});
  bodies.add(surface(box(half, {3, 2, 4})));
  bodies.add(Box{half});
  for (int i = 0; i < 3000; ++i) {
    const Pose pose = random_pose(r, 1.0);
    bodies.place(0, at(0.9 * r.vector()));
    bodies.place(1, {pose.rotation, 0.1 * pose.position});
    bodies.place(2, {pose.rotation, 0.1 * pose.position});
    const ContactQuery query{true, 1.0, 0.0};
    const auto mesh = bodies.contacts(0, 1, query), exact = bodies.contacts(0, 2, query);
    REQUIRE(mesh.size() == 1);
    REQUIRE(exact.size() == 1);
    REQUIRE(std::abs(mesh[0].gap - exact[0].gap) < 1e-12);
    REQUIRE((mesh[0].normal - exact[0].normal).norm() < 1e-9);
    REQUIRE((mesh[0].point_b - exact[0].point_b).norm() < 1e-9);
  }
}

TEST_CASE(
    "a ball against a bending surface that has folded over is as deep as the distance and the winding number say") {
  Random r(16);
  TestColliders bodies;
  const double radius = 0.2;
  bodies.add(Sphere{radius});
  const MeshPointer cube = surface(box({0.5, 0.5, 0.5}, {4, 4, 4}));
  bodies.add(cube);
  const std::vector<Vec3> still(cube->mesh.vertices.size(), Vec3::Zero());
  int outside = 0, folded = 0;
  for (int i = 0; i < 2000; ++i) {
    std::vector<Vec3> vertices = cube->mesh.vertices;
    for (Vec3& v : vertices)  // of the top, over their neighbours, which are 0.25 away
      if (v.y() == 0.5 && r.sym() > 0.5) v += Vec3(0.5, 0.02, 0.5).cwiseProduct(r.vector());
    Collider& bending = bodies[1];
    bending.vertices = vertices;
    bending.vertex_velocities = still;
    bending.bounds = {};
    for (const Vec3& v : vertices) bending.bounds.include(v);
    const Vec3 x(0.5 * r.sym(), 0.6 + 0.2 * r.sym(), 0.5 * r.sym());
    bodies.place(0, at(x));
    const double distance = distance_to_surface(x, vertices, cube->mesh.triangles);
    if (winding_number(x, vertices, cube->mesh.triangles) > 0.5) continue;
    const auto contacts = bodies.contacts(0, 1, {true, 1.0, 0.0});
    REQUIRE(!contacts.empty());
    const Collision* deepest = &contacts.front();
    for (const Collision& c : contacts)
      if (c.gap < deepest->gap) deepest = &c;
    INFO(i << ": " << x.transpose());
    ++outside;
    REQUIRE(std::abs(deepest->gap - (distance - radius)) < 1e-9);
    REQUIRE((deepest->point_b - x).norm() < distance + 1e-9);
    const SurfaceView view(bodies.colliders()[1], 1);
    if (deepest->normal.dot(view.face_normal(deepest->triangle_b.value())) < -0.1) ++folded;
  }
  CHECK(outside > 1000);
  CHECK(folded > 20);
}

TEST_CASE("shapes against a fine icosphere agree with the sphere within the chord error") {
  Random r(8);
  const double radius = 0.5;
  const MeshPointer ball = surface(icosphere(4, radius));
  // the farthest that a triangle's plane lies inside the sphere
  double chord = 0.0;
  for (const Triangle& t : ball->mesh.triangles) {
    const Vec3 &a = ball->mesh.vertices[t[0]], &b = ball->mesh.vertices[t[1]], &c = ball->mesh.vertices[t[2]];
    chord = std::max(chord, radius - std::abs((b - a).cross(c - a).normalized().dot(a)));
  }
  REQUIRE(chord < 2e-3);
  const SharedShape others[] = {Plane{r.direction(), -0.45}, Sphere{0.3}, Capsule{0.2, 0.4}, Box{Vec3(0.3, 0.2, 0.4)}};
  for (const SharedShape& other : others) {
    int compared = 0;
    for (int i = 0; i < 300; ++i) {
      TestColliders bodies;
      const Pose pose = random_pose(r, 0.8);
      const bool plane = other->as<Plane>() != nullptr;
      bodies.add(other, plane ? Pose{} : pose);
      bodies.add(ball, at(0.4 * r.vector()));
      bodies.add(Sphere{radius}, bodies[1].pose);
      const ContactQuery query{true, 0.1, 0.0};
      const auto mesh = bodies.contacts(0, 1, query), exact = bodies.contacts(0, 2, query);
      const double gap = smallest_gap(exact);
      // deep inside each other a sphere and its mesh may leave on different ways; two polyhedra already where they
      // overlap by more than a fraction of an edge
      const double deepest = other->as<Box>() != nullptr ? -0.02 : -0.05;
      if (!(gap > deepest && gap < 0.1 - 2.0 * chord)) continue;
      INFO(other->name() << " case " << i << " gap " << gap);
      ++compared;
      REQUIRE(!mesh.empty());
      // two polyhedra that overlap have a depth for each pair of crossing edges, which differ by the same error
      REQUIRE(smallest_gap(mesh) > gap - ((other->as<Box>() != nullptr) && gap < 0.0 ? chord : 1e-9));
      REQUIRE(smallest_gap(mesh) < gap + chord + 1e-9);
    }
    INFO(other->name());
    REQUIRE(compared > 10);
  }
}

TEST_CASE("capsules and boxes rest on a tessellated plane as on the plane") {
  Random r(9);
  TestColliders bodies;
  const SharedShape ground = surface(box({2.0, 0.5, 2.0}, {9, 1, 9}));
  bodies.add(Capsule{0.1, 0.4});
  bodies.add(Box{Vec3(0.3, 0.2, 0.4)});
  bodies.add(ground, at({0, -0.5, 0}));
  for (int i = 0; i < 200; ++i) {
    const Mat3 yaw = Eigen::AngleAxisd(r.in(0.0, 6.0), Vec3::UnitY()).toRotationMatrix();
    const Mat3 lying = yaw * Eigen::AngleAxisd(M_PI / 2, Vec3::UnitX()).toRotationMatrix();
    const double gap = 5e-4 * r.sym();
    bodies.place(0, {lying, Vec3(0.8 * r.sym(), 0.1 + gap, 0.8 * r.sym())});
    auto contacts = bodies.contacts(0, 2, {true, 1e-3, 0.0});
    INFO("case " << i << " gap " << gap);
    REQUIRE(contacts.size() == 2);
    for (const Collision& c : contacts) {
      REQUIRE((c.normal - Vec3::UnitY()).norm() < 1e-9);
      REQUIRE(std::abs(c.gap - gap) < 1e-12);
    }
    REQUIRE((contacts[0].point_a - contacts[1].point_a).norm() == Approx(0.8));

    bodies.place(1, {yaw, Vec3(0.8 * r.sym(), 0.2 + gap, 0.8 * r.sym())});
    contacts = bodies.contacts(1, 2, {true, 1e-3, 0.0});
    REQUIRE(contacts.size() >= 4);
    Aabb hull;
    for (const Collision& c : contacts) {
      REQUIRE((c.normal - Vec3::UnitY()).norm() < 1e-6);
      REQUIRE(std::abs(c.gap - gap) < 1e-9);
      hull.include(yaw.transpose() * (c.point_a - bodies[1].pose.position));
    }
    REQUIRE(hull.extent().x() == Approx(0.6).epsilon(1e-6));
    REQUIRE(hull.extent().z() == Approx(0.8).epsilon(1e-6));
  }
}

TEST_CASE("a capsule lies across a ridge and a peak") {
  // a roof: ridge along z at y = 0
  TriangleMesh roof;
  roof.vertices = {{0, 0, -1}, {0, 0, 1}, {-1, -1, -1}, {-1, -1, 1}, {1, -1, -1}, {1, -1, 1}};
  roof.triangles = {{0, 1, 5}, {0, 5, 4}, {0, 2, 3}, {0, 3, 1}, {2, 4, 5}, {2, 5, 3}, {0, 4, 2}, {1, 3, 5}};
  const MeshPointer mesh = surface(roof);
  REQUIRE(mesh->topology.is_closed());
  TestColliders bodies;
  bodies.add(Capsule{0.1, 0.5},
             {Eigen::AngleAxisd(M_PI / 2, Vec3::UnitZ()).toRotationMatrix(), Vec3(0.1, 0.1005, 0.2)});
  bodies.add(mesh);
  auto contacts = bodies.contacts(0, 1, {true, 1e-3, 0.0});
  REQUIRE(contacts.size() == 1);
  CHECK((contacts[0].normal - Vec3::UnitY()).norm() < 1e-12);
  CHECK(contacts[0].gap == Approx(0.0005).epsilon(1e-9));
  CHECK((contacts[0].point_b - Vec3(0, 0, 0.2)).norm() < 1e-12);

  TriangleMesh peak;
  peak.vertices = {{0, 0, 0}, {1, -1, 1}, {1, -1, -1}, {-1, -1, -1}, {-1, -1, 1}};
  peak.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}, {1, 4, 3}, {1, 3, 2}};
  TestColliders peaked;
  peaked.add(Capsule{0.1, 0.5},
             {Eigen::AngleAxisd(M_PI / 2, Vec3::UnitZ()).toRotationMatrix(), Vec3(0.1, 0.0995, 0.0)});
  peaked.add(surface(peak));
  contacts = peaked.contacts(0, 1, {true, 1e-3, 0.0});
  REQUIRE(contacts.size() == 1);
  CHECK((contacts[0].normal - Vec3::UnitY()).norm() < 1e-12);
  CHECK(contacts[0].gap == Approx(-0.0005).epsilon(1e-9));

  // pressed down past its radius: the axis passes through the roof, both caps outside
  bodies.place(0, {Eigen::AngleAxisd(M_PI / 2, Vec3::UnitZ()).toRotationMatrix(), Vec3(0.0, -0.2, 0.2)});
  contacts = bodies.contacts(0, 1, {true, 1e-3, 0.0});
  CHECK(smallest_gap(contacts) < -0.1);
}

TEST_CASE("bodies deep inside a mesh are pushed out the nearest way") {
  TestColliders bodies;
  bodies.add(Sphere{0.05}, at({0.1, 0.3, -0.1}));
  bodies.add(Capsule{0.05, 0.05}, at({0.1, 0.3, -0.1}));
  bodies.add(Box{Vec3(0.05, 0.05, 0.05)}, at({0.1, 0.3, -0.1}));
  bodies.add(surface(box({0.5, 0.5, 0.5}, {2, 2, 2})));
  const double expected[] = {0.25, 0.3, 0.25};  // the capsule's lower cap, at 0.25, is the deepest
  for (int i = 0; i < 3; ++i) {
    const auto contacts = bodies.contacts(i, 3, {true, 1e-3, 0.0});
    INFO(bodies[i].shape->name());
    REQUIRE(!contacts.empty());
    CHECK(smallest_gap(contacts) == Approx(-expected[i]));
    for (const Collision& c : contacts) CHECK((c.normal - Vec3::UnitY()).norm() < 1e-12);
  }
}

TEST_CASE("a fast ball is seen before it passes a thin mesh") {
  TestColliders bodies;
  bodies.add(Sphere{0.02}, at({0.3, 2.0, -0.17}));
  bodies.add(surface(box({1.0, 0.005, 1.0}, {5, 1, 5})));
  bodies[0].velocity = {0, -300, 0};
  auto contacts = bodies.contacts(0, 1, {true, 1e-3, 0.01});  // 3 m a step
  REQUIRE(contacts.size() == 1);
  CHECK(contacts[0].gap == Approx(2.0 - 0.005 - 0.02));
  CHECK((contacts[0].normal - Vec3::UnitY()).norm() < 1e-12);
  bodies[0].velocity = {40, -300, 20};
  CHECK(bodies.contacts(0, 1, {true, 1e-3, 0.01}).size() >= 1);
  bodies[0].velocity = {0, -190, 0};
  CHECK(bodies.contacts(0, 1, {true, 1e-3, 0.01}).empty());
  bodies[0].velocity = {0, 300, 0};
  CHECK(bodies.contacts(0, 1, {true, 1e-3, 0.01}).empty());
}
