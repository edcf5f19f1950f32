#include "engine/detection/pairs/touched_triangles.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <deque>
#include <limits>

#include "engine/geometry/convex/convex_gap.hpp"
#include "engine/geometry/convex/convex_polyhedron.hpp"
#include "engine/geometry/convex/convex_triangle.hpp"
#include "engine/geometry/distance.hpp"
#include "engine/geometry/surface/disc_search.hpp"

namespace impinge {
namespace {

constexpr std::size_t kFew = 64;  // triangles: leaving some out costs more than they do
constexpr std::size_t kAny = std::numeric_limits<std::size_t>::max();
constexpr double kSameDirection = 1.0 - 1e-12;
constexpr double kOfFold = 0.25;    // of the angle between faces: so much higher may be what lies round a peak
constexpr double kRounding = 1e-6;  // of a direction that is found by differences

/// Answers of the last questions about vertices or edges, which several triangles share.
class Remembered {
 public:
  template <class Answer>
  bool get(int index, Answer&& answer) {
    Entry& entry = entries_[static_cast<std::size_t>(index) % entries_.size()];
    if (entry.index != index) entry = {index, answer()};
    return entry.is_so;
  }

 private:
  struct Entry {
    int index = -1;
    bool is_so = false;
  };
  std::array<Entry, 256> entries_;
};

/// A flat side of the solid, and how far what is in front of it is from its border.
class FlatSide {
 public:
  explicit FlatSide(const ContactFace& of) : face(of.face), normal(of.normal), offset_(normal.dot(of.point[0])) {
    for (int i = 0; i < of.count; ++i) {
      const Vec3 &p = of.point[i], side = of.point[(i + 1) % of.count] - p;
      const Vec3 inward = normal.cross(side).normalized();
      borders_.push_back({inward, inward.dot(p)});
    }
  }
  /// Whether all within `inside` of x lies over or under the face, no deeper than `depth`.
  bool is_below(const Vec3& x, double inside, double depth) const {
    if (normal.dot(x) - offset_ < -depth) return false;
    return std::none_of(borders_.begin(), borders_.end(),
                        [&](const Border& b) { return b.inward.dot(x) - b.offset < inside; });
  }
  int face;
  Vec3 normal;

 private:
  struct Border {
    Vec3 inward;
    double offset;
  };
  double offset_;
  std::vector<Border> borders_;
};

/// One walk down the discs of the mesh, everything in the solid's frame.
class Walk {
 public:
  Walk(const Collider& mesh, const TouchingSolid& solid, const TouchLimits& limits, const RelativeMotion& motion)
      : mesh_(mesh),
        solid_(solid),
        discs_(mesh.mesh().discs()),
        cones_(normal_cones(mesh.mesh())),
        to_solid_{solid.frame.pose.rotation.transpose() * mesh.pose.rotation,
                  solid.frame.pose.apply_inverse(mesh.pose.position)},
        reach_(limits.reach),
        depth_(limits.activation),
        limits_(limits),
        motion_(motion),
        turn_(motion.turn.norm()),
        box_(solid.frame.box()),
        polyhedron_(solid.frame.set->polyhedron()) {}

  std::vector<int> run() {
    return search_discs(discs_,
                        [&](const PlacedDisc& disc, int level, int j, int k) { return meets(disc, level, j, k); });
  }
  bool is_deep() const { return is_deep_; }
  /// Outward normals of flat parts in reach that were walked past, in the solid's frame.
  const std::vector<Vec3>& flats() const { return flats_; }

