// Balls and capsules on their way: what is said to stay out does so at hundreds of moments, by brute force over all
// triangles; and what keeps clear is said to.
#include <catch2/catch.hpp>

#include <cmath>

#include "engine/detection/continuous/round_path.hpp"
#include "engine/geometry/distance.hpp"
#include "engine/geometry/rotation.hpp"
#include "engine/shapes/primitives.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/geometry/rigid_paths.hpp"
#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

constexpr int kInstants = 300;

/// Distance of a segment, taken as a triangle without area, and a triangle: the general routine.
double distance(const Vec3& p, const Vec3& q, const TriangleCorners& t) { return triangle_distance({p, q, q}, t); }

}  // namespace

TEST_CASE("a round body that is said to stay out of triangles does, at every moment") {
  Random random(20261125);
  const SharedShape shapes[] = {Sphere{0.1}, Capsule{0.1, 0.15}, Capsule{0.02, 0.6}};
  const SurfaceMesh drawn{icosphere(1, 0.1), make_topology(icosphere(1, 0.1))};
  const PathSurface of_round(drawn);
  int said = 0, clear = 0, clear_and_said = 0, touching = 0;
  for (const TriangleMesh& mesh :
       {bumpy_sphere(2), sheet(1.0, 1), box(Vec3(0.5, 0.001, 0.5)), torus(0.6, 0.2, 24, 12)}) {
    const SurfaceMesh surface{mesh, make_topology(mesh)};
    const PathSurface of_mesh(surface);
    for (int trial = 0; trial < 150; ++trial) {
      const Shape& shape = *shapes[trial % 3];
      const RoundCore core = *round_core(shape);
      PathSurface own_surface = of_round;
      own_surface.radius = shape.bounding_radius();
      // begins near the surface: at a random vertex, out along the middle's ray or back by a little
      const Vec3 at = mesh.vertices[static_cast<std::size_t>(random.below(static_cast<int>(mesh.vertices.size())))];
      const Mat3 turn = rotation_exp(3.0 * random.vector());
      const bool dips = trial % 15 == 0;  // a ball that overlaps a little from the start, and may
      const double height = dips ? 0.97 * core.radius
                                 : core.radius * random.in(0.9, 1.3) + (core.q - core.p).norm() * random.in(0.0, 0.5);
      const Vec3 out = at.norm() > 0.3 ? Vec3(at.normalized()) : Vec3(Vec3::UnitY());
      const double way = core.radius * std::pow(10.0, dips ? -2.0 : random.in(-3.0, 0.5));
      SurfacePath own, other;
      own.of = &own_surface;
      own.poses = path(random, {turn, at + height * out}, way, 0.2 * way / core.radius, 1 << (trial % 3));
      other.of = &of_mesh;
      other.poses =
          path(random, {}, trial % 2 == 0 ? 0.0 : 0.5 * way, trial % 4 == 1 ? 0.1 * way : 0.0, 1 << (trial % 2));
      const double depth = core.radius * std::pow(10.0, dips ? -1.0 : random.in(-3.5, -1.0));
      const bool is_out = stays_out(core, own, other, depth);
      double nearest = INFINITY;
      for (int k = 0; k <= kInstants; ++k) {
        if (nearest < core.radius - depth && !is_out) break;  // nothing more to learn
        const double moment = static_cast<double>(k) / kInstants;
        const Pose of_own = own.pose_at(moment), of_other = other.pose_at(moment);
        const Vec3 p = of_other.apply_inverse(of_own.apply(core.p)), q = of_other.apply_inverse(of_own.apply(core.q));
        for (const Triangle& c : mesh.triangles) {
          const TriangleCorners t = {mesh.vertices[c[0]], mesh.vertices[c[1]], mesh.vertices[c[2]]};
          const double far = (t[0] - 0.5 * (p + q)).norm() - 0.5 * (q - p).norm() -
                             std::max((t[1] - t[0]).norm(), (t[2] - t[0]).norm());
          if (far < nearest) nearest = std::min(nearest, distance(p, q, t));
        }
      }
      CAPTURE(trial, way, depth, nearest, core.radius, shape.name());
      if (is_out) {
        CHECK(nearest >= core.radius - depth - 1e-12);
        ++said;
        touching += nearest < core.radius ? 1 : 0;
      }
      if (nearest >= core.radius && way < 0.1 * core.radius) ++clear, clear_and_said += is_out ? 1 : 0;
    }
  }
  CAPTURE(said, clear, clear_and_said, touching);
  CHECK(said > 200);
  CHECK(touching > 5);  // and some do dip in by less than is allowed
  CHECK(clear > 100);
  CHECK(clear_and_said > 0.95 * clear);
}

