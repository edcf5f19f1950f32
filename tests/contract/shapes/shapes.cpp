// What every shape on the list promises, whichever it is.
#include <catch2/catch.hpp>

#include <set>

#include "engine/geometry/inside.hpp"
#include "engine/geometry/mass_properties.hpp"
#include "tests/support/geometry/sample_shapes.hpp"
#include "tests/support/geometry/shapes.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

const ConvexSet* convex_of(const SharedShape& shape) {
  const ShapeForm form = shape->form();
  const auto* set = std::get_if<const ConvexSet*>(&form);
  return set == nullptr ? nullptr : *set;
}

bool is_infinite(const SharedShape& shape) { return shape->as<Plane>() != nullptr; }

}  // namespace

TEST_CASE("shapes have names of their own, words about them, and keys that say what they are", "[methods]") {
  std::set<std::string_view> names;
  for (const ShapeEntry& entry : shape_entries()) {
    CAPTURE(entry.name);
    CHECK(names.insert(entry.name).second);
    CHECK(entry.doc.size() > 10);
    CHECK((entry.make != nullptr) == !entry.keys.empty());
    std::set<std::string_view> keys;
    for (const ShapeKey& key : entry.keys) {
      CHECK(keys.insert(key.name).second);
      CHECK(!key.doc.empty());
    }
  }
  CHECK(names.size() >= 9);
}

TEST_CASE("a shape knows its bounds, its farthest point and its triangles", "[methods]") {
  Random r(41);
  for (const ShapeEntry& entry : shape_entries())
    for (int i = 0; i < 6; ++i) {
      CAPTURE(entry.name, i);
      const SharedShape shape = sample_shape(r, entry);
      CHECK(shape->name() == entry.name);
      if (is_infinite(shape)) continue;
      const TriangleMesh drawn = shape->drawn(), fine = shape->surface(0.05);
      double farthest = 0.0;
      for (const TriangleMesh* mesh : {&drawn, &fine}) {
        CHECK(make_topology(*mesh).is_closed());
        CHECK(signed_volume(*mesh) > 0.0);
        for (const Vec3& v : mesh->vertices) {
          farthest = std::max(farthest, v.norm());
          CHECK(shape->signed_distance(v) < 1e-9);  // inscribed
        }
      }
      CHECK(shape->drawn().vertices == drawn.vertices);
      CHECK(shape->bounding_radius() >= farthest * (1.0 - 1e-12));
      CHECK(shape->bounding_radius() <= 2.0 * farthest);

      const Pose pose = random_pose(r, 3.0);
      const Aabb box = shape->bounds(pose);
      Aabb of_triangles;
      for (const Vec3& v : fine.vertices) of_triangles.include(pose.apply(v));
      CHECK((box.min.array() <= of_triangles.min.array() + 1e-12).all());
      CHECK((box.max.array() >= of_triangles.max.array() - 1e-12).all());
      // no larger than it has to be, as far as triangles tell
      CHECK((of_triangles.extent() - box.extent()).cwiseAbs().maxCoeff() < 0.05);
    }
}

TEST_CASE("a shape's mass is that of its triangles, as fine as they are, about its own centre", "[methods]") {
  Random r(42);
  for (const ShapeEntry& entry : shape_entries())
    for (int i = 0; i < 4; ++i) {
      CAPTURE(entry.name, i);
      const SharedShape shape = sample_shape(r, entry);
      const MassProperties mass = shape->mass(700.0);
      if (is_infinite(shape)) {
        CHECK(mass.mass == 0.0);
        continue;
      }
      const MassProperties of_triangles = mesh_mass(shape->surface(0.02), 700.0);
      CHECK(mass.mass == Approx(of_triangles.mass).epsilon(0.01));
      CHECK(mass.center.norm() < 1e-12);
      CHECK(of_triangles.center.norm() < 0.01);
      CHECK((mass.inertia - of_triangles.inertia).norm() < 0.02 * mass.inertia.norm());
      CHECK((mass.inertia - mass.inertia.transpose()).norm() < 1e-12 * mass.inertia.norm());
      // moved, it weighs the same, elsewhere
      const Vec3 by = r.vector();
      if (shape->mesh() == nullptr && shape->parts() == nullptr) continue;
      const MassProperties moved = shape->recentered(by)->mass(700.0);
      CHECK((moved.center + by).norm() < 1e-12);
      CHECK((moved.inertia - mass.inertia).norm() < 1e-9 * mass.inertia.norm());
    }
}

