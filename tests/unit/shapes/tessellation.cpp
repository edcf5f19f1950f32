#include <catch2/catch.hpp>

#include "engine/core/error.hpp"
#include "engine/geometry/mass_properties.hpp"
#include "engine/shapes/primitives.hpp"
#include "viewer/draw/shaded_surface.hpp"

using namespace impinge;

namespace {

double volume(const TriangleMesh& mesh) {
  double six = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) six += mesh.vertices[a].dot(mesh.vertices[b].cross(mesh.vertices[c]));
  return six / 6.0;
}

double distance_to_surface(const Capsule& capsule, const Vec3& p) {
  const Vec3 nearest(0.0, std::min(capsule.half_length, std::max(-capsule.half_length, p.y())), 0.0);
  return std::abs((p - nearest).norm() - capsule.radius);
}

}  // namespace

TEST_CASE("exact shapes become closed outward surfaces inscribed in them") {
  const double r = 0.7, h = 0.9;
  const Sphere sphere{r};
  const Capsule capsule{r, h};
  const Box box{{0.2, 0.5, 0.9}};
  for (const SharedShape& shape :
       {SharedShape(sphere), SharedShape(capsule), SharedShape(box), SharedShape(Capsule{r, 0.0})}) {
    const TriangleMesh mesh = shape->drawn();
    CHECK(make_topology(mesh).is_closed());
    CHECK(volume(mesh) > 0.0);
    CHECK(shape->drawn().vertices == mesh.vertices);
    CHECK(shape->drawn().triangles == mesh.triangles);
  }
  for (const Vec3& v : sphere.drawn().vertices) CHECK(v.norm() == Approx(r).epsilon(1e-12));
  for (const Vec3& v : capsule.drawn().vertices) CHECK(distance_to_surface(capsule, v) < 1e-12);
  CHECK(volume(sphere.drawn()) == Approx(4.0 / 3.0 * M_PI * r * r * r).epsilon(0.01));
  CHECK(volume(capsule.drawn()) == Approx(4.0 / 3.0 * M_PI * r * r * r + 2.0 * h * M_PI * r * r).epsilon(0.015));
  CHECK(volume(box.drawn()) == Approx(8.0 * 0.2 * 0.5 * 0.9).epsilon(1e-12));
  CHECK_THROWS_AS(Plane{}.drawn(), InternalError);
}

TEST_CASE("corners are smooth on round surfaces and sharp on boxes") {
  const TriangleMesh ball = Sphere{2.0}.drawn();
  const ShadedSurface round = make_shaded_surface(ball, make_topology(ball), 50.0);
  CHECK(round.positions.size() == ball.vertices.size());  // nothing was split
  for (std::size_t i = 0; i < round.positions.size(); ++i)
    CHECK(round.normals[i].dot(round.positions[i].normalized()) > 0.999f);

  const TriangleMesh crate = Box{{1, 2, 3}}.drawn();
  const ShadedSurface sharp = make_shaded_surface(crate, make_topology(crate), 50.0);
  CHECK(sharp.positions.size() == 24);  // three normals a corner
  CHECK(sharp.edges.size() == 18);
  for (std::size_t t = 0; t < crate.triangles.size(); ++t) {
    const Triangle& source = crate.triangles[t];
    const Vec3 normal = (crate.vertices[source[1]] - crate.vertices[source[0]])
                            .cross(crate.vertices[source[2]] - crate.vertices[source[0]])
                            .normalized();
    for (int k = 0; k < 3; ++k) {
      CHECK((sharp.positions[sharp.triangles[t][k]].cast<double>() - crate.vertices[source[k]]).norm() < 1e-6);
      CHECK((sharp.normals[sharp.triangles[t][k]].cast<double>() - normal).norm() < 1e-6);
    }
  }
}
