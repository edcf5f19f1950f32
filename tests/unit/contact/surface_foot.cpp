// The nearest point of a body's surface and the normal there, held against the shapes' signed distances.
#include "engine/contact/surface_foot.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "engine/bodies/body_description.hpp"
#include "tests/support/geometry/sample_shapes.hpp"
#include "tests/support/mechanics/worlds.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// A static body of the shape, in a random place.
std::unique_ptr<Body> placed(Random& r, const SharedShape& shape) {
  BodyDescription d = dynamic_body("body", shape, Vec3(r.sym(), r.sym(), r.sym()));
  d.kind = BodyKind::fixed;
  d.rotation = Vec3(180.0 * r.sym(), 90.0 * r.sym(), 180.0 * r.sym());
  std::unique_ptr<Body> body = make_body(d);
  body->update_world_vertices();
  return body;
}

}  // namespace

TEST_CASE("a foot is as far as the signed distance says, from outside and from inside", "[methods]") {
  Random r(17);
  for (const ShapeEntry& entry : shape_entries())
    for (int i = 0; i < 40; ++i) {
      const SharedShape shape = sample_shape(r, entry);
      const auto body = placed(r, shape);
      const Vec3 x = body->pose.position + Vec3(r.sym(), r.sym(), r.sym());
      const double distance = body->shape->signed_distance(body->pose.apply_inverse(x));
      const SurfaceFoot foot = surface_foot(*body, x);
      CAPTURE(std::string(entry.name), i, distance, foot.distance);
      CHECK(foot.distance == Approx(distance).margin(1e-8));
      CHECK(foot.normal.norm() == Approx(1.0).epsilon(1e-12));
      // of a curved solid the way out from inside is found by its length: the direction is known to half the digits
      CHECK((foot.point + foot.distance * foot.normal - x).norm() < (distance > 0.0 ? 1e-9 : 2e-6));
      if (distance > 0.0) CHECK(std::abs(body->shape->signed_distance(body->pose.apply_inverse(foot.point))) < 1e-8);
    }
}

TEST_CASE("a point of the surface is its own foot, with the normal that it has a little off", "[methods]") {
  Random r(18);
  for (const ShapeEntry& entry : shape_entries())
    for (int i = 0; i < 40; ++i) {
      const auto body = placed(r, sample_shape(r, entry));
      const Vec3 out = body->pose.position + 3.0 * r.direction();
      const SurfaceFoot far = surface_foot(*body, out);
      if (!(far.distance > 0.0)) continue;
      const SurfaceFoot on = surface_foot(*body, far.point), off = surface_foot(*body, far.point + 1e-3 * far.normal);
      CAPTURE(std::string(entry.name), i, far.distance, on.distance, on.normal, far.normal);
      CHECK(std::abs(on.distance) < 1e-8);
      CHECK(off.normal.dot(far.normal) > 1.0 - 1e-9);
      CHECK((off.point - far.point).norm() < 1e-6);
      CHECK(on.normal.allFinite());
    }
}
