// Bodies that touch in one point exactly: nothing but rounding is between them, which is where a contact holds them or is lost.
#include <catch2/catch.hpp>

#include "engine/detection/contacts/contact_points.hpp"
#include "engine/geometry/rotation.hpp"
#include "tests/support/geometry/sample_shapes.hpp"
#include "tests/support/geometry/shapes.hpp"
#include "tests/support/mechanics/deformable_bodies.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// A pyramid that stands on its tip, which is its first vertex, in the origin; its axis is +y.
TriangleMesh tip_down(double width, double height, double turn) {
  TriangleMesh mesh;
  mesh.vertices.emplace_back(0.0, 0.0, 0.0);
  for (int k = 0; k < 3; ++k) {
    const double angle = turn - 2.0 * M_PI * k / 3.0;
    mesh.vertices.emplace_back(width * std::cos(angle), height, width * std::sin(angle));
  }
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 3}, {1, 2, 3}};
  return mesh;
}

/// A solid about its frame's origin, and a place on a face of it with that face's normal.
struct Place {
  SharedShape solid;
  std::vector<Vec3> corners;  // all of it lies within these
  Vec3 point, normal;
};

Mat3 turned_to(const Vec3& y) { return Quat::FromTwoVectors(Vec3::UnitY(), y).toRotationMatrix(); }

/// On a side of a box: anywhere, on a diagonal, in the middle, where diagonals and middle lines of a grid of triangles cross.
Place on_box(Random& r, bool is_mesh, bool is_hull) {
  const Vec3 half(r.in(0.2, 1.0), r.in(0.2, 1.0), r.in(0.2, 1.0));
  Place place;
  place.corners = box_corners(half);
  place.solid = is_mesh   ? SharedShape(surface(box(half, {2, 2, 2})))
                : is_hull ? made_hull(place.corners)
                          : SharedShape(Box{half});
  const int axis = r.below(3), u = (axis + 1) % 3, v = (axis + 2) % 3, kind = r.below(4);
  const double side = r.below(2) == 0 ? -1.0 : 1.0;
  place.normal = side * Vec3::Unit(axis);
  place.point = half.cwiseProduct(place.normal);
  const double s = 0.9 * r.sym(), t = kind == 0 ? 0.9 * r.sym() : kind == 1 ? s : -s;
  if (kind < 3) place.point[u] = s * half[u], place.point[v] = t * half[v];
  return place;
}

/// The least of n·x over some points, beyond what n·x is at a place.
double least_along(const Vec3& n, const std::vector<Vec3>& points, const Vec3& from) {
  double least = INFINITY;
  for (const Vec3& x : points) least = std::min(least, n.dot(x - from));
  return least;
}

/// The truth about two convex bodies that touch in `at`: a contact there, without a gap, whose normal separates them.
void check_touch(const std::vector<Collision>& contacts, const std::vector<Vec3>& of_a, const std::vector<Vec3>& of_b,
                 const Vec3& at) {
  double nearest = INFINITY;
  for (const Collision& c : contacts) {
    if ((c.point_a - at).norm() > 1e-9 || (c.point_b - at).norm() > 1e-9) continue;
    const double slope = std::min(least_along(c.normal, of_a, at), least_along(-c.normal, of_b, at));
    if (slope < -1e-9) continue;
    nearest = std::min(nearest, std::abs(c.gap));
  }
  REQUIRE(nearest <= 1e-12);
}

std::vector<Vec3> moved(const Pose& pose, const std::vector<Vec3>& points) {
  std::vector<Vec3> result;
  for (const Vec3& x : points) result.push_back(pose.apply(x));
  return result;
}

/// Contacts of the pyramid (A) on the solid (B), whichever tests those are; deforming or not.
std::vector<Collision> contacts_of(const TriangleMesh& tip, const Pose& pose, const Place& place, const Pose& solid,
                                   bool deforms) {
  constexpr double kActivation = 1e-3;
  if (const SurfaceMesh* mesh = place.solid->mesh()) {
    ColliderSet bodies;
    bodies.add(surface(tip), pose);
    bodies.add(surface(mesh->mesh), solid);
    if (deforms) bodies.place(0, moved(pose, tip.vertices));
    std::vector<TrianglePair> triangles;
    const BodyPair pair{BodyIndex(0), BodyIndex(1), kActivation};
    make_named(narrow_phases(), "bvh")->find(bodies.all(), std::span(&pair, 1), triangles);
    std::vector<Collision> found;
    proximity_contacts(bodies.all(), pair, triangles, kActivation, 1e-3, found);
    return found;
  }
  TestColliders bodies;
  const std::vector<Vec3> still(tip.vertices.size(), Vec3::Zero());
  Collider& first = bodies.add(surface(tip), pose);
  if (deforms) first.vertex_velocities = still;
  bodies.add(place.solid, solid);
  return bodies.contacts(0, 1, {true, kActivation, 1e-3});
}

}  // namespace

