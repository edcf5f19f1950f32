// Half-space against everything: the deepest points of the other shape, each by itself.
#include "engine/detection/pairs/primitive_pairs.hpp"

namespace impinge {
namespace {

/// The contact of point x of the second shape with the plane.
Candidate against_plane(const WorldPlane& plane, const Vec3& x) {
  Candidate c;
  c.point_second = x;
  c.point_first = x - plane.normal * (plane.normal.dot(x) - plane.offset);
  c.normal = -plane.normal;
  c.owner = NormalOwner::first;
  return c;
}

}  // namespace

void plane_sphere(ContactSink& sink) {
  const WorldPlane plane = world_plane(sink.first());
  const double radius = shape_of<Sphere>(sink.second()).radius;
  sink.add(against_plane(plane, sink.second().pose.position - radius * plane.normal));
}

void plane_box(ContactSink& sink) {
  const WorldPlane plane = world_plane(sink.first());
  const OrientedBox box = world_box(sink.second());
  for (int i = 0; i < 8; ++i) {
    Candidate c = against_plane(plane, box.corner(i));
    c.kind_second = Feature::vertex;
    c.index_second = i;
    sink.add(c);
  }
}

void plane_capsule(ContactSink& sink) {
  const WorldPlane plane = world_plane(sink.first());
  const WorldSegment axis = world_axis(sink.second());
  const double radius = shape_of<Capsule>(sink.second()).radius;
  for (int i = 0; i < 2; ++i) {
    Candidate c = against_plane(plane, (i == 0 ? axis.p0 : axis.p1) - radius * plane.normal);
    c.kind_second = Feature::vertex;
    c.index_second = i;
    sink.add(c);
  }
}

void plane_mesh(ContactSink& sink) {
  const WorldPlane plane = world_plane(sink.first());
  const Collider& mesh = sink.second();
  const MeshTopology& topology = mesh.mesh().topology;
  const double bound = plane.offset + sink.reach();
  for (int v = 0; v < static_cast<int>(mesh.vertices.size()); ++v) {
    if (plane.normal.dot(mesh.vertices[v]) > bound) continue;
    const int begin = topology.vertex_triangle_begin[v];
    if (begin == topology.vertex_triangle_begin[v + 1]) continue;  // no triangle: not on the surface
    Candidate c = against_plane(plane, mesh.vertices[v]);
    c.kind_second = Feature::vertex;
    c.index_second = v;
    c.triangle_second = topology.vertex_triangles[begin];
    sink.add(c);
  }
}

}  // namespace impinge
