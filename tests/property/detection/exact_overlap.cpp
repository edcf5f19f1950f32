// Bodies that lie in one another exactly: the axis of a capsule through a corner, along an edge or in a face of a mesh,
// corners on corners, centres on edges. Directions between such places are rounding; depths are not.
#include <catch2/catch.hpp>

#include <set>

#include "tests/support/geometry/brute_convex.hpp"
#include "tests/support/geometry/sample_shapes.hpp"
#include "tests/support/geometry/shapes.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// A convex mesh about its origin, and a place on its surface.
struct SurfacePlace {
  TriangleMesh mesh;
  Vec3 at, along, into;  // `along` an edge that ends there or holds it, `into` another direction in a face there
  Vec3 outward;          // between the normals of the faces there
};

SurfacePlace surface_place(Random& r, bool is_round) {
  const bool is_exact = r.below(2) == 0;
  const Vec3 half = is_exact ? Vec3(0.5, 0.25, 0.75) : Vec3(r.in(0.2, 0.8), r.in(0.2, 0.8), r.in(0.2, 0.8));
  SurfacePlace place;
  place.mesh = is_round ? icosphere(r.below(3), 0.5) : box(half, Eigen::Vector3i::Constant(1 + r.below(2)));
  const Triangle& t = place.mesh.triangles[r.below(static_cast<int>(place.mesh.triangles.size()))];
  const int k = r.below(3), kind = r.below(3);
  const Vec3 &a = place.mesh.vertices[t[k]], &b = place.mesh.vertices[t[(k + 1) % 3]],
             &c = place.mesh.vertices[t[(k + 2) % 3]];
  place.at = kind == 0   ? a
             : kind == 1 ? Vec3(a + (is_exact ? 0.5 : r.in(0.1, 0.9)) * (b - a))
                         : Vec3(0.25 * a + 0.25 * b + 0.5 * c);
  place.along = b - a;
  place.into = is_exact ? Vec3(c - a) : Vec3(r.sym() * (b - a) + r.sym() * (c - a));
  std::set<std::array<long, 3>> known;
  place.outward = Vec3::Zero();
  for (const Triangle& u : place.mesh.triangles) {
    const TriangleCorners corners{place.mesh.vertices[u[0]], place.mesh.vertices[u[1]], place.mesh.vertices[u[2]]};
    if (closest_on_triangle(place.at, corners).squared_distance > 1e-20) continue;
    const Vec3 n = normal_of(corners).normalized();
    if (known.insert({std::lround(1e6 * n.x()), std::lround(1e6 * n.y()), std::lround(1e6 * n.z())}).second)
      place.outward += n;
  }
  place.outward.normalize();
  return place;
}

Mat3 quarter_turns(Random& r) {
  Mat3 turned = Mat3::Identity();
  for (int i = 0; i < 3; ++i) {
    const int k = r.below(3);
    Mat3 quarter = Mat3::Zero();
    quarter(k, k) = 1.0, quarter((k + 1) % 3, (k + 2) % 3) = -1.0, quarter((k + 2) % 3, (k + 1) % 3) = 1.0;
    turned = quarter * turned;
  }
  return turned;
}

/// As it is, turned by right angles, or anyhow.
Pose anyhow(Random& r) {
  Pose pose;
  const int kind = r.below(3);
  if (kind == 1) pose.rotation = quarter_turns(r);
  if (kind == 2) pose = random_pose(r, 1.0);
  return pose;
}

double support(const TriangleMesh& mesh, const Vec3& n) {
  double most = -INFINITY;
  for (const Vec3& v : mesh.vertices) most = std::max(most, n.dot(v));
  return most;
}

/// Contacts of a shape at a pose in the frame of a mesh, whose own pose is `where`; normals in the mesh's frame.
std::vector<Collision> contacts_in(const SharedShape& shape, const Pose& pose, const TriangleMesh& mesh,
                                   const Pose& where, bool deforms) {
  TestColliders bodies;
  bodies.add(shape, {where.rotation * pose.rotation, where.apply(pose.position)});
  Collider& second = bodies.add(surface(mesh), where);
  const std::vector<Vec3> still(mesh.vertices.size(), Vec3::Zero());
  if (deforms) second.vertex_velocities = still;
  std::vector<Collision> contacts = bodies.contacts(0, 1, {true, 1e-3, 0.0});
  for (Collision& c : contacts) c.normal = where.rotation.transpose() * c.normal;
  return contacts;
}