TEST_CASE("a tip that stands exactly on a face has a contact with that face's normal") {
  Random r(20261129);
  for (int k = 0; k < 3000; ++k) {
    const bool is_mesh = k % 3 == 1, is_hull = k % 3 == 2, deforms = k % 2 == 0;
    Place place = on_box(r, is_mesh, is_hull);
    const TriangleMesh tip = tip_down(r.in(0.02, 0.2), r.in(0.1, 0.3), r.in(0.0, 6.0));
    // near the origin and far from it, along the axes and not
    Pose solid;
    if (k % 5 != 0) solid = random_pose(r, k % 5 == 1 ? 100.0 : 1.0);
    Pose pose;
    const Vec3 lean = 0.1 * r.vector();
    pose.rotation = solid.rotation * turned_to((place.normal + lean).normalized());
    pose.position = solid.apply(place.point);
    INFO("case " << k << (is_mesh ? " mesh" : is_hull ? " hull" : " box"));
    const Vec3 at = pose.position;
    const auto contacts = contacts_of(tip, pose, place, solid, deforms);
    check_touch(contacts, moved(pose, tip.vertices), moved(solid, place.corners), at);
    for (const Collision& c : contacts)
      if ((c.point_a - at).norm() < 1e-9) REQUIRE(c.normal.dot(solid.rotation * place.normal) > 1.0 - 1e-9);
  }
}

TEST_CASE("a tip that stands exactly on an edge or a corner has a contact whose normal parts the two") {
  Random r(7);
  for (int k = 0; k < 3000; ++k) {
    const bool is_mesh = k % 3 == 1, is_hull = k % 3 == 2, deforms = k % 2 == 0, on_corner = k % 4 == 3;
    Place place = on_box(r, is_mesh, is_hull);
    Vec3 half = place.corners.back(), side;
    for (int i = 0; i < 3; ++i) side[i] = r.below(2) == 0 ? -1.0 : 1.0;
    place.point = half.cwiseProduct(side), place.normal = side;
    if (!on_corner) {
      const int along = r.below(3);
      place.point[along] *= r.below(2) == 0 ? 0.0 : 0.9 * r.u();
      place.normal[along] = 0.0;
    }
    const TriangleMesh tip = tip_down(r.in(0.02, 0.1), r.in(0.1, 0.3), r.in(0.0, 6.0));
    Pose solid;
    if (k % 5 != 0) solid = random_pose(r, k % 5 == 1 ? 100.0 : 1.0);
    Pose pose;
    pose.rotation = solid.rotation * turned_to((place.normal.normalized() + 0.1 * r.vector()).normalized());
    pose.position = solid.apply(place.point);
    INFO("case " << k << (is_mesh ? " mesh" : is_hull ? " hull" : " box") << (on_corner ? " corner" : " edge"));
    check_touch(contacts_of(tip, pose, place, solid, deforms), moved(pose, tip.vertices), moved(solid, place.corners),
                pose.position);
  }
}