 private:
  bool meets(const PlacedDisc& disc, int level, int j, int k) {
    if (is_deep_) return false;
    const Vec3 center = to_solid_.apply(disc.center);
    const double within = reach_ + disc.radius;
    if (squared_distance(box_, center) > within * within) return false;
    const bool is_known = !disc.normal.isZero(0.0), is_last = level + 1 == discs_.levels();
    const Vec3 normal = product(to_solid_.rotation, disc.normal);
    // half of the disc's own extent along a direction
    const auto spread = [&](const Vec3& d) {
      if (!is_known) return disc.radius;
      const double along = std::min(1.0, std::abs(d.dot(normal)));
      return std::min(disc.radius, disc.radius * std::sqrt(1.0 - along * along) + disc.thickness * along);
    };
    // a plane against which the solid lies on one side: what is beyond it is as far away at least
    const auto beyond = [&](const Vec3& d) { return d.dot(center) - solid_.frame.height(d) - spread(d); };
    const auto is_beside = [&] { return is_known && (beyond(normal) > reach_ || beyond(-normal) > reach_); };
    const double least = beyond(solid_.outward(center));
    if (least > reach_) return false;
    if (least < -depth_) {
      if (is_beside()) return false;
      if (!is_last) return true;
      is_deep_ = is_deep_in_solid(discs_.order()[static_cast<std::size_t>(4 * j + k)]);
      if (is_deep_) return false;
    }
    const NormalCones::Node& cone = cones_.node(level, j);
    if (cone.is_any(k)) return !is_beside();
    const Vec3 axis = product(to_solid_.rotation, Vec3(cone.axis[k][0], cone.axis[k][1], cone.axis[k][2]).normalized());
    const double chord = cone.chord[k] + turn_;
    if (least > closing(axis, chord, center, disc.radius)) return false;
    if (!may_touch(axis, chord, center, disc.radius, spread(axis)) || is_beside()) return false;
    if (!cone.is_flat(k)) return !is_last || may_touch(discs_.order()[static_cast<std::size_t>(4 * j + k)]);
    keep_flat(axis);
    return false;
  }

  /// The same of one triangle, of its parts one by one.
  bool may_touch(int t) {
    const Triangle& triangle = mesh_.mesh().mesh.triangles[static_cast<std::size_t>(t)];
    for (int k = 0; k < 3; ++k) {
      const int v = triangle[k], e = mesh_.mesh().topology.triangle_edges[static_cast<std::size_t>(t)][k];
      if (peaks_.get(v, [&] { return is_peak(v); })) return true;
      if (edges_.get(e, [&] { return may_touch_edge(e); })) return true;
    }
    return solid_.corners.empty() && may_touch_face(t);
  }

  Vec3 place(int v) const { return to_solid_.apply(mesh_.mesh().mesh.vertices[static_cast<std::size_t>(v)]); }

  /// Unit, in the solid's frame; zero of a triangle without area.
  Vec3 normal_of(int t) const {
    const Triangle& c = mesh_.mesh().mesh.triangles[static_cast<std::size_t>(t)];
    const Vec3 &a = mesh_.mesh().mesh.vertices[c[0]], &b = mesh_.mesh().mesh.vertices[c[1]],
               &d = mesh_.mesh().mesh.vertices[c[2]];
    return product(to_solid_.rotation, (b - a).cross(d - a).normalized());
  }

  /// Whether, as the solid is or turned, none of the edges at a corner of the mesh runs nearer to it.
  bool is_peak(int v) {
    const NormalCones::OfVertex& cone = cones_.of_vertex(v);
    if (cone.chord < 0.0f) return true;
    const Vec3 x = place(v), out = solid_.outward(x);
    const double away = out.dot(x) - solid_.frame.height(out);
    if (away > reach_) return false;
    if (away <= 0.0) {  // in the solid it isn't clear which way is out
      const Vec3 axis = product(to_solid_.rotation, Vec3(cone.axis[0], cone.axis[1], cone.axis[2]).normalized());
      return may_touch(axis, cone.chord + turn_, x, 0.0, 0.0);
    }
    const double most = turn_ + kOfFold * cone.chord;
    const MeshTopology& topology = mesh_.mesh().topology;
    for (int i = topology.vertex_triangle_begin[v]; i < topology.vertex_triangle_begin[v + 1]; ++i)
      for (const int other : mesh_.mesh().mesh.triangles[static_cast<std::size_t>(topology.vertex_triangles[i])]) {
        const Vec3 along = place(other) - x;
        if (along.dot(out) < -most * along.norm()) return false;
      }
    return true;
  }

  /// Whether the solid can touch what lies within `radius` of x and has normals that differ from the axis by at most
  /// `chord`. `spread`: half of its extent along the axis.
  bool may_touch(const Vec3& axis, double chord, const Vec3& x, double radius, double spread) {
    // Where it touches, all the solid is in front of the plane whose normal is one of those: its lowest point against the
    // axis is then behind the place by no more than these directions differ.
    const Vec3 way = solid_.frame.support(-axis) - x;
    if (axis.dot(way) + spread + chord * (way.norm() + radius) < -depth_) return false;
    // below a flat side, away from its border, its normal is the only direction from which the solid comes
    const FlatSide* side = side_facing(-axis);
    return side == nullptr || (side->normal + axis).squaredNorm() <= chord * chord ||
           !side->is_below(x, radius + depth_, depth_);
  }

