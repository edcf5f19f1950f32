#include "engine/detection/pairs/touched_triangles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/geometry/convex/convex_gap.hpp"
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
        turn_(motion.turn.norm()) {}

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
    if (solid_.frame.distance(center) > reach_ + disc.radius) return false;
    const Vec3 normal = product(to_solid_.rotation, disc.normal);
    // half of the disc's own extent along a direction
    const auto spread = [&](const Vec3& d) {
      if (disc.normal.isZero(0.0)) return disc.radius;
      const double along = std::min(1.0, std::abs(d.dot(normal)));
      return std::min(disc.radius, disc.radius * std::sqrt(1.0 - along * along) + disc.thickness * along);
    };
    // a plane against which the solid lies on one side: what is beyond it is as far away at least
    const auto beyond = [&](const Vec3& d) { return d.dot(center) - solid_.frame.height(d) - spread(d); };
    const double least = beyond(solid_.outward(center));
    if (least > reach_) return false;
    if (!disc.normal.isZero(0.0) && (beyond(normal) > reach_ || beyond(-normal) > reach_)) return false;
    if (least < -depth_) {
      if (level + 1 < discs_.levels()) return true;
      is_deep_ = is_deep_in_solid(discs_.order()[static_cast<std::size_t>(4 * j + k)]);
      if (is_deep_) return false;
    }
    const NormalCones::Node& cone = cones_.node(level, j);
    if (cone.is_any(k)) return true;
    const Vec3 axis = product(to_solid_.rotation, Vec3(cone.axis[k][0], cone.axis[k][1], cone.axis[k][2]).normalized());
    const double chord = cone.chord[k] + turn_;
    if (least > closing(axis, chord, center, disc.radius)) return false;
    if (!may_touch(axis, chord, center, disc.radius, spread(axis))) return false;
    if (!cone.is_flat(k))
      return level + 1 < discs_.levels() || may_touch(discs_.order()[static_cast<std::size_t>(4 * j + k)]);
    keep_flat(axis);
    return false;
  }

  /// The same of one triangle, of its parts one by one.
  bool may_touch(int t) const {
    const Triangle& triangle = mesh_.mesh().mesh.triangles[static_cast<std::size_t>(t)];
    for (int k = 0; k < 3; ++k) {
      if (is_peak(triangle[k])) return true;
      if (may_touch_edge(mesh_.mesh().topology.triangle_edges[static_cast<std::size_t>(t)][k])) return true;
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
  bool is_peak(int v) const {
    const NormalCones::OfVertex& cone = cones_.of_vertex(v);
    if (cone.chord < 0.0f) return true;
    const Vec3 x = place(v), out = solid_.outward(x);
    if (solid_.frame.distance(x) > reach_) return false;
    if (out.dot(x) <= solid_.frame.height(out)) {  // in the solid it isn't clear which way is out
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
  bool may_touch(const Vec3& axis, double chord, const Vec3& x, double radius, double spread) const {
    // Where it touches, all the solid is in front of the plane whose normal is one of those: its lowest point against the
    // axis is then behind the place by no more than these directions differ.
    const Vec3 way = solid_.frame.support(-axis) - x;
    if (axis.dot(way) + spread + chord * (way.norm() + radius) < -depth_) return false;
    // below a flat side, away from its border, its normal is the only direction from which the solid comes
    const ContactFace face = solid_.frame.set->facing(-axis);
    return !is_below(face, x, radius) || (face.normal + axis).norm() <= chord;
  }

  /// How far apart what touches there within the time step may be now.
  double closing(const Vec3& axis, double chord, const Vec3& x, double radius) const {
    if (limits_.is_either_way) return limits_.reach;
    const Vec3 way = motion_.shift + motion_.turn.cross(x);
    const double most = chord * way.norm() - axis.dot(way) + turn_ * radius;
    return std::clamp(most, limits_.activation, limits_.reach);
  }

  bool is_below(const ContactFace& face, const Vec3& x, double radius) const {
    if (face.count < 3 || face.normal.dot(x - face.point[0]) < -depth_) return false;
    for (int i = 0; i < face.count; ++i) {
      const Vec3 &p = face.point[i], side = face.point[(i + 1) % face.count] - p;
      const Vec3 inward = face.normal.cross(side);
      if (inward.dot(x - p) < (radius + depth_) * inward.norm()) return false;
    }
    return true;
  }

  /// The distance from the solid is convex along an edge: it is least between the ends only if it falls from both.
  bool may_touch_edge(int e) const {
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
    const auto is_over = [&](const Vec3& x) {
      const double height = normal.dot(x - corners[0]), beside = (turn_ + kRounding) * (x - corners[0]).norm();
      return height <= reach_ + beside && height >= -depth_ - beside &&
             closest_on_triangle(x - height * normal, corners).squared_distance <= beside * beside;
    };
    if (is_over(solid_.frame.support(-normal))) return true;
    const ContactFace face = solid_.frame.set->facing(-normal);
    return std::any_of(face.point.begin(), face.point.begin() + face.count, is_over);
  }

  bool is_deep_in_solid(int t) const {
    const TriangleMesh& mesh = mesh_.mesh().mesh;
    const Triangle& c = mesh.triangles[static_cast<std::size_t>(t)];
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
  bool is_deep_ = false;
  std::vector<Vec3> flats_;
};

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
  const auto add_below = [&](const Vec3& x) {
    const Vec3 local = mesh.pose.apply_inverse(solid.frame.pose.apply(x));
    const std::vector<int> seen =
        seen_triangles(mesh.mesh(), wide.reach, true, [&](const Vec3& c) { return Vec3(local - c); });
    found.insert(found.end(), seen.begin(), seen.end());
  };
  for (const Vec3& x : solid.corners) add_below(x);
  for (const Vec3& n : walk.flats()) {
    if (!solid.corners.empty()) break;
    const ContactFace face = solid.frame.set->facing(-n);
    for (int i = 0; i < face.count; ++i) add_below(face.point[i]);
    add_below(solid.frame.support(-n));
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  const SurfaceView view(mesh, 0);
  std::erase_if(found, [&](int t) { return !overlap(triangle_bounds(view, t), box); });
  return {std::move(found), false};
}

}  // namespace impinge
