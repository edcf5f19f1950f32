// Contacts between meshes: gaps and normals against formulas and against distances found without the contact code.
#include <catch2/catch.hpp>

#include <algorithm>

#include "engine/detection/contacts/contact_points.hpp"
#include "engine/geometry/triangle_intersection.hpp"
#include "tests/support/geometry/indices.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/geometry/shapes.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

std::vector<TrianglePair> triangles_of(const ColliderSet& set, const BodyPair& pair) {
  std::vector<TrianglePair> found;
  find_entry(narrow_phases(), "spatial_hash")->make()->find(set.all(), std::vector<BodyPair>{pair}, found);
  return found;
}

std::vector<Collision> proximity(const ColliderSet& set, double activation, double time_step = 0.0,
                                 double reach = 0.0) {
  const BodyPair pair = body_pair(0, 1, activation + reach);
  std::vector<Collision> contacts;
  proximity_contacts(set.all(), pair, triangles_of(set, pair), activation, time_step, contacts);
  return contacts;
}

std::vector<Collision> intersection(const ColliderSet& set) {
  const BodyPair pair = body_pair(0, 1, 0.0);
  std::vector<Collision> contacts;
  intersection_contacts(set.all(), pair, triangles_of(set, pair), contacts);
  return contacts;
}

double distance_to_surface(const Vec3& x, const Collider& c) {
  double best = 1e300;
  for (int t = 0; t < static_cast<int>(c.mesh().mesh.triangles.size()); ++t)
    best = std::min(best, closest_on_triangle(x, corners(c, t)).squared_distance);
  return std::sqrt(best);
}

// what every list of contacts promises
void check_form(const ColliderSet& set, const std::vector<Collision>& contacts, double slack) {
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Collision& c = contacts[i];
    CHECK(c.body_a == 0);
    CHECK(c.body_b == 1);
    REQUIRE(std::abs(c.normal.norm() - 1.0) < 1e-12);
    REQUIRE(c.gap == Approx(c.normal.dot(c.point_a - c.point_b)).margin(1e-14));
    CHECK(std::sqrt(closest_on_triangle(c.point_a, corners(set.all()[0], c.triangle_a)).squared_distance) < slack);
    CHECK(std::sqrt(closest_on_triangle(c.point_b, corners(set.all()[1], c.triangle_b)).squared_distance) < slack);
    if (i > 0) CHECK(contacts[i - 1].feature < c.feature);
  }
}

}  // namespace

TEST_CASE("a meshed box over another is held at its corners by vertical normals", "[contacts]") {
  for (const Vec3& half : {Vec3(0.3, 0.2, 0.25), Vec3(0.5, 0.5, 0.5)})
    for (int cells : {1, 4})
      for (double gap : {5e-4, 0.0, -1e-8, -2e-4}) {
        ColliderSet set;
        const MeshPointer below = surface(box(Vec3::Constant(0.5), {3, 3, 3}));
        set.add(surface(box(half, {cells, cells, cells})), {Mat3::Identity(), Vec3(0, 0.5 + half.y() + gap, 0)});
        set.add(below);
        const std::vector<Collision> contacts = proximity(set, 1e-3);
        CAPTURE(half.transpose(), cells, gap);
        check_form(set, contacts, 1e-3);
        CHECK(contacts.size() >= 4);
        CHECK(contacts.size() <= 60);
        Aabb support;
        for (const Collision& c : contacts) {
          CHECK((c.normal - Vec3::UnitY()).norm() < 1e-9);
          CHECK(c.gap == Approx(gap).margin(1e-12));
          support.include(c.point_a);
        }
        CHECK(support.extent().x() == Approx(2.0 * half.x()).epsilon(1e-3));
        CHECK(support.extent().z() == Approx(2.0 * half.z()).epsilon(1e-3));
      }
}

TEST_CASE("a box a little past the rim of another is not held sideways", "[contacts]") {
  for (double offset : {1e-9, 1e-6, 1e-4, 0.05, 0.3})
    for (double gap : {5e-4, 1e-6, 0.0, -1e-8}) {
      ColliderSet set;
      const MeshPointer mesh = surface(box(Vec3::Constant(0.5), {2, 2, 2}));
      set.add(mesh, {Mat3::Identity(), Vec3(offset, 1.0 + gap, 0.6 * offset)});
      set.add(mesh);
      const std::vector<Collision> contacts = proximity(set, 1e-3);
      CAPTURE(offset, gap);
      CHECK(contacts.size() >= 4);
      for (const Collision& c : contacts) CHECK(c.normal.y() > 0.999);
    }
}

