// Sphere and capsule against a mesh.
#include <algorithm>
#include <cmath>
#include <limits>

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
      : sink_(sink),
        mesh_(mesh),
        axis_(world_axis(sink.first())),
        radius_(shape_of<Capsule>(sink.first()).radius),
        touch_(1e-9 * radius_ +
               1e-12 * std::max(largest_coordinate(sink.first().bounds), largest_coordinate(sink.second().bounds))) {
    near_ = triangles_seen_from(sink.second(), axis_.p0, axis_.p1, radius_ + sink.reach());
  }

  void add_edges() {
    for (int e : edges_of(near_)) {
      const SegmentSegment s = closest(e);
      if (!s.interior || !is_within(s.squared_distance)) continue;
      const std::optional<EdgeCone> cone = make_edge_cone(mesh_, e);
      if (!cone) continue;
      const Vec3 n = is_touching(s.squared_distance) ? out_of(*cone) : Vec3((s.point0 - s.point1).normalized());
      if (cone->is_outward(n)) add(s.point0, s.point1, n, {Feature::edge, e});
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
      mesh_.star({Feature::vertex, v}, star);
      const Vec3 normal = mesh_.normal({Feature::vertex, v});
      if (is_touching(s.squared_distance)) {
        const std::optional<Vec3> n = way_across(axis_.p1 - axis_.p0, star);
        if (n && n->dot(normal) > 0.0) add(s.point, mesh_.vertex(v), *n, {Feature::vertex, v});
        continue;
      }
      const Vec3 n = (s.point - mesh_.vertex(v)).normalized();
      double highest = -1.0, lowest = 1.0;
      for (const Vec3& e : star) {
        highest = std::max(highest, e.dot(n));
        lowest = std::min(lowest, e.dot(n));
      }
      // a peak: the surface falls away from it, and not only by rounding (in a flat the caps and the rims carry)
      if (highest <= 1e-9 && lowest < -1e-5 && n.dot(normal) > 0.0)
        add(s.point, mesh_.vertex(v), n, {Feature::vertex, v});
    }
  }

  /// Both caps are outside: where the axis passes through the body, out of each passage.
  void add_passages() {
    const std::vector<Crossing> crossings = find_crossings();
    int number = 2;
    for (std::size_t i = 0; i + 1 < crossings.size(); ++i)
      if (is_passage(crossings[i], crossings[i + 1])) add_passage(crossings[i].t, crossings[i + 1].t, number++);
  }

 private:
  /// Where the axis passes through the surface.
  struct Crossing {
    double t = 0.0;
    bool enters = false, leaves = false;  ///< both where it only touches an edge, or does so first or last
  };

  Vec3 at(double t) const { return axis_.p0 + t * (axis_.p1 - axis_.p0); }

  std::vector<int> edges_of(const std::vector<int>& triangles) const {
    std::vector<int> edges;
    for (int t : triangles) edges.insert(edges.end(), mesh_.triangle_edges(t).begin(), mesh_.triangle_edges(t).end());
    sort_unique(edges);
    return edges;
  }

  SegmentSegment closest(int e) const {
    const MeshTopology::Edge& ends = mesh_.edge(e);
    return closest_between_segments(axis_.p0, axis_.p1, mesh_.vertex(ends.v0), mesh_.vertex(ends.v1));
  }

  /// Of the two directions across both the axis and an edge that isn't parallel to it the one out of the edge's body.
  Vec3 out_of(const EdgeCone& edge) const {
    const Vec3 n = (axis_.p1 - axis_.p0).cross(edge.q - edge.p).stableNormalized();
    return n.dot(edge.normal) < 0.0 ? Vec3(-n) : n;
  }

  Aabb axis_box(double margin) const {
    Aabb box;
    box.include(axis_.p0);
    box.include(axis_.p1);
    return box.inflated(margin);
  }

  /// In order. Joints of triangles belong to all of them, so that none is missed between two.
  std::vector<Crossing> find_crossings() const {
    constexpr double kSlack = 1e-9;  // of a triangle
    const Vec3 d = axis_.p1 - axis_.p0;
    std::vector<Crossing> hits, crossings;
    for (int t : triangles_near(sink_.second(), axis_box(1e-6 * radius_)))
      if (const std::optional<RayHit> hit = intersect_line(axis_.p0, d, mesh_.corners(t), kSlack);
          hit && hit->t > 0.0 && hit->t < 1.0) {
        const bool leaves = mesh_.face_normal(t).dot(d) > 0.0;
        hits.push_back({hit->t, !leaves, leaves});
      }
    std::sort(hits.begin(), hits.end(),
              [](const Crossing& l, const Crossing& r) { return l.t != r.t ? l.t < r.t : l.leaves < r.leaves; });
    for (const Crossing& hit : hits)
      if (!crossings.empty() && (hit.t - crossings.back().t) * d.norm() <= touch_) {
        crossings.back().enters |= hit.enters;
        crossings.back().leaves |= hit.leaves;
      } else {
        crossings.push_back(hit);
      }
    return crossings;
  }

  bool is_passage(const Crossing& in, const Crossing& out) const {
    if (!in.enters || !out.leaves) return false;
    return (!in.leaves && !out.enters) || way_out(sink_, mesh_, at(0.5 * (in.t + out.t))).has_value();
  }

  /// Across the ridge that the axis passes under, if there is one within the radius and it is the shorter way; else out as
  /// a ball. That stands a quarter from the end of the passage where less of the capsule sticks out; the middle could
  /// not tell the ends apart.
  void add_passage(double in, double out, int number) {
    const double t = in < 1.0 - out ? in + 0.25 * (out - in) : out - 0.25 * (out - in);
    double least = 0.0;
    if (const std::optional<Collision> as_ball = way_out(sink_, mesh_, at(t)))
      least = std::min(radius_, as_ball->normal.dot(as_ball->point_b) -
                                    std::min(as_ball->normal.dot(axis_.p0), as_ball->normal.dot(axis_.p1)));
    int ridge = -1;
    SegmentSegment under;
    Vec3 normal = Vec3::Zero();
    for (int e : edges_of(triangles_near(sink_.second(), axis_box(radius_)))) {
      const SegmentSegment s = closest(e);
      if (!s.interior || !(s.s > in && s.s < out)) continue;
      const std::optional<EdgeCone> cone = make_edge_cone(mesh_, e);
      if (!cone) continue;
      const Vec3 n = out_of(*cone);
      const double depth = n.dot(s.point1 - s.point0);
      if (depth <= touch_ || depth >= least || !cone->is_outward(n)) continue;
      ridge = e, under = s, normal = n, least = depth;
    }
    if (ridge >= 0)
      add(under.point0, under.point1, normal, {Feature::edge, ridge});
    else
      add_ball_contacts(sink_, mesh_, {at(t), radius_, Feature::face, number});
  }

  bool is_within(double squared_distance) const {
    const double limit = radius_ + sink_.reach();
    return squared_distance <= limit * limit;
  }
  /// Nearer, the direction from the mesh to the axis is rounding.
  bool is_touching(double squared_distance) const { return squared_distance <= touch_ * touch_; }

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
  double touch_;  ///< metres
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
  const bool inside0 = add_ball_contacts(sink, mesh, {axis.p0, radius, Feature::vertex, 0, axis.p1 - axis.p0});
  const bool inside1 = add_ball_contacts(sink, mesh, {axis.p1, radius, Feature::vertex, 1, axis.p0 - axis.p1});
  CylinderTest cylinder(sink, mesh);
  cylinder.add_edges();
  cylinder.add_vertices();
  if (!inside0 && !inside1) cylinder.add_passages();
}

}  // namespace impinge
