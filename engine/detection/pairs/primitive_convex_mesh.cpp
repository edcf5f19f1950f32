// A convex solid with a curved surface against a mesh. Its contacts are local minima of the distance of the two
// surfaces, seen from each feature of the mesh: below a face lies the solid's farthest point against the face's normal
// (with the corners of what it rests on there); an edge or a corner that stands out of the mesh is a segment or a point
// against the solid, and its direction has to leave the mesh there.
#include <algorithm>
#include <cmath>

#include "engine/detection/contacts/contact_points.hpp"
#include "engine/detection/contacts/edge_cone.hpp"
#include "engine/detection/pairs/ball_against_mesh.hpp"
#include "engine/detection/pairs/convex_manifold.hpp"
#include "engine/detection/pairs/polyhedron_mesh.hpp"
#include "engine/detection/pairs/primitive_pairs.hpp"
#include "engine/detection/pairs/touched_triangles.hpp"
#include "engine/detection/pairs/way_apart.hpp"
#include "engine/geometry/convex/convex_point.hpp"
#include "engine/geometry/triangle_intersection.hpp"

namespace impinge {
namespace {

/// A way out of the mesh counts if nothing else of its surface is nearer than this part of its depth.
constexpr double kNearestExit = 0.5;

/// The way to the solid is known well enough where it is this part of its size away; then what rises by this sine does.
constexpr double kOutside = 1e-5, kSlopes = 1e-3;

class Segment final : public ConvexSet {
 public:
  Segment(const Vec3& p, const Vec3& q) : p_(p), q_(q) {}
  Vec3 support(const Vec3& d) const override { return d.dot(q_ - p_) > 0.0 ? q_ : p_; }
  ContactFace facing(const Vec3& d) const override {
    const Vec3 along = q_ - p_;
    ContactFace face;
    face.add(support(d));
    if (std::abs(along.dot(d)) < 0.25 * along.norm()) {
      face.count = 0;
      face.add(p_);
      face.add(q_);
    }
    return face;
  }

 private:
  Vec3 p_, q_;
};

class CurvedTest {
 public:
  explicit CurvedTest(ContactSink& sink)
      : sink_(sink),
        mesh_(sink.second(), 1),
        solid_{std::get<const ConvexSet*>(sink.first().shape->form()), sink.first().pose},
        bounds_(sink.first().bounds),
        touch_(1e-9 * (bounds_.extent().norm() + sink.second().mean_edge)),
        around_(bounds_.inflated(sink.reach() + touch_)),
        near_(triangles_in_reach()) {}

  void run() {
    for (int t : near_) add_face(t);
    if (is_deep_ && !is_near_all_) {
      near_ = all_triangles();
      found_.clear();
      for (int t : near_) add_face(t);
    }
    add_tips();
    add_edges();
    add_corners();
    look_ahead();
    const auto is_within = [&](const Candidate& c) { return gap_of(c) <= sink_.reach(); };
    if ((std::none_of(found_.begin(), found_.end(), is_within) || only_touches()) && !leave()) part();
    for (const Candidate& c : found_) sink_.add_new(c);
  }

 private:
  Vec3 center() const { return solid_.pose.position; }

  /// Those that it may have contacts with: of the ones round it those in reach, of these the ones it may touch, unless it
  /// is inside the mesh and has to find a way out of it.
  std::vector<int> triangles_in_reach() {
    if (mesh_.is_deforming() || way_out(sink_, mesh_, center())) return all_triangles();
    const Shape& shape = *sink_.first().shape;
    TouchingSolid solid;
    solid.frame = {solid_.pose, solid_.set, [&](const Vec3& x) { return shape.signed_distance(x); }};
    solid.outward = [&](const Vec3& x) { return shape.outward(x); };
    const double reach = sink_.reach() + touch_;
    TouchedTriangles touched =
        touched_triangles(sink_.second(), around_, solid, touch_limits(sink_, reach), relative_motion(sink_));
    is_shallow_ = !touched.is_all;
    return touched.triangles;
  }
  std::vector<int> all_triangles() {
    is_near_all_ = true;
    return triangles_near(sink_.second(), around_);
  }

  Vec3 farthest(const Vec3& direction) const {
    const Vec3 local = solid_.pose.rotation.transpose() * direction;
    return solid_.pose.apply(solid_.set->support(local) + solid_.set->rounding() * local);
  }
  bool is_in_reach(const Vec3& point) const {
    const double limit = sink_.first().shape->bounding_radius() + sink_.reach();
    return (point - center()).squaredNorm() <= limit * limit;
  }