TEST_CASE("crossed bars touch at the four crossings of their edges", "[contacts]") {
  ColliderSet set;
  set.add(surface(box(Vec3(1, 0.1, 0.2))), {Mat3::Identity(), Vec3(0, 0.2005, 0)});
  set.add(surface(box(Vec3(0.2, 0.1, 1))));
  const std::vector<Collision> contacts = proximity(set, 1e-3);
  check_form(set, contacts, 1e-12);
  REQUIRE(contacts.size() == 4);
  for (const Collision& c : contacts) {
    CHECK(c.normal_owner == -1);
    CHECK(c.gap == Approx(5e-4).epsilon(1e-9));
    CHECK(std::abs(c.point_a.x()) == Approx(0.2));
    CHECK(std::abs(c.point_a.z()) == Approx(0.2));
  }
}

TEST_CASE("an edge over an edge has a gap that passes smoothly through zero", "[contacts]") {
  // two cubes, each on an edge, the edges at right angles: apart by h
  const Mat3 upper = Eigen::AngleAxisd(M_PI / 4, Vec3::UnitX()).toRotationMatrix();
  const Mat3 lower = Eigen::AngleAxisd(M_PI / 4, Vec3::UnitZ()).toRotationMatrix();
  const MeshPointer mesh = surface(box(Vec3::Constant(0.5), {2, 2, 2}));
  for (double h : {9e-4, 1e-6, 1e-9, 0.0, -1e-9, -1e-6, -9e-4}) {
    ColliderSet set;
    set.add(mesh, {upper, Vec3(0.11, std::sqrt(2.0) + h, 0.07)});
    set.add(mesh, {lower, Vec3::Zero()});
    const std::vector<Collision> contacts = proximity(set, 1e-3);
    CAPTURE(h);
    REQUIRE(contacts.size() == 1);
    CHECK((contacts[0].normal - Vec3::UnitY()).norm() < 1e-9);
    CHECK(contacts[0].gap == Approx(h).margin(1e-12));
  }
}

TEST_CASE("gaps of two icospheres are those of the spheres within the error of the chords", "[contacts]") {
  const int k = 4;
  const MeshPointer mesh = surface(icosphere(k));
  const double chord = 1.0 - std::cos(1.2 * mean_edge_length(mesh->mesh));  // deepest point of a chord, generously
  Random random(4001);
  for (int i = 0; i < 20; ++i) {
    const double gap = random.in(0.001, 0.02);
    const Vec3 direction = random.direction();
    ColliderSet set;
    set.add(mesh, {random.rotation(), (2.0 + gap) * direction});
    set.add(mesh, {random.rotation(), Vec3::Zero()});
    const std::vector<Collision> contacts = proximity(set, 0.04);
    REQUIRE(!contacts.empty());
    check_form(set, contacts, 1e-12);
    double least = 1.0;
    for (const Collision& c : contacts) {
      const double analytic = (c.point_a - set[0].pose.position).norm();
      CHECK(analytic <= 1.0 + 1e-12);
      least = std::min(least, c.gap);
      CHECK(c.normal.dot(direction) > 0.9);
    }
    CHECK(least >= gap - 1e-12);
    CHECK(least <= gap + 2.0 * chord);
  }
}

TEST_CASE("gaps of separate bumpy bodies are true distances, the least that of the bodies", "[contacts]") {
  Random random(4002);
  const MeshPointer a = surface(bumpy_sphere(2)), b = surface(bumpy_torus(24, 12));
  int tested = 0;
  for (int i = 0; i < 400 && tested < 40; ++i) {
    ColliderSet set;
    set.add(a, random_pose(random, 1.6));
    set.add(b, random_pose(random, 1.6));
    const double reach = 0.3;
    const std::vector<TrianglePair> pairs = triangles_of(set, body_pair(0, 1, reach));
    if (pairs.empty() || std::any_of(pairs.begin(), pairs.end(), [](const TrianglePair& p) { return p.intersecting; }))
      continue;
    // found by the triangle distances alone
    double least = 1e300;
    for (const TrianglePair& p : pairs)
      least = std::min(least, triangle_distance(corners(set[0], p.triangle_a), corners(set[1], p.triangle_b)));
    const double activation = std::min(reach, least + 0.08);
    const std::vector<Collision> contacts = proximity(set, activation);
    CAPTURE(i, least, contacts.size());
    REQUIRE(!contacts.empty());
    check_form(set, contacts, 1e-12);
    ++tested;
    double found = 1e300;
    for (const Collision& c : contacts) {
      found = std::min(found, c.gap);
      CHECK(c.gap == Approx((c.point_a - c.point_b).norm()).epsilon(1e-9));
      // a vertex may have a contact with each side of a groove it stands in: none is nearer than the surface
      if (c.normal_owner == 1) CHECK(c.gap >= distance_to_surface(c.point_a, set[1]) - 1e-12);
      if (c.normal_owner == 0) CHECK(c.gap >= distance_to_surface(c.point_b, set[0]) - 1e-12);
    }
    CHECK(found == Approx(least).epsilon(1e-9));
  }
  CHECK(tested == 40);
}