TEST_CASE("the signed distance has the sign of the winding number and the size of the way to the surface",
          "[methods]") {
  Random r(43);
  for (const ShapeEntry& entry : shape_entries()) {
    const SharedShape shape = sample_shape(r, entry);
    if (is_infinite(shape)) continue;
    const TriangleMesh fine = shape->surface(0.03);
    int inside = 0;
    for (int i = 0; i < 150; ++i) {
      const Vec3 x = (i % 2 ? 1.5 : 0.5) * shape->bounding_radius() * r.vector();
      const double signed_distance = shape->signed_distance(x);
      CAPTURE(entry.name, i, x.transpose(), signed_distance);
      const double winding = winding_number(x, fine.vertices, fine.triangles);
      if (std::abs(signed_distance) > 0.02) CHECK((signed_distance < 0.0) == (winding > 0.5));
      inside += signed_distance < 0.0 ? 1 : 0;
      // of overlapping parts the triangles inside are none of the surface
      if (shape->parts() != nullptr && signed_distance < 0.0) continue;
      CHECK(std::abs(signed_distance) == Approx(distance_to_surface(x, fine.vertices, fine.triangles)).margin(0.01));
    }
    CHECK(inside > 5);
  }
}

TEST_CASE("a convex shape reaches farthest at its support, and what faces a direction lies there", "[methods]") {
  Random r(44);
  int tried = 0;
  for (const ShapeEntry& entry : shape_entries())
    for (int i = 0; i < 200; ++i) {
      const SharedShape shape = sample_shape(r, entry);
      const ConvexSet* set = convex_of(shape);
      if (set == nullptr) break;
      ++tried;
      // any direction, along the axes, and all but along them
      Vec3 d = r.direction();
      if (i % 3 == 1) d = Vec3::Unit(r.below(3)) * (r.below(2) ? 1.0 : -1.0);
      if (i % 3 == 2) d = (Vec3::Unit(r.below(3)) + std::pow(10.0, r.in(-12.0, -1.0)) * r.direction()).normalized();
      CAPTURE(entry.name, i, d.transpose());
      const Vec3 far = set->support(d) + set->rounding() * d;
      CHECK((set->support(5.0 * d) - set->support(d)).norm() < 1e-15);
      CHECK(std::abs(shape->signed_distance(far)) < 1e-9);
      double most = -1e300;
      for (const Vec3& v : shape->drawn().vertices) most = std::max(most, d.dot(v));
      CHECK(d.dot(far) >= most - 1e-12);
      CHECK(d.dot(far) <= most + 0.02);

      const ContactFace face = set->facing(d);
      REQUIRE(face.count >= 1);
      double nearest = -1e300;
      std::set<int> vertices, edges;
      for (int k = 0; k < face.count; ++k) {
        CHECK(std::abs(shape->signed_distance(face.point[k])) < 1e-6);
        nearest = std::max(nearest, d.dot(face.point[k]));
        CHECK(vertices.insert(face.vertex[k]).second);
        CHECK(edges.insert(face.edge[k]).second);
      }
      CHECK(nearest <= d.dot(far) + 1e-9);
      if (face.count == 2) {
        CHECK(nearest >= d.dot(far) - 1e-9);
        CHECK(std::abs((face.point[1] - face.point[0]).normalized().dot(d)) < 0.26);
      }
      if (face.count < 3) continue;
      CHECK(std::abs(face.normal.norm() - 1.0) < 1e-12);
      for (int k = 0; k < face.count; ++k) {
        const Vec3 &a = face.point[k], &b = face.point[(k + 1) % face.count], &c = face.point[(k + 2) % face.count];
        CHECK((b - a).cross(c - b).dot(face.normal) > 0.0);  // counter-clockwise, convex
        CHECK(std::abs((b - a).dot(face.normal)) < 1e-6);
      }
    }
  CHECK(tried > 1000);
}