TEST_CASE("a tip in the bottom of a groove is held by both its sides") {
  Random r(3);
  for (int k = 0; k < 500; ++k) {
    // a block with a groove along z, whose sides fall by 30 to 60 degrees
    const double slope = std::tan(r.in(0.5, 1.0));
    TriangleMesh block;
    for (const double z : {-1.0, 1.0})
      for (const Vec2& x : {Vec2(0, 0), Vec2(0.5, 0.5 * slope), Vec2(0.5, -1), Vec2(-0.5, -1), Vec2(-0.5, 0.5 * slope)})
        block.vertices.emplace_back(x.x(), x.y(), z);
    for (int i = 0; i < 5; ++i) {
      const int j = (i + 1) % 5;
      block.triangles.push_back({i, j + 5, j});
      block.triangles.push_back({i, i + 5, j + 5});
    }
    for (const int at : {0, 5})
      for (const Triangle& t : {Triangle{0, 1, 2}, Triangle{0, 2, 3}, Triangle{0, 3, 4}})
        block.triangles.push_back(at == 0 ? t : Triangle{t[0] + 5, t[2] + 5, t[1] + 5});
    REQUIRE(mesh_mass(block, 1.0).mass == Approx(2.0 + 0.5 * slope));
    Place place{surface(block), {}, {0.0, 0.0, k % 2 == 0 ? 0.0 : 0.9 * r.sym()}, Vec3::UnitY()};
    Pose solid = k % 3 == 0 ? Pose{} : random_pose(r, 1.0), pose = solid;
    pose.position = solid.apply(place.point);
    const auto contacts = contacts_of(tip_down(0.02, 0.3, r.in(0.0, 6.0)), pose, place, solid, false);
    INFO("case " << k);
    for (const double side : {-1.0, 1.0}) {
      const Vec3 normal = solid.rotation * Vec3(-side * slope, 1.0, 0.0).normalized();
      REQUIRE(std::any_of(contacts.begin(), contacts.end(), [&](const Collision& c) {
        return std::abs(c.gap) < 1e-12 && c.normal.dot(normal) > 1.0 - 1e-9;
      }));
    }
  }
}

namespace {

double lowest(const Body& body) { return body.bounds().min.y(); }

/// What comes down with a tip, a corner or a round end, its lowest point at `place`: all that have one point of contact.
std::vector<BodyDescription> descending(const Vec3& place) {
  std::vector<BodyDescription> bodies;
  const auto add = [&](const char* name, const SharedShape& shape, const Mat3& rotation) {
    BodyDescription d = dynamic_body(name, shape, Vec3::Zero());
    d.rotation = degrees_from_rotation(rotation);
    d.position = place - Vec3(0.0, shape->bounds({rotation, Vec3::Zero()}).min.y(), 0.0);
    bodies.push_back(d);
  };
  const TriangleMesh tip = tip_down(0.05, 0.1, 0.0);
  const Mat3 on_head = Eigen::AngleAxisd(M_PI, Vec3::UnitX()).toRotationMatrix(),
             on_corner = Quat::FromTwoVectors(Vec3(1, 1, 1), Vec3::UnitY()).toRotationMatrix();
  add("pyramid", surface(tip), Mat3::Identity());
  add("pyramid hull", made_hull(tip.vertices), Mat3::Identity());
  add("cone", cone(0.04, 0.1), on_head);
  add("capsule", Capsule{0.03, 0.05}, Mat3::Identity());
  add("ball", Sphere{0.05}, Mat3::Identity());
  add("box on a corner", Box{Vec3::Constant(0.05)}, on_corner);
  add("mesh on a corner", surface(box(Vec3::Constant(0.05))), on_corner);
  add("ball of triangles", surface(icosphere(1, 0.05)), Mat3::Identity());
  return bodies;
}

}  // namespace

TEST_CASE("what comes down on a tip loses no contact where it touches exactly") {
  for (const bool is_mesh : {false, true})
    for (const double height : {0.0, 1e-17, 5e-5, 1e-4})
      for (const int substeps : {1, 2, 3, 4})
        for (const Vec3& at : {Vec3(0, 0, 0), Vec3(0.25, 0, 0.25), Vec3(0.1, 0, -0.1), Vec3(0.11, 0, 0.07)})
          for (const BodyDescription& body : descending(at + Vec3(0.0, height, 0.0))) {
            World world;
            world.parameters.simulation.substeps = substeps;
            world.parameters.simulation.frame_time = substeps == 1 ? 1.0 / 240.0 : 1.0 / 60.0;
            BodyDescription ground;
            ground.name = "ground", ground.kind = BodyKind::fixed;
            ground.shape =
                is_mesh ? SharedShape(surface(box({0.5, 0.05, 0.5}, {2, 1, 2}))) : SharedShape(Box{{0.5, 0.05, 0.5}});
            ground.position = Vec3(0.0, -0.05, 0.0);
            world.add_body(ground);
            world.add_body(body);
            world.start();
            const double activation = world.parameters.contact.activation(0.05);
            INFO(body.name << " at " << at.x() << ", " << at.z() << " from " << height << " m, " << substeps
                           << (is_mesh ? " sub-steps on triangles" : " sub-steps on a box"));
            for (int frame = 0; frame < 6; ++frame) {
              world.step();
              const double depth = -lowest(world.bodies()[1]);
              INFO("frame " << frame);
              REQUIRE(depth <= 0.05 * activation);
              REQUIRE(world.record().stats.substep_penetration >= depth - 1e-12);
            }
          }
}