TEST_CASE("contacts turn round exactly when the bodies are exchanged", "[contacts]") {
  Random random(4003);
  const MeshPointer a = surface(bumpy_sphere(2)), b = surface(bumpy_torus(24, 12));
  std::size_t total = 0;
  for (int i = 0; i < 60; ++i) {
    ColliderSet set, swapped;
    const Pose pa = random_pose(random, 1.1), pb = random_pose(random, 1.1);
    set.add(a, pa), set.add(b, pb);
    swapped.add(b, pb), swapped.add(a, pa);
    for (const bool is_proximity : {true, false}) {
      const std::vector<Collision> there = is_proximity ? proximity(set, 0.05) : intersection(set);
      std::vector<Collision> back = is_proximity ? proximity(swapped, 0.05) : intersection(swapped);
      CAPTURE(i, is_proximity);
      REQUIRE(there.size() == back.size());
      total += there.size();
      for (Collision& c : back) c.feature = c.feature << 32 | c.feature >> 32;
      std::sort(back.begin(), back.end(), [](const Collision& l, const Collision& r) { return l.feature < r.feature; });
      for (std::size_t k = 0; k < there.size(); ++k) {
        REQUIRE(there[k].feature == back[k].feature);
        REQUIRE(there[k].normal == -back[k].normal);
        REQUIRE(there[k].gap == back[k].gap);
        REQUIRE(there[k].point_a == back[k].point_b);
        REQUIRE(there[k].triangle_a == back[k].triangle_b);
      }
    }
  }
  CHECK(total > 500);
}

TEST_CASE("gaps do not depend on where the scene stands", "[contacts]") {
  Random random(4004);
  const MeshPointer a = surface(bumpy_sphere(2)), b = surface(bumpy_torus(24, 12));
  std::size_t total = 0;
  for (int i = 0; i < 60; ++i) {
    ColliderSet set, moved;
    const Pose pa = random_pose(random, 1.1), pb = random_pose(random, 1.1), m = random_pose(random, 2.0);
    set.add(a, pa), set.add(b, pb);
    moved.add(a, {m.rotation * pa.rotation, m.apply(pa.position)}),
        moved.add(b, {m.rotation * pb.rotation, m.apply(pb.position)});
    const std::vector<Collision> there = proximity(set, 0.05), here = proximity(moved, 0.05);
    CAPTURE(i);
    REQUIRE(there.size() == here.size());
    total += there.size();
    for (std::size_t k = 0; k < there.size(); ++k) {
      REQUIRE(there[k].feature == here[k].feature);
      CHECK(std::abs(there[k].gap - here[k].gap) < 1e-12);
      CHECK((m.rotation * there[k].normal - here[k].normal).norm() < 1e-8);
    }
  }
  CHECK(total > 300);
}

TEST_CASE("an activation distance of several edges gives no more contacts than vertices", "[contacts]") {
  const MeshPointer mesh = surface(icosphere(3));
  ColliderSet set;
  set.add(mesh, {Mat3::Identity(), Vec3(0.1, 2.02, 0.03)});
  set.add(mesh);
  const double edge = mean_edge_length(mesh->mesh);
  std::size_t last = 0;
  for (double activation : {0.1 * edge, 1.0 * edge, 3.0 * edge}) {
    const std::vector<Collision> contacts = proximity(set, activation);
    CAPTURE(activation / edge, contacts.size());
    CHECK(contacts.size() >= last);
    last = contacts.size();
  }
  CHECK(last > 10);
  CHECK(last < mesh->mesh.vertices.size());
}