TEST_CASE("shapes of equal numbers are drawn from one surface, all others are themselves", "[methods]") {
  Random r(45);
  for (const ShapeEntry& entry : shape_entries()) {
    CAPTURE(entry.name);
    const SharedShape a = sample_shape(r, entry), b = sample_shape(r, entry);
    if (a->dimensions().empty()) continue;
    CHECK(a->dimensions() != b->dimensions());
    if (!is_infinite(a)) CHECK(a->drawn().vertices != b->drawn().vertices);
  }
  const SharedShape one = made("cylinder", {{"radius", 0.1}, {"length", 0.3}}),
                    other = made("cylinder", {{"radius", 0.1}, {"length", 0.3}}),
                    longer = made("cylinder", {{"radius", 0.1}, {"length", 0.4}});
  CHECK(one->dimensions() == other->dimensions());
  CHECK(one->dimensions() != longer->dimensions());
}

TEST_CASE("every shape has contacts with every other, found the same from both sides and wherever the scene lies",
          "[methods]") {
  Random r(46);
  const std::vector<ShapeEntry>& entries = shape_entries();
  for (std::size_t i = 0; i < entries.size(); ++i)
    for (std::size_t j = 0; j < entries.size(); ++j) {
      int touching = 0;
      for (int k = 0; k < 25; ++k) {
        const SharedShape a = sample_shape(r, entries[i]), b = sample_shape(r, entries[j]);
        if (a->mesh() != nullptr && b->mesh() != nullptr) continue;  // the triangle search's
        if (is_infinite(a) && is_infinite(b)) continue;
        const Pose pose_a = is_infinite(a) ? Pose{} : random_pose(r, 0.7),
                   pose_b = is_infinite(b) ? Pose{} : random_pose(r, 0.7);
        CAPTURE(entries[i].name, entries[j].name, k);
        TestColliders bodies;
        bodies.add(a, pose_a);
        bodies.add(b, pose_b);
        bodies.add(a, pose_a);
        const ContactQuery query{k % 3 != 0, 0.05, 0.0};
        const auto contacts = bodies.contacts(0, 1, query), swapped = bodies.contacts(1, 2, query);
        std::set<std::uint64_t> names;
        for (const Collision& c : contacts) {
          REQUIRE((c.body_a == 0 && c.body_b == 1));
          REQUIRE((c.point_a.allFinite() && c.point_b.allFinite() && c.normal.allFinite()));
          REQUIRE(c.normal.norm() == Approx(1.0).epsilon(1e-12));
          REQUIRE(c.gap == Approx(c.normal.dot(c.point_a - c.point_b)).margin(1e-12));
          REQUIRE((c.triangle_a >= 0) == (a->mesh() != nullptr));
          REQUIRE((c.triangle_b >= 0) == (b->mesh() != nullptr));
          REQUIRE((c.normal_owner == -1 || c.normal_owner == 0 || c.normal_owner == 1));
          REQUIRE(c.gap <= (query.proximity ? query.activation : 0.0));
          REQUIRE(names.insert(c.feature).second);
        }
        touching += contacts.empty() ? 0 : 1;
        REQUIRE(swapped.empty() == contacts.empty());
        if (contacts.empty()) continue;
        CHECK(smallest_gap(swapped) == Approx(smallest_gap(contacts)).margin(1e-7));
        // feature by feature a deep overlap with a mesh has no one answer: which side is nearest is a matter of rounding
        if ((a->mesh() != nullptr || b->mesh() != nullptr) && smallest_gap(contacts) < -0.05) continue;

        const Pose move = random_pose(r, 2.0);
        TestColliders moved;
        moved.add(a, then(move, pose_a));
        moved.add(b, then(move, pose_b));
        const auto there = moved.contacts(0, 1, query);
        REQUIRE(!there.empty());
        CHECK(smallest_gap(there) == Approx(smallest_gap(contacts)).margin(1e-7));
      }
      CAPTURE(entries[i].name, entries[j].name);
      const bool none = entries[i].name == "plane" && entries[j].name == "plane";
      const bool meshes = entries[i].name == "mesh" && entries[j].name == "mesh";
      if (!none && !meshes) CHECK(touching > 3);
    }
}