  /// Unless there is one at the same place: a point over the border of two triangles in one plane.
  void keep(const Candidate& c) {
    const auto is_same = [&](const Candidate& k) {
      return k.normal.dot(c.normal) > 1.0 - 1e-9 && (k.point_first - c.point_first).norm() <= touch_;
    };
    if (std::none_of(found_.begin(), found_.end(), is_same)) found_.push_back(c);
  }

  /// Where the solid is lowest over the face, and the corners of what it rests on.
  void add_face(int t) {
    const Vec3 n = mesh_.face_normal(t);
    if (n.isZero(0.0)) return;
    const TriangleCorners corners = mesh_.corners(t);
    const auto height = [&](const Vec3& x) { return n.dot(x - corners[0]); };
    const Vec3 lowest = farthest(-n);
    if (height(lowest) > sink_.reach()) return;
    is_deep_ = is_deep_ || (!is_shallow_ && height(lowest) < -sink_.reach());  // a foot of it may then be out of reach
    std::vector<Candidate> points;
    const auto try_point = [&](const Vec3& x, Feature kind, int index) {
      const double h = height(x);
      const Vec3 foot = x - h * n;
      if (h > sink_.reach() || closest_on_triangle(foot, corners).squared_distance > touch_ * touch_) return;
      Candidate c;
      c.normal = n;
      c.point_first = x;
      c.point_second = foot;
      c.owner = NormalOwner::second;
      c.kind_first = kind;
      c.index_first = index;
      c.kind_second = Feature::face;
      c.index_second = c.triangle_second = t;
      points.push_back(c);
    };
    const ContactFace face = world_face(solid_.set->facing(solid_.pose.rotation.transpose() * -n), solid_.pose);
    double least = 1e300;
    for (int i = 0; i < face.count && face.count > 1; ++i) {
      try_point(face.point[i], Feature::vertex, face.vertex[i]);
      least = std::min(least, height(face.point[i]));
    }
    if (least > height(lowest) + touch_) try_point(lowest, Feature::shape, 0);
    // a solid may be far behind the plane of a face it has nothing to do with; its points in front of it are
    const auto depth = [&](const Candidate& c) { return c.normal.dot(c.point_first - c.point_second); };
    if (height(lowest) < -touch_ && std::none_of(points.begin(), points.end(), [&](const Candidate& c) {
          return is_way_out(c.point_first, depth(c));
        }))
      std::erase_if(points, [&](const Candidate& c) { return depth(c) < -touch_; });
    for (const Candidate& c : points) keep(c);
  }

  /// Whether a point at a height below a face is inside the mesh, and that face about the nearest way out.
  bool is_way_out(const Vec3& x, double height) const {
    if (height >= -touch_) return false;
    double nearest_sq = 1e300;
    Vec3 point = Vec3::Zero();
    SurfaceFeature feature;
    for (int t : nearest_to(x)) {
      const PointTriangle p = closest_on_triangle(x, mesh_.corners(t));
      if (p.squared_distance >= nearest_sq) continue;
      nearest_sq = p.squared_distance;
      point = p.point;
      feature = mesh_.feature(t, p.feature);
    }
    return (x - point).dot(mesh_.normal(feature)) < 0.0 && std::sqrt(nearest_sq) >= -kNearestExit * height;
  }

  /// Triangles round the solid among which the nearest of them to x is.
  std::vector<int> nearest_to(const Vec3& x) const {
    if (is_near_all_) return near_;
    std::vector<int> nearest = triangles_round(sink_.second(), x, 0.0, true);
    std::erase_if(nearest, [&](int t) { return !overlap(triangle_bounds(mesh_, t), around_); });
    return nearest.empty() ? triangles_near(sink_.second(), around_) : nearest;
  }

  /// Where the solid ends in a point that is inside: in a dent, as it makes one in what bends, it is below no face, and
  /// nothing stands out of the mesh there.
  void add_tips() {
    int index = 0;
    for (const Vec3& tip : solid_.set->tips()) {
      const std::optional<Collision> way = way_out(sink_, mesh_, solid_.pose.apply(tip));
      const int own = index++;
      if (!way || -way->gap <= touch_) continue;
      const FeaturePair features = features_of_key(way->feature);
      if (features.kind_b == Feature::face) continue;  // it has that one
      Candidate c;
      c.normal = way->normal;
      c.point_first = way->point_a;
      c.point_second = way->point_b;
      c.kind_first = Feature::vertex;
      c.index_first = own;
      c.kind_second = features.kind_b;
      c.index_second = features.index_b;
      c.triangle_second = way->triangle_b;
      keep(c);
    }
  }