TEST_CASE("a fast vertex is caught before it crosses, one that passes by is not", "[contacts]") {
  const MeshPointer spike = surface(box(Vec3(0.05, 0.05, 0.05)));
  ColliderSet set;
  const Mat3 on_corner =
      Eigen::Quaterniond::FromTwoVectors(Vec3(1, 1, 1).normalized(), Vec3(0, -1, 0)).toRotationMatrix();
  const double low = 0.05 * std::sqrt(3.0);
  set.add(spike, {on_corner, Vec3(0.03, 0.5 + low + 0.02, 0.04)});
  set.add(surface(box(Vec3::Constant(0.5), {4, 4, 4})));
  const double step = 0.01;
  set[0].velocity = Vec3(0.5, -5.0, 0);  // 5 cm down in a step, 2 cm above
  std::vector<Collision> contacts = proximity(set, 1e-3, step, 0.06);
  REQUIRE(!contacts.empty());
  for (const Collision& c : contacts) CHECK((c.normal - Vec3::UnitY()).norm() < 1e-12);
  CHECK(
      std::any_of(contacts.begin(), contacts.end(), [](const Collision& c) { return std::abs(c.gap - 0.02) < 1e-9; }));
  set[0].velocity = Vec3(0, 5.0, 0);
  CHECK(proximity(set, 1e-3, step, 0.06).empty());
  set[0].velocity = Vec3(0, -1.0, 0);  // 1 cm: does not get there
  CHECK(proximity(set, 1e-3, step, 0.06).empty());
  // beside the box, falling along its side
  Pose beside{on_corner, Vec3(0.5 + 0.1, 0.5 + low + 0.02, 0.04)};
  set.place(0, beside);
  set[0].velocity = Vec3(0, -5.0, 0);
  CHECK(proximity(set, 1e-3, step, 0.06).empty());
}

TEST_CASE("overlap of any depth is pushed out", "[contacts]") {
  Random random(4005);
  const MeshPointer a = surface(bumpy_sphere(2)), b = surface(bumpy_torus(24, 12)),
                    cube = surface(box(Vec3::Constant(0.5)));
  int overlapping = 0;
  for (int i = 0; i < 120; ++i) {
    ColliderSet set;
    set.add(i % 2 == 0 ? a : cube, random_pose(random, 0.8));
    set.add(i % 3 == 0 ? b : cube, random_pose(random, 0.8));
    const std::vector<TrianglePair> pairs = triangles_of(set, body_pair(0, 1, 1e-3));
    if (std::none_of(pairs.begin(), pairs.end(), [](const TrianglePair& p) { return p.intersecting; })) continue;
    ++overlapping;
    const std::vector<Collision> contacts = proximity(set, 1e-3);
    CAPTURE(i, pairs.size(), contacts.size());
    CHECK(std::any_of(contacts.begin(), contacts.end(), [](const Collision& c) { return c.gap < 0.0; }));
    CHECK(contacts.size() <= pairs.size() + 10);
    check_form(set, contacts, 1.0);
    const std::vector<Collision> seed = intersection(set);
    CHECK(!seed.empty());
    for (const Collision& c : seed) CHECK(c.gap <= 0.0);
  }
  CHECK(overlapping > 50);
}

TEST_CASE("intersection contacts: deepest vertex, traced back along its path", "[contacts]") {
  // one corner of a cube 4 cm below the top of a block, moving down and sideways
  const MeshPointer spike = surface(box(Vec3::Constant(0.1)));
  const Mat3 on_corner =
      Eigen::Quaterniond::FromTwoVectors(Vec3(1, 1, 1).normalized(), Vec3(0, -1, 0)).toRotationMatrix();
  ColliderSet set;
  set.add(spike, {on_corner, Vec3(0.1, 0.5 + 0.1 * std::sqrt(3.0) - 0.04, -0.2)});
  set.add(surface(box(Vec3::Constant(0.5))));
  const Vec3 tip(0.1, 0.46, -0.2);
  for (const Vec3& velocity :
       {Vec3(1.0, -2.0, 0.0), Vec3(0, 0, 0), Vec3(3.0, -1e-6, 0.0), Vec3(0.0, 2.0, 0.0), Vec3(0.0, -0.65, 6.0)}) {
    set[0].velocity = velocity;
    const std::vector<Collision> contacts = intersection(set);
    CAPTURE(velocity.transpose());
    REQUIRE(contacts.size() == 1);  // three faces meet in the tip, two triangles lie below it
    check_form(set, contacts, 1e-12);
    CHECK((contacts[0].point_a - tip).norm() < 1e-12);
    CHECK((contacts[0].normal - Vec3::UnitY()).norm() < 1e-12);
    CHECK(contacts[0].gap == Approx(-0.04).epsilon(1e-9));
    const Vec3 back = velocity.y() == -2.0 ? Vec3(0.08, 0.5, -0.2) : Vec3(0.1, 0.5, -0.2);
    CHECK((contacts[0].point_b - back).norm() < 1e-12);
  }
}