/// Along an axis exactly where it is a coordinate axis.
Mat3 standing_along(const Vec3& axis) {
  for (int i = 0; i < 3; ++i) {
    if (std::abs(std::abs(axis[i]) - 1.0) > 1e-14) continue;
    Mat3 turned = Mat3::Zero();
    turned(i, 1) = axis[i], turned((i + 1) % 3, 2) = 1.0, turned((i + 2) % 3, 0) = axis[i];
    return turned;
  }
  return Quat::FromTwoVectors(Vec3::UnitY(), axis).toRotationMatrix();
}

/// The distance of a segment from a convex mesh, or minus how far it has to go to leave it: over all faces and all edges.
double segment_gap(const TriangleMesh& mesh, const Vec3& p, const Vec3& q) {
  double depth = INFINITY, distance_sq = INFINITY;
  const auto try_axis = [&](const Vec3& axis, double least) {
    if (!(axis.norm() > least)) return;
    for (const Vec3& n : {Vec3(axis.normalized()), Vec3(-axis.normalized())})
      depth = std::min(depth, support(mesh, n) - std::min(n.dot(p), n.dot(q)));
  };
  for (const Triangle& t : mesh.triangles) {
    const TriangleCorners c{mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
    try_axis(normal_of(c), 0.0);
    for (const Vec3& x : {p, q}) distance_sq = std::min(distance_sq, closest_on_triangle(x, c).squared_distance);
    for (int k = 0; k < 3; ++k) {
      const Vec3 edge = c[(k + 1) % 3] - c[k];
      try_axis(edge.cross(q - p), 1e-6 * edge.norm() * (q - p).norm());
      distance_sq = std::min(distance_sq, closest_between_segments(p, q, c[k], c[(k + 1) % 3]).squared_distance);
    }
  }
  return depth > 1e-9 ? -depth : std::sqrt(distance_sq);
}

}  // namespace

TEST_CASE("a capsule whose axis touches a mesh exactly is a radius deep, and goes out across it") {
  Random r(20261130);
  int touching = 0, crossing = 0;
  for (int k = 0; k < 12000; ++k) {
    const SurfacePlace place = surface_place(r, k % 2 == 0);
    const Vec3 directions[] = {place.outward.cross(r.direction()),
                               place.along,
                               place.into,
                               r.direction(),
                               place.outward,
                               Vec3::Unit(r.below(3))};
    const Vec3 axis = directions[r.below(6)].normalized();
    const double lengths[] = {1e-9, 1e-3, 0.05, 0.3, 2.0, 50.0};
    const double half = lengths[r.below(6)], radius = r.below(2) == 0 ? 0.125 : std::pow(10.0, r.in(-3.0, -0.5));
    const double shares[] = {0.0, 1.0, 1.0 / 3.0};
    const Vec3 center = place.at + half * shares[r.below(3)] * axis, p = center - half * axis, q = center + half * axis;
    const double gap = segment_gap(place.mesh, p, q), depth = radius - gap;
    if (depth < 0.0) continue;
    INFO("case " << k << ", half length " << half << ", radius " << radius << ", depth " << depth);
    const auto contacts =
        contacts_in(Capsule{radius, half}, {standing_along(axis), center}, place.mesh, anyhow(r), k % 4 < 2);
    REQUIRE(!contacts.empty());
    REQUIRE(-smallest_gap(contacts) >= 0.999 * radius);
    if (gap < -1e-9) {
      ++crossing;
      continue;
    }
    ++touching;
    REQUIRE(-smallest_gap(contacts) == Approx(depth).margin(1e-9));
    double least = INFINITY;  // how far it would have to go along one of the normals
    for (const Collision& c : contacts)
      least = std::min(least, support(place.mesh, c.normal) - std::min(c.normal.dot(p), c.normal.dot(q)) + radius);
    REQUIRE(least <= depth + 1e-6 * (depth + half) + 2e-9);  // segment_gap is right to 1e-9
  }
  REQUIRE(touching > 6000);
  REQUIRE(crossing > 2000);
}