  /// From a point of the mesh to the solid, unit, where it is outside of it for certain.
  std::optional<Vec3> way_to_solid(const Vec3& x) const {
    const Shape& shape = *sink_.first().shape;
    const Vec3 local = solid_.pose.apply_inverse(x), out = shape.outward(local);
    const double height = out.dot(solid_.set->support(out)) + solid_.set->rounding();
    if (!(out.dot(local) - height > kOutside * shape.size())) return std::nullopt;
    return product(solid_.pose.rotation, Vec3(-out));
  }

  /// Whether one end of the edge is nearest to the solid, by far, and what comes from there leaves the mesh elsewhere: the
  /// same as may_leave says no to, told without a search.
  bool leaves_elsewhere(EdgeCone cone) const {
    const Vec3 along = (cone.q - cone.p).normalized();
    std::optional<Vec3> way = way_to_solid(cone.p);
    if (!way || way->dot(along) > -kSlopes) {  // of the distance, towards the other end
      way = way_to_solid(cone.q);
      if (!way || way->dot(along) < kSlopes) return false;
    }
    cone.slack += kSlopes;
    if (cone.is_outward(*way)) return false;
    const ContactFace face = solid_.set->facing(solid_.pose.rotation.transpose() * -*way);
    return face.count < 3 || !cone.is_outward(-(solid_.pose.rotation * face.normal));
  }

  /// Whether any candidate of the edge may leave the mesh between its faces: their normals are the gap's, or of the flat
  /// side that the solid turns to it.
  bool may_leave(const EdgeCone& cone, const ConvexGap& gap) const {
    if (!gap.is_within_reach) return false;
    if (cone.is_outward(gap.normal)) return true;
    const ContactFace face = solid_.set->facing(solid_.pose.rotation.transpose() * -gap.normal);
    return face.count > 2 && cone.is_outward(-(solid_.pose.rotation * face.normal));
  }

  /// Edges that stand out, each as a segment.
  void add_edges() {
    std::vector<int> edges;
    for (int t : near_) edges.insert(edges.end(), mesh_.triangle_edges(t).begin(), mesh_.triangle_edges(t).end());
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    for (int e : edges) {
      const Vec3 &p = mesh_.vertex(mesh_.edge(e).v0), &q = mesh_.vertex(mesh_.edge(e).v1);
      if (!is_in_reach(closest_on_segment(center(), p, q).point)) continue;
      const std::optional<EdgeCone> cone = make_edge_cone(mesh_, e);
      if (!cone || leaves_elsewhere(*cone)) continue;
      const Vec3 middle = 0.5 * (p + q);
      const Segment segment(p - middle, q - middle);
      const PlacedConvex placed{&segment, {Mat3::Identity(), middle}};
      if (!may_leave(*cone, convex_gap(solid_, placed, sink_.reach()))) continue;
      for (Candidate c : convex_candidates(solid_, placed, sink_.reach())) {
        const double t = closest_on_segment(c.point_second, p, q).t;
        // an end is a corner's, and what leaves into a face is that face's
        if (t <= 0.0 || t >= 1.0 || !cone->is_outward(c.normal)) continue;
        const int place = c.kind_second == Feature::vertex ? c.index_second : 2;
        c.kind_second = Feature::edge;
        c.index_second = e;
        c.index_first += 4096 * place;  // two points on one edge have two names
        c.triangle_second = mesh_.edge(e).triangle0;
        c.owner = c.owner == NormalOwner::first ? NormalOwner::first : NormalOwner::neither;
        keep(c);
      }
    }
  }