TEST_CASE("two round bodies that are said to stay out of each other do, at every moment") {
  Random random(7);
  const SharedShape shapes[] = {Sphere{0.1}, Capsule{0.1, 0.15}, Capsule{0.02, 0.6}};
  const SurfaceMesh drawn{icosphere(1, 0.1), make_topology(icosphere(1, 0.1))};
  int said = 0, denied = 0;
  for (int trial = 0; trial < 1500; ++trial) {
    const Shape &first = *shapes[trial % 3], &second = *shapes[trial / 3 % 3];
    const RoundCore a = *round_core(first), b = *round_core(second);
    PathSurface of_a(drawn), of_b(drawn);
    of_a.radius = first.bounding_radius(), of_b.radius = second.bounding_radius();
    const double both = a.radius + b.radius, way = both * std::pow(10.0, random.in(-3.0, 0.5));
    SurfacePath path_a, path_b;
    path_a.of = &of_a, path_b.of = &of_b;
    path_a.poses =
        path(random, {rotation_exp(3.0 * random.vector()), Vec3::Zero()}, way, 0.2 * way / both, 1 << (trial % 3));
    path_b.poses = path(random, {rotation_exp(3.0 * random.vector()), both * random.in(0.95, 1.5) * random.direction()},
                        way, 0.2 * way / both, 1 << (trial % 2));
    const double depth = both * std::pow(10.0, random.in(-3.5, -1.0));
    if (!stays_out(a, path_a, b, path_b, depth)) {
      ++denied;
      continue;
    }
    ++said;
    double nearest = INFINITY;
    for (int k = 0; k <= kInstants; ++k) {
      const Pose at_a = path_a.pose_at(1.0 * k / kInstants), at_b = path_b.pose_at(1.0 * k / kInstants);
      nearest = std::min(
          nearest, distance(at_a.apply(a.p), at_a.apply(a.q), {at_b.apply(b.p), at_b.apply(b.q), at_b.apply(b.q)}));
    }
    CAPTURE(trial, way, depth, nearest, both);
    CHECK(nearest >= both - depth - 1e-12);
  }
  CAPTURE(said, denied);
  CHECK(said > 500);
  CHECK(denied > 500);
}

TEST_CASE("a rod that rolls over triangles is known to stay out of them, however fast it spins") {
  Random random(11);
  const Capsule rod{0.02, 0.5};
  const RoundCore core = *round_core(rod);
  const SurfaceMesh drawn{icosphere(1, 0.1), make_topology(icosphere(1, 0.1))};
  PathSurface own_surface(drawn);
  own_surface.radius = rod.bounding_radius();
  const TriangleMesh mesh = sheet(2.0, 6);
  const SurfaceMesh surface{mesh, make_topology(mesh)};
  const PathSurface of_mesh(surface);
  int said = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const double slant = trial % 2 == 0 ? 0.0 : random.in(0.0, 0.002);  // radians about the vertical as it rolls
    const double turn = std::pow(10.0, random.in(-1.0, 1.0)), sink = trial % 10 == 0 ? 0.01 : 0.0;
    SurfacePath own, other;
    own.of = &own_surface, other.of = &of_mesh;
    other.poses = {Pose(), Pose()};
    const Mat3 level = rotation_exp(0.5 * M_PI * Vec3::UnitX());
    for (int i = 0; i <= 16; ++i) {
      const double t = i / 16.0;
      own.poses.push_back({rotation_exp(slant * t * Vec3::UnitY()) * level * rotation_exp(turn * t * Vec3::UnitY()),
                           Vec3(-0.02 * turn * t, 0.02 + 1e-7 - sink * t * core.radius, 0.0)});
    }
    const double depth = 1e-3 * core.radius;
    const bool is_out = stays_out(core, own, other, depth);
    CAPTURE(trial, slant, turn, sink);
    CHECK(is_out == (sink == 0.0));  // it ends ten times deeper than it may
    said += is_out ? 1 : 0;
  }
  CHECK(said == 90);
}