TEST_CASE("a capsule whose axis passes just under a ridge goes out across the ridge") {
  Random r(5);
  int told = 0;
  for (int k = 0; k < 3000; ++k) {
    const Vec3 half(r.in(0.2, 0.8), r.in(0.2, 0.8), r.in(0.2, 0.8));
    const TriangleMesh mesh = box(half, Eigen::Vector3i::Constant(1 + k % 2));
    // under the edge along z, from one face to the other, both ends far out
    const double under = std::pow(10.0, r.in(-8.0, -2.0)), radius = r.in(0.05, 0.15);
    const Vec3 out = Vec3(1.0, r.in(0.5, 2.0), 0.0).normalized();
    const Vec3 axis = (Vec3::UnitZ().cross(out) + 0.3 * r.sym() * Vec3::UnitZ()).normalized();
    const Vec3 center = Vec3(half.x(), half.y(), 0.3 * half.z() * r.sym()) - under * out;
    const double length = 1.0, depth = radius - segment_gap(mesh, center - length * axis, center + length * axis);
    if (std::abs(depth - radius - under) > 1e-6 * under) continue;
    ++told;
    INFO("case " << k << ", " << under << " m under the edge");
    const auto contacts =
        contacts_in(Capsule{radius, length}, {standing_along(axis), center}, mesh, anyhow(r), k % 3 == 0);
    REQUIRE(!contacts.empty());
    REQUIRE(-smallest_gap(contacts) == Approx(depth).margin(1e-9));
    const bool is_across = std::any_of(contacts.begin(), contacts.end(),
                                       [&](const Collision& c) { return c.normal.dot(out) > 1.0 - 1e-6; });
    REQUIRE(is_across);
  }
  REQUIRE(told > 2000);
}

namespace {

/// A solid of about a size, and places in and on it.
struct Solid {
  SharedShape shape;
  std::vector<Vec3> places;
};

Solid solid_of(Random& r, int kind, double size) {
  const double x = size, y = 0.5 * size;
  if (kind == 0) return {Sphere{x}, {Vec3::Zero()}};
  if (kind == 1)
    return {Box{Vec3(x, y, 2 * x)}, {Vec3(x, y, 2 * x), Vec3(x, y, 0), Vec3(0, y, 0), Vec3::Zero(), Vec3(y, 0, x)}};
  if (kind == 2)
    return {cylinder(x, 2 * x), {Vec3(x, x, 0), Vec3(x, 0, 0), Vec3(0, x, 0), Vec3(0, y, 0), Vec3::Zero()}};
  if (kind == 3) {
    const SharedShape shape = cone(x, 2 * x);
    const double base = shape->bounds({}).min.y();
    return {shape, {Vec3(x, base, 0), Vec3(0, base, 0), Vec3::Zero()}};
  }
  const std::vector<Vec3> points = r.below(2) == 0 ? box_corners(Vec3::Constant(x)) : icosphere(1, x).vertices;
  return {made_hull(points), {points[0], 0.5 * (points[0] + points[1]), Vec3::Zero()}};
}

/// How far the shape would have to go along a direction to leave the mesh.
double way_along(const Vec3& n, const SharedShape& shape, const Pose& pose, const TriangleMesh& mesh) {
  const auto form = shape->form();
  const Vec3 local = pose.rotation.transpose() * -n;
  const double reach = shape->as<Sphere>() != nullptr ? shape->as<Sphere>()->radius
                                                      : local.dot(std::get<const ConvexSet*>(form)->support(local)) +
                                                            std::get<const ConvexSet*>(form)->rounding();
  return support(mesh, n) + reach - n.dot(pose.position);
}

bool is_apart(const SharedShape& shape, const Pose& pose, const TriangleMesh& mesh) {
  const auto form = shape->form();
  const ConvexSet* const* solid = std::get_if<const ConvexSet*>(&form);
  if (solid == nullptr || (*solid)->polyhedron() == nullptr) return false;
  TriangleMesh own = (*solid)->polyhedron()->surface()->mesh;
  for (Vec3& v : own.vertices) v = pose.apply(v);
  return brute_convex_gap(own, mesh).gap > -0.01 * shape->size();
}

}  // namespace