  /// Corners that stand out, each as a point.
  void add_corners() {
    std::vector<int> corners;
    for (int t : near_) corners.insert(corners.end(), mesh_.triangle(t).begin(), mesh_.triangle(t).end());
    std::sort(corners.begin(), corners.end());
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    const ConvexPoint point;
    std::vector<Vec3> star;
    for (int v : corners) {
      if (!is_in_reach(mesh_.vertex(v))) continue;
      mesh_.star({Feature::vertex, v}, star);
      if (const std::optional<Vec3> way = way_to_solid(mesh_.vertex(v)))
        if (std::any_of(star.begin(), star.end(), [&](const Vec3& e) { return e.dot(*way) > kSlopes; })) continue;
      const ConvexGap gap = convex_gap(solid_, {&point, {Mat3::Identity(), mesh_.vertex(v)}}, sink_.reach());
      if (!gap.is_within_reach) continue;
      double highest = -1.0, lowest = 1.0;
      for (const Vec3& e : star) {
        highest = std::max(highest, e.dot(gap.normal));
        lowest = std::min(lowest, e.dot(gap.normal));
      }
      // a peak: the surface falls away from it, and not only by rounding
      if (highest > 1e-9 || lowest >= -1e-5 || gap.normal.dot(mesh_.normal({Feature::vertex, v})) <= 0.0) continue;
      Candidate c;
      c.normal = gap.normal;
      c.point_first = gap.point_a;
      c.point_second = mesh_.vertex(v);
      c.kind_second = Feature::vertex;
      c.index_second = v;
      c.triangle_second = mesh_.triangle_of({Feature::vertex, v});
      keep(c);
    }
  }

  /// A solid that crosses in one step what it isn't near yet: the plane of the triangle that its foremost point meets.
  void look_ahead() {
    const ContactQuery& query = sink_.query();
    if (!query.proximity || !(query.time_step > 0.0)) return;
    const Vec3 way = query.time_step * (sink_.first().velocity_at(center()) - sink_.second().velocity_at(center()));
    if (way.norm() <= query.activation) return;
    for (const Vec3& from : {center(), farthest(way.normalized())}) {
      double first = 1.0;
      int hit = -1;
      Aabb swept;
      swept.include(from);
      swept.include(from + way);
      for (int t : triangles_near(sink_.second(), swept.inflated(touch_))) {
        if (mesh_.face_normal(t).dot(way) >= 0.0) continue;
        const std::optional<RayHit> ray = intersect_line(from, way, mesh_.corners(t), 1e-9);
        if (!ray || ray->t < 0.0 || ray->t > first || (hit >= 0 && ray->t == first)) continue;
        first = ray->t;
        hit = t;
      }
      if (hit < 0) continue;
      const auto is_known = [&](const Candidate& c) { return c.triangle_second == hit; };
      if (std::any_of(found_.begin(), found_.end(), is_known)) continue;
      Candidate c;
      c.normal = mesh_.face_normal(hit);
      c.point_first = farthest(-c.normal);
      // the height over the plane, wherever the way crosses it
      c.point_second = c.point_first - c.normal.dot(c.point_first - mesh_.corners(hit)[0]) * c.normal;
      c.owner = NormalOwner::second;
      c.kind_second = Feature::face;
      c.index_second = c.triangle_second = hit;
      keep(c);
    }
  }

  /// What touches doesn't part the two: a corner exactly on a corner, from where the way out is anyone's.
  bool only_touches() const {
    const auto overlaps = [&](const Candidate& c) { return gap_of(c) < -touch_; };
    const auto is_below = [&](const Candidate& c) {
      return gap_of(c) <= touch_ && c.normal.dot(c.point_first - farthest(-c.normal)) > touch_;
    };
    return std::none_of(found_.begin(), found_.end(), overlaps) && std::any_of(found_.begin(), found_.end(), is_below);
  }

  bool leave() {
    return add_enclosed(sink_, center(), [&](const Vec3& n) { return (farthest(-n) - center()).dot(-n); });
  }

  void part() {
    if (const std::optional<Candidate> way = way_apart(mesh_, solid_, bounds_, all_triangles(), touch_)) keep(*way);
  }

  ContactSink& sink_;
  const SurfaceView mesh_;
  PlacedConvex solid_;
  Aabb bounds_;
  double touch_;  ///< metres: closer is the same place
  Aabb around_;   ///< how far it may have contacts
  bool is_near_all_ = false, is_deep_ = false;
  bool is_shallow_ = false;  ///< none of the surface is deeper in the solid than the activation distance
  std::vector<int> near_;    ///< of the triangles in that box those in reach, or all
  std::vector<Candidate> found_;
};

}  // namespace

void convex_mesh(ContactSink& sink) {
  if (std::get<const ConvexSet*>(sink.first().shape->form())->polyhedron() != nullptr)
    hull_mesh(sink);
  else
    CurvedTest(sink).run();
}

}  // namespace impinge
