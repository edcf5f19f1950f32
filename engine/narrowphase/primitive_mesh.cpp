// Sphere, capsule and box against a mesh.
#include <algorithm>
#include <cmath>

#include "engine/geometry/triangle_intersection.hpp"
#include "engine/narrowphase/ball_against_mesh.hpp"
#include "engine/narrowphase/contact_points.hpp"
#include "engine/narrowphase/edge_cone.hpp"
#include "engine/narrowphase/primitive_pairs.hpp"
#include "engine/narrowphase/triangle_pair_test.hpp"

namespace impinge {
namespace {

/// Bodies of these local pairs: 0 the sink's first shape, 1 the mesh.
SurfaceView view_of(const ContactSink& sink) { return SurfaceView(sink.second(), 1); }

std::vector<int> triangles_near(const SurfaceView& mesh, int count, const Aabb& box) {
  std::vector<int> near;
  for (int t = 0; t < count; ++t)
    if (overlap(triangle_bounds(mesh, t), box)) near.push_back(t);
  return near;
}

void sort_unique(std::vector<int>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

/// The cylinder of a capsule against the mesh's ridges and peaks; its caps are balls.
class CylinderTest {
 public:
  CylinderTest(ContactSink& sink, const SurfaceView& mesh)
      : sink_(sink), mesh_(mesh), axis_(world_axis(sink.first())), radius_(std::get<Capsule>(*sink.first().shape).radius) {
    Aabb box;
    box.include(axis_.p0);
    box.include(axis_.p1);
    const int count = static_cast<int>(sink.second().mesh().mesh.triangles.size());
    near_ = triangles_near(mesh, count, box.inflated(radius_ + sink.reach()));
  }

  void add_edges() {
    std::vector<int> edges;
    for (int t : near_) edges.insert(edges.end(), mesh_.triangle_edges(t).begin(), mesh_.triangle_edges(t).end());
    sort_unique(edges);
    for (int e : edges) {
      const MeshTopology::Edge& ends = mesh_.edge(e);
      const SegmentSegment s = closest_between_segments(axis_.p0, axis_.p1, mesh_.vertex(ends.v0), mesh_.vertex(ends.v1));
      if (!s.interior || !is_within(s.squared_distance)) continue;
      const std::optional<EdgeCone> cone = make_edge_cone(mesh_, e);
      const Vec3 n = (s.point0 - s.point1) / std::sqrt(s.squared_distance);
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
      const Vec3 n = (s.point - mesh_.vertex(v)) / std::sqrt(s.squared_distance);
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

  /// Both caps are outside: where the axis passes through the body, out of each passage. The ball that is pushed stands a
  /// quarter from the end of the passage where less of the capsule sticks out; the middle could not tell the ends apart.
  void add_passages() {
    const Vec3 d = axis_.p1 - axis_.p0;
    std::vector<std::pair<double, bool>> crossings;  // parameter, leaves the body
    for (int t : near_)
      if (const std::optional<RayHit> hit = intersect_line(axis_.p0, d, mesh_.corners(t)); hit && hit->t > 0.0 && hit->t < 1.0)
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

constexpr std::uint64_t kIndex = 0x3fffffffu;  // of a feature key: the index's bits

/// A feature key whose first feature is of the box's triangles, in terms of the box: the two triangles of a side and the
/// diagonal between them are one face (number: 0 to 5 for -z, +z, -y, +y, -x, +x as make_box_mesh lists them), so that no contact changes its name when it crosses the diagonal.
std::uint64_t with_box_feature(std::uint64_t key, const MeshTopology& box) {
  Feature kind = static_cast<Feature>(key >> 62);
  int index = static_cast<int>(key >> 32 & kIndex);
  if (kind == Feature::edge && box.edges[index].triangle0 / 2 == box.edges[index].triangle1 / 2) {
    kind = Feature::face;
    index = box.edges[index].triangle0;
  }
  if (kind == Feature::face) index /= 2;
  return feature_key(kind, index, static_cast<Feature>(key >> 30 & 3u), static_cast<int>(key & kIndex));
}

/// A box wholly inside a mesh, where no triangles are near each other: out along the shortest way from its centre.
void add_enclosed_box(ContactSink& sink, const SurfaceView& mesh) {
  const OrientedBox box = world_box(sink.first());
  ContactQuery all = sink.query();
  all.activation = 0.0;
  all.time_step = 0.0;
  const Collider local[2] = {sink.first(), sink.second()};
  std::vector<Collision> out;
  ContactSink way_out(local, {0, 1, 0.0}, false, all, out);
  if (!add_ball_contacts(way_out, mesh, {box.center, 0.0, Feature::shape, 0})) return;
  for (const Collision& found : out) {
    Candidate c;
    c.normal = found.normal;
    c.point_first = box.center - box.radius_along(found.normal) * found.normal;
    c.point_second = found.point_b;
    c.triangle_second = found.triangle_b;
    c.kind_second = Feature::face;
    c.index_second = found.triangle_b;
    sink.add(c);
  }
}

}  // namespace

void sphere_mesh(ContactSink& sink) {
  add_ball_contacts(sink, view_of(sink), {sink.first().pose.position, std::get<Sphere>(*sink.first().shape).radius, Feature::shape, 0});
}

void capsule_mesh(ContactSink& sink) {
  const SurfaceView mesh = view_of(sink);
  const WorldSegment axis = world_axis(sink.first());
  const double radius = std::get<Capsule>(*sink.first().shape).radius;
  const bool inside0 = add_ball_contacts(sink, mesh, {axis.p0, radius, Feature::vertex, 0});
  const bool inside1 = add_ball_contacts(sink, mesh, {axis.p1, radius, Feature::vertex, 1});
  CylinderTest cylinder(sink, mesh);
  cylinder.add_edges();
  cylinder.add_vertices();
  if (!inside0 && !inside1) cylinder.add_passages();
}

void box_mesh(ContactSink& sink) {
  // a box is a polyhedron: the contacts of two meshes, one of which has twelve triangles
  const Collider& mesh = sink.second();
  const ContactQuery& query = sink.query();
  Collider box = sink.first();
  const Shape surface = make_box_mesh(std::get<Box>(*box.shape).half);
  std::vector<Vec3> corners;
  for (const Vec3& v : std::get<MeshPointer>(surface)->mesh.vertices) corners.push_back(box.pose.apply(v));
  box.shape = &surface;
  box.vertices = corners;
  box.mean_edge = mean_edge_length(box.mesh().mesh);
  const Collider local[2] = {box, mesh};

  // as for two meshes, fast bodies widen the search by one edge length at most
  const double margin = query.activation + std::min(sink.reach(), std::max(box.mean_edge, mesh.mean_edge));
  const BodyPair pair{0, 1, margin};
  const SurfaceView view(local[1], 1);
  Aabb bounds;
  for (const Vec3& v : corners) bounds.include(v);
  const OrientedBox oriented = world_box(sink.first());
  std::vector<TrianglePair> triangles;
  const int count = static_cast<int>(mesh.mesh().mesh.triangles.size());
  for (int t : triangles_near(view, count, bounds.inflated(margin * (1.0 + 1e-9) + touch_distance(corners_of(box, 0))))) {
    const TriangleCorners c = corners_of(mesh, t);
    const Aabb turned = bounds_of(oriented.to_local(c[0]), oriented.to_local(c[1]), oriented.to_local(c[2]));
    const Vec3 reach = oriented.half + Vec3::Constant(margin * (1.0 + 1e-9) + 4.0 * touch_distance(c));
    if (!overlap(turned, Aabb{-reach, reach})) continue;
    for (int k = 0; k < 12; ++k) {
      const PairState state = test_triangles(corners_of(box, k), c, margin);
      if (state != PairState::apart) triangles.push_back({0, 1, k, t, state == PairState::intersecting});
    }
  }
  std::sort(triangles.begin(), triangles.end());
  std::vector<Collision> found;
  // asked for intersections only, the sink keeps what overlaps
  proximity_contacts(local, pair, triangles, query.activation, query.proximity ? query.time_step : 0.0, found);
  const MeshTopology& topology = box.mesh().topology;
  for (Collision& f : found) f.feature = with_box_feature(f.feature, topology);
  std::stable_sort(found.begin(), found.end(), [](const Collision& l, const Collision& r) { return l.feature < r.feature; });
  for (const Collision& f : found) {
    Candidate c;
    c.point_first = f.point_a;
    c.point_second = f.point_b;
    c.normal = f.normal;
    c.owner = f.normal_owner == 0 ? NormalOwner::first : f.normal_owner == 1 ? NormalOwner::second : NormalOwner::neither;
    c.kind_first = static_cast<Feature>(f.feature >> 62);
    c.index_first = static_cast<int>(f.feature >> 32 & kIndex);
    c.kind_second = static_cast<Feature>(f.feature >> 30 & 3u);
    c.index_second = static_cast<int>(f.feature & kIndex);
    c.triangle_second = f.triangle_b;
    if (c.kind_first == Feature::face && f.normal_owner == 0) {
      // on the side as a whole, not on the triangle of it that was found first
      const int axis = 2 - c.index_first / 2;
      Vec3 x = oriented.to_local(c.point_second).cwiseMax(-oriented.half).cwiseMin(oriented.half);
      x[axis] = c.index_first % 2 == 0 ? -oriented.half[axis] : oriented.half[axis];
      c.point_first = oriented.to_world(x);
    }
    sink.add_new(c);
  }
  if (triangles.empty()) add_enclosed_box(sink, view);
}

}  // namespace impinge