TEST_CASE("a shape that is in a mesh exactly to a corner, an edge or a face has a contact that pushes it out") {
  Random r(17);
  int overlapping[5] = {};
  for (int k = 0; k < 6000; ++k) {
    const int kind = k % 5;
    const SurfacePlace place = surface_place(r, r.below(2) == 0);
    const Solid solid = solid_of(r, kind, r.below(2) == 0 ? 0.25 : std::pow(10.0, r.in(-2.0, 0.0)));
    const Vec3& own = solid.places[r.below(static_cast<int>(solid.places.size()))];
    Pose pose;
    pose.rotation = k % 3 != 0
                        ? r.rotation()
                        : Quat::FromTwoVectors(own.norm() > 0.0 ? own : Vec3::UnitY(), Vec3(-place.at.normalized()))
                              .toRotationMatrix();
    pose.position = place.at - pose.rotation * own;
    // the least way over many directions, those of all faces among them, refined
    double depth = INFINITY;
    Vec3 best = Vec3::UnitX();
    const auto try_way = [&](const Vec3& n) {
      if (!(n.norm() > 1e-9)) return;
      const double way = way_along(n.normalized(), solid.shape, pose, place.mesh);
      if (way < depth) depth = way, best = n.normalized();
    };
    for (const Triangle& t : place.mesh.triangles)
      try_way(normal_of({place.mesh.vertices[t[0]], place.mesh.vertices[t[1]], place.mesh.vertices[t[2]]}));
    for (int i = 0; i < 3; ++i) try_way(pose.rotation.col(i)), try_way(-pose.rotation.col(i));
    for (int i = 0; i < 300; ++i) try_way(r.direction());
    const Vec3 from_outward = pose.position - place.at;
    try_way(from_outward), try_way(place.outward);
    for (double step = 0.5; step > 1e-7; step *= 0.7)
      for (int i = 0; i < 15; ++i) try_way(best + step * r.vector());
    if (depth < 0.01 * solid.shape->size()) continue;  // what is shallower may be apart between these directions
    const auto contacts = contacts_in(solid.shape, pose, place.mesh, anyhow(r), k % 4 < 2);
    // of many directions none may part two that are apart; of a polyhedron all of them are known, and slow
    if (smallest_gap(contacts) >= 0.0 && is_apart(solid.shape, pose, place.mesh)) continue;
    ++overlapping[kind];
    INFO("case " << k << ", " << solid.shape->name() << ", depth " << depth);
    REQUIRE(!contacts.empty());
    REQUIRE(smallest_gap(contacts) < 0.0);
    double least = INFINITY;
    for (const Collision& c : contacts) {
      REQUIRE(std::abs(c.normal.norm() - 1.0) < 1e-8);
      least = std::min(least, way_along(c.normal, solid.shape, pose, place.mesh));
    }
    // of others each of several contacts may tell of a part
    if (kind == 0 || kind == 2) REQUIRE(least <= 4.0 * depth);
  }
  for (const int count : overlapping) REQUIRE(count > 500);
}

TEST_CASE("a mesh that lies in a solid as a whole has a contact that tells how far it is to the outside") {
  Random r(29);
  for (int k = 0; k < 600; ++k) {
    const double size = r.in(0.4, 1.0);
    const Solid solid = solid_of(r, k % 2 == 0 ? 1 : 4, size);
    const TriangleMesh mesh = k % 3 == 0 ? icosphere(1, 0.1 * size) : box(0.1 * size * Vec3(1, 0.5, 0.7));
    const Pose pose{r.rotation(), 0.1 * size * r.vector()};
    INFO("case " << k << ", " << solid.shape->name());
    const auto contacts = contacts_in(solid.shape, pose, mesh, anyhow(r), k % 4 < 2);
    REQUIRE(!contacts.empty());
    for (const Collision& c : contacts)
      REQUIRE(-c.gap == Approx(way_along(c.normal, solid.shape, pose, mesh)).margin(1e-9));
  }
}
