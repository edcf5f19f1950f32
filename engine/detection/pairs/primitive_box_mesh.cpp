// Box and convex hull against a mesh: polyhedra, which know their faces.
#include <cmath>

#include "engine/detection/pairs/polyhedron_mesh.hpp"
#include "engine/detection/pairs/primitive_pairs.hpp"

namespace impinge {
namespace {

/// The face of the hull over whose plane x is highest, and how far.
std::pair<std::size_t, double> highest_face(const ConvexPolyhedron& hull, const Vec3& x) {
  std::pair<std::size_t, double> highest{0, -INFINITY};
  for (std::size_t f = 0; f < hull.faces().size(); ++f) {
    const double height = hull.faces()[f].normal.dot(x) - hull.faces()[f].offset;
    if (height > highest.second) highest = {f, height};
  }
  return highest;
}

}  // namespace

void box_mesh(ContactSink& sink) {
  const OrientedBox box = world_box(sink.first());
  PolyhedronView solid;
  solid.frame = box;
  solid.surface = shape_of<Box>(sink.first()).polyhedron()->surface().get();
  // number: 0 to 5 for -z, +z, -y, +y, -x, +x as make_box_mesh lists them
  solid.face = [](int triangle) { return triangle / 2; };
  solid.place_on_face = [&](Candidate& c) {
    const int axis = 2 - c.index_first / 2;
    const Vec3 x = box.to_local(c.point_second);
    Vec3 foot = x.cwiseMax(-box.half).cwiseMin(box.half);
    foot[axis] = x[axis];
    const bool is_beside = (x - foot).norm() > 1e-9 * box.half.sum();
    // on the side as a whole, not on the triangle of it that was found first
    foot[axis] = c.index_first % 2 == 0 ? -box.half[axis] : box.half[axis];
    c.point_first = box.to_world(foot);
    return is_beside;
  };
  solid.touching.frame = {sink.first().pose, &shape_of<Box>(sink.first()),
                          [&](const Vec3& x) { return (x.cwiseAbs() - box.half).cwiseMax(0.0).norm(); }};
  solid.touching.outward = [&](const Vec3& x) { return shape_of<Box>(sink.first()).outward(x); };
  solid.touching.corners = shape_of<Box>(sink.first()).polyhedron()->vertices();
  polyhedron_against_mesh(sink, solid);
}

void hull_mesh(ContactSink& sink) {
  const ConvexSet& set = *std::get<const ConvexSet*>(sink.first().shape->form());
  const ConvexPolyhedron& hull = *set.polyhedron();
  const Pose& pose = sink.first().pose;
  const Aabb bounds = sink.first().shape->bounds({});
  PolyhedronView solid;
  solid.frame = {pose.apply(bounds.center()), pose.rotation, 0.5 * bounds.extent()};
  solid.surface = hull.surface().get();
  solid.face = [&](int triangle) { return hull.face_of_triangle(triangle); };
  solid.place_on_face = [&](Candidate& c) {
    const ConvexPolyhedron::Face& own = hull.faces()[c.index_first];
    const Vec3 x = pose.apply_inverse(c.point_second), foot = x - (own.normal.dot(x) - own.offset) * own.normal;
    for (const ConvexPolyhedron::Face& face : hull.faces())
      if (face.normal.dot(foot) > face.offset + 1e-9 * hull.size()) return true;
    c.point_first = pose.apply(foot);
    return false;
  };
  solid.touching.frame = {pose, &set, [&](const Vec3& x) { return highest_face(hull, x).second; }};
  solid.touching.outward = [&](const Vec3& x) { return hull.faces()[highest_face(hull, x).first].normal; };
  solid.touching.corners = hull.vertices();
  polyhedron_against_mesh(sink, solid);
}

}  // namespace impinge