  /// What the set's `facing` is, if it is flat.
  const FlatSide* side_facing(const Vec3& direction) {
    const auto known = [&](int face) {
      return std::find_if(sides_.begin(), sides_.end(), [&](const FlatSide& side) { return side.face == face; });
    };
    if (polyhedron_ != nullptr)
      if (const auto side = known(polyhedron_->face_facing(direction)); side != sides_.end()) return &*side;
    const ContactFace face = solid_.frame.set->facing(direction);
    if (face.count < 3) return nullptr;
    if (const auto side = known(face.face); side != sides_.end()) return &*side;
    return &sides_.emplace_back(face);
  }

  /// How far apart what touches there within the time step may be now.
  double closing(const Vec3& axis, double chord, const Vec3& x, double radius) const {
    if (limits_.is_either_way) return limits_.reach;
    const Vec3 way = motion_.shift + motion_.turn.cross(x);
    const double most = chord * way.norm() - axis.dot(way) + turn_ * radius;
    return std::clamp(most, limits_.activation, limits_.reach);
  }

  /// The distance from the solid is convex along an edge: it is least between the ends only if it falls from both.
  bool may_touch_edge(int e) {
    const MeshTopology::Edge& edge = mesh_.mesh().topology.edges[static_cast<std::size_t>(e)];
    if (edge.triangle1 < 0) return true;
    const Vec3 x0 = place(edge.v0), x1 = place(edge.v1), along = x1 - x0;
    const double most = (turn_ + kRounding) * along.norm();
    if (solid_.outward(x0).dot(along) > most || solid_.outward(x1).dot(along) < -most) return false;
    const Vec3 n0 = normal_of(edge.triangle0), n1 = normal_of(edge.triangle1), sum = n0 + n1;
    const double length = sum.norm();
    if (!(length > 0.5)) return true;
    const Vec3 axis = sum / length;
    return may_touch(axis, (n0 - axis).norm() + turn_, 0.5 * (x0 + x1), 0.5 * along.norm(), 0.0);
  }

  /// Whether the lowest point of the solid, or of what it would rest on, is over the triangle.
  bool may_touch_face(int t) const {
    const Triangle& c = mesh_.mesh().mesh.triangles[static_cast<std::size_t>(t)];
    const TriangleCorners corners{place(c[0]), place(c[1]), place(c[2])};
    const Vec3 normal = normal_of(t);
    const double longest =
        std::sqrt(std::max((corners[1] - corners[0]).squaredNorm(), (corners[2] - corners[0]).squaredNorm()));
    const auto is_over = [&](const Vec3& x) {
      const double height = normal.dot(x - corners[0]), away = (x - corners[0]).norm(),
                   beside = (turn_ + kRounding) * away;
      return height <= reach_ + beside && height >= -depth_ - beside && away - std::abs(height) <= longest + beside &&
             closest_on_triangle(x - height * normal, corners).squared_distance <= beside * beside;
    };
    if (is_over(solid_.frame.support(-normal))) return true;
    const ContactFace face = solid_.frame.set->facing(-normal);
    return std::any_of(face.point.begin(), face.point.begin() + face.count, is_over);
  }

  bool is_deep_in_solid(int t) const {
    const TriangleMesh& mesh = mesh_.mesh().mesh;
    const Triangle& c = mesh.triangles[static_cast<std::size_t>(t)];
    // a plane against which the solid lies on one side, near enough: most are told by one from a corner
    const TriangleCorners corners{place(c[0]), place(c[1]), place(c[2])};
    for (const Vec3& x : corners) {
      const Vec3 out = solid_.outward(x);
      const double low = std::min({out.dot(corners[0]), out.dot(corners[1]), out.dot(corners[2])});
      if (low - solid_.frame.height(out) >= -depth_) return false;
    }
    const Vec3& origin = mesh.vertices[c[0]];
    const ConvexTriangle triangle({Vec3::Zero(), mesh.vertices[c[1]] - origin, mesh.vertices[c[2]] - origin});
    const ConvexGap gap =
        convex_gap({solid_.frame.set, {}}, {&triangle, {to_solid_.rotation, to_solid_.apply(origin)}}, 0.0);
    return gap.is_within_reach && gap.gap < -depth_;
  }

  void keep_flat(const Vec3& axis) {
    const auto is_same = [&](const Vec3& n) { return n.dot(axis) > kSameDirection; };
    if (std::none_of(flats_.begin(), flats_.end(), is_same)) flats_.push_back(axis);
  }

