// Sphere and capsule against a mesh.
#include <algorithm>
#include <cmath>

#include "engine/detection/contacts/edge_cone.hpp"
#include "engine/detection/pairs/ball_against_mesh.hpp"
#include "engine/detection/pairs/primitive_pairs.hpp"
#include "engine/detection/pairs/triangles_near.hpp"
#include "engine/geometry/triangle_intersection.hpp"

namespace impinge {
namespace {

/// Bodies of these local pairs: 0 the sink's first shape, 1 the mesh.
SurfaceView view_of(const ContactSink& sink) { return SurfaceView(sink.second(), 1); }

void sort_unique(std::vector<int>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

/// The cylinder of a capsule against the mesh's ridges and peaks; its caps are balls.
class CylinderTest {
 public:
  CylinderTest(ContactSink& sink, const SurfaceView& mesh)
      : sink_(sink), mesh_(mesh), axis_(world_axis(sink.first())), radius_(shape_of<Capsule>(sink.first()).radius) {
    near_ = triangles_seen_from(sink.second(), axis_.p0, axis_.p1, radius_ + sink.reach());
  }

  void add_edges() {
    std::vector<int> edges;
    for (int t : near_) edges.insert(edges.end(), mesh_.triangle_edges(t).begin(), mesh_.triangle_edges(t).end());
    sort_unique(edges);
    for (int e : edges) {
      const MeshTopology::Edge& ends = mesh_.edge(e);
      const SegmentSegment s =
          closest_between_segments(axis_.p0, axis_.p1, mesh_.vertex(ends.v0), mesh_.vertex(ends.v1));
      if (!s.interior || !is_within(s.squared_distance)) continue;
      const std::optional<EdgeCone> cone = make_edge_cone(mesh_, e);
      const Vec3 n = (s.point0 - s.point1).normalized();
      if (cone && cone->is_outward(n)) add(s.point0, s.point1, n, {Feature::edge, e});
    }
  }

  void add_vertices() {
    std::vector<int> vertices;
    for (int t : near_) vertices.insert(vertices.end(), mesh_.triangle(t).begin(), mesh_.triangle(t).end());
    sort_unique(vertices);
    std::vector<Vec3> star;
    for (int v : vertices) {
      const PointSegment s = closest_on_segment(mesh_.vertex(v), axis_.p0, axis_.p1);
      if (s.t <= 0.0 || s.t >= 1.0 || !is_within(s.squared_distance)) continue;
      const Vec3 n = (s.point - mesh_.vertex(v)).normalized();
      mesh_.star({Feature::vertex, v}, star);
      double highest = -1.0, lowest = 1.0;
      for (const Vec3& e : star) {
        highest = std::max(highest, e.dot(n));
        lowest = std::min(lowest, e.dot(n));
      }
      // a peak: the surface falls away from it, and not only by rounding (in a flat the caps and the rims carry)
      if (highest <= 1e-9 && lowest < -1e-5 && n.dot(mesh_.normal({Feature::vertex, v})) > 0.0)
        add(s.point, mesh_.vertex(v), n, {Feature::vertex, v});
    }
  }

  /// Both caps are outside: where the axis passes through the body, out of each passage. The ball that is pushed stands
  /// a quarter from the end of the passage where less of the capsule sticks out; the middle could not tell the ends
  /// apart.
  void add_passages() {
    const Vec3 d = axis_.p1 - axis_.p0;
    Aabb box;
    box.include(axis_.p0);
    box.include(axis_.p1);
    std::vector<std::pair<double, bool>> crossings;  // parameter, leaves the body
    for (int t : triangles_near(sink_.second(), box.inflated(1e-6 * radius_)))
      if (const std::optional<RayHit> hit = intersect_line(axis_.p0, d, mesh_.corners(t));
          hit && hit->t > 0.0 && hit->t < 1.0)
        crossings.emplace_back(hit->t, mesh_.face_normal(t).dot(d) > 0.0);
    std::sort(crossings.begin(), crossings.end());
    int passage = 2;
    for (std::size_t i = 0; i + 1 < crossings.size(); ++i)
      if (!crossings[i].second && crossings[i + 1].second) {
        const double in = crossings[i].first, out = crossings[i + 1].first;
        const double t = in < 1.0 - out ? in + 0.25 * (out - in) : out - 0.25 * (out - in);
        add_ball_contacts(sink_, mesh_, {axis_.p0 + t * d, radius_, Feature::face, passage++});
      }
  }

 private:
  bool is_within(double squared_distance) const {
    const double limit = radius_ + sink_.reach();
    return squared_distance <= limit * limit && squared_distance > 1e-18 * radius_ * radius_;
  }

  void add(const Vec3& on_axis, const Vec3& on_mesh, const Vec3& n, const SurfaceFeature& feature) {
    Candidate c;
    c.normal = n;
    c.point_first = on_axis - radius_ * n;
    c.point_second = on_mesh;
    c.kind_first = Feature::edge;
    c.kind_second = feature.kind;
    c.index_second = feature.index;
    c.triangle_second = mesh_.triangle_of(feature);
    sink_.add_new(c);
  }

  ContactSink& sink_;
  const SurfaceView& mesh_;
  WorldSegment axis_;
  double radius_;
  std::vector<int> near_;
};

}  // namespace

void sphere_mesh(ContactSink& sink) {
  add_ball_contacts(sink, view_of(sink),
                    {sink.first().pose.position, shape_of<Sphere>(sink.first()).radius, Feature::shape, 0});
}

void capsule_mesh(ContactSink& sink) {
  const SurfaceView mesh = view_of(sink);
  const WorldSegment axis = world_axis(sink.first());
  const double radius = shape_of<Capsule>(sink.first()).radius;
  const bool inside0 = add_ball_contacts(sink, mesh, {axis.p0, radius, Feature::vertex, 0});
  const bool inside1 = add_ball_contacts(sink, mesh, {axis.p1, radius, Feature::vertex, 1});
  CylinderTest cylinder(sink, mesh);
  cylinder.add_edges();
  cylinder.add_vertices();
  if (!inside0 && !inside1) cylinder.add_passages();
}

}  // namespace impinge