  const Collider& mesh_;
  const TouchingSolid& solid_;
  const DiscTree& discs_;
  const NormalCones& cones_;
  const Pose to_solid_;
  const double reach_, depth_;  // depth: how deep what touches may be
  const TouchLimits& limits_;
  const RelativeMotion& motion_;
  const double turn_;
  const Aabb box_;
  const ConvexPolyhedron* polyhedron_;
  bool is_deep_ = false;
  Remembered peaks_, edges_;
  std::deque<FlatSide> sides_;  // those that were asked about
  std::vector<Vec3> flats_;
};

/// Triangles seen from any of the points (seen_triangles, from in front and from behind), in one walk for up to 64 of them:
/// each is followed as far as alone.
void add_seen_from(const SurfaceMesh& surface, std::span<const Vec3> points, double reach, std::vector<int>& found) {
  struct Task {
    int level, node;
    std::uint64_t points;
  };
  const DiscTree& discs = surface.discs();
  const NormalCones& cones = normal_cones(surface);
  std::vector<Task> waiting;
  if (discs.triangle_count() > 0) waiting.push_back({0, 0, ~std::uint64_t(0) >> (64 - points.size())});
  while (!waiting.empty()) {
    const Task task = waiting.back();
    waiting.pop_back();
    for (int k = 0; k < discs.disc_count(task.level, task.node); ++k) {
      const PlacedDisc disc = disc_of(discs, task.level, task.node, k);
      const double most = reach + disc.radius;
      std::uint64_t seeing = 0;
      for (std::uint64_t left = task.points; left != 0; left &= left - 1) {
        const int i = std::countr_zero(left);
        const Vec3 way = points[static_cast<std::size_t>(i)] - disc.center;
        if (way.squaredNorm() <= most * most && cones.may_see(task.level, task.node, k, way, disc.radius, true))
          seeing |= std::uint64_t(1) << i;
      }
      if (seeing == 0) continue;
      if (task.level + 1 < discs.levels())
        waiting.push_back({task.level + 1, 4 * task.node + k, seeing});
      else
        found.push_back(discs.order()[static_cast<std::size_t>(4 * task.node + k)]);
    }
  }
}

}  // namespace

RelativeMotion relative_motion(const ContactSink& sink) {
  const Collider &solid = sink.first(), &mesh = sink.second();
  const double time_step = std::max(0.0, sink.query().time_step);
  const Mat3 to_solid = solid.pose.rotation.transpose();
  const Vec3 shift = solid.velocity - mesh.velocity_at(solid.pose.position);
  return {time_step * product(to_solid, shift),
          time_step * product(to_solid, Vec3(solid.angular_velocity - mesh.angular_velocity))};
}

TouchLimits touch_limits(const ContactSink& sink, double reach) {
  const ContactQuery& query = sink.query();
  return {reach, query.proximity ? query.activation : 0.0, query.either_may_stop};
}

TouchedTriangles touched_triangles(const Collider& mesh, const Aabb& box, const TouchingSolid& solid,
                                   const TouchLimits& limits, const RelativeMotion& motion) {
  if (auto few = triangles_within(mesh, box, solid.frame, limits.reach, has_cones(mesh) ? kFew : kAny))
    return {std::move(*few), true};
  TouchLimits wide = limits;
  for (double* distance : {&wide.reach, &wide.activation}) *distance = widened(mesh, box, *distance);
  Walk walk(mesh, solid, wide, motion);
  std::vector<int> found = walk.run();
  if (walk.is_deep()) return {triangles_within(mesh, box, solid.frame, limits.reach), true};
  std::vector<Vec3> places;  // in the mesh's frame
  const auto add_below = [&](const Vec3& x) { places.push_back(mesh.pose.apply_inverse(solid.frame.pose.apply(x))); };
  for (const Vec3& x : solid.corners) add_below(x);
  for (const Vec3& n : walk.flats()) {
    if (!solid.corners.empty()) break;
    const ContactFace face = solid.frame.set->facing(-n);
    for (int i = 0; i < face.count; ++i) add_below(face.point[i]);
    add_below(solid.frame.support(-n));
  }
  for (std::size_t i = 0; i < places.size(); i += 64)
    add_seen_from(mesh.mesh(), std::span(places).subspan(i, std::min<std::size_t>(64, places.size() - i)), wide.reach,
                  found);
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  const SurfaceView view(mesh, 0);
  std::erase_if(found, [&](int t) { return !overlap(triangle_bounds(view, t), box); });
  return {std::move(found), false};
}

}  // namespace impinge
