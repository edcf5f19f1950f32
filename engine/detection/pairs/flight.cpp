#include "engine/detection/pairs/flight.hpp"

#include <algorithm>
#include <cmath>

#include "engine/detection/continuous/convex_solids.hpp"
#include "engine/detection/pairs/primitive_pairs.hpp"
#include "engine/geometry/convex/convex_gap.hpp"
#include "engine/geometry/convex/mesh_hull.hpp"
#include "engine/geometry/rotation.hpp"

namespace impinge {
namespace {

constexpr double kNear = 1e-3;       // of the activation distance: where they are looked at
constexpr double kAim = 0.5;         // of that: how near an advance may lead, so that few are needed
constexpr double kSameFace = 0.999;  // of the normals' cosine: what is met later with what is met first
constexpr double kBallsTouch =
    0.02;  // of the activation distance: from there on balls use the plane that they begin with
/// What turns fast gets on slowly; where it has got to by then is as good a place to look from.
constexpr int kMostAdvances = 64;

bool is_plane(const Collider& c) { return c.shape->as<Plane>() != nullptr; }

bool is_ball(const Collider& c) { return c.shape->as<Sphere>() != nullptr; }

Pose pose_after(const Collider& c, double time) { return moved(c.pose, time * c.velocity, time * c.angular_velocity); }

/// No point turns about the body's centre faster, m/s; a ball's turning moves none of its surface.
double swing_of(const Collider& c) {
  if (c.angular_velocity.isZero(0.0) || is_ball(c)) return 0.0;
  return c.angular_velocity.norm() * c.shape->bounding_radius();
}

double fastest_approach(const Collider& a, const Collider& b) {
  return (a.velocity - b.velocity).norm() + swing_of(a) + swing_of(b);
}

/// A rigid body as convex solids on their way.
class Flyer {
 public:
  explicit Flyer(const Collider& c) : c_(c) {
    if (const SurfaceMesh* mesh = c.shape->mesh()) {
      hull_.emplace(*mesh);
      parts_.push_back({{&*hull_, Pose()}, c.shape->bounding_radius()});
    } else if (const std::vector<ShapePart>* parts = c.shape->parts()) {
      for (const ShapePart& part : *parts)
        parts_.push_back({{std::get<const ConvexSet*>(part.shape->form()), part.pose}, part.shape->bounding_radius()});
    } else {
      parts_.push_back({{std::get<const ConvexSet*>(c.shape->form()), Pose()}, c.shape->bounding_radius()});
    }
  }
  Flyer(const Flyer&) = delete;
  Flyer& operator=(const Flyer&) = delete;

  std::size_t parts() const { return parts_.size(); }
  PlacedConvex part(std::size_t k, const Pose& pose) const { return placed(parts_[k].solid, pose); }
  double radius(std::size_t k) const { return parts_[k].radius; }  ///< about the part's frame, metres
  Pose at(double time) const { return pose_after(c_, time); }

 private:
  struct Part {
    PlacedConvex solid;
    double radius;
  };
  const Collider& c_;
  std::optional<MeshHull> hull_;
  std::vector<Part> parts_;
};

/// All that a flyer may pass in a time step, at whatever time it is stopped, but for what the arcs of its points stand out.
class SweptHull final : public ConvexSet {
 public:
  SweptHull(const Flyer& of, const Collider& c, double time_step) : of_(of), poses_{c.pose, of.at(time_step)} {}
  Vec3 support(const Vec3& direction) const override {
    const Vec3 unit = direction.normalized();
    double most = -INFINITY;
    Vec3 point = Vec3::Zero();
    for (const Pose& pose : poses_)
      for (std::size_t k = 0; k < of_.parts(); ++k) {
        const Vec3 x = farthest(of_.part(k, pose), unit);
        if (const double reach = unit.dot(x); reach > most) most = reach, point = x;
      }
    return point;
  }

 private:
  const Flyer& of_;
  Pose poses_[2];
};

/// How far the arc of a point stands out over its chord at most, metres.
double bend_of(const Collider& c, double time_step) {
  const double swing = swing_of(c), spin = c.angular_velocity.norm();
  return swing == 0.0 ? 0.0 : (1.0 - std::cos(std::min(0.5 * time_step * spin, M_PI))) * swing / spin;
}

/// Whether two that may be stopped on their way at any time, each by itself, stay apart.
bool keep_apart(const Collider& a, const Collider& b, double near, double time_step) {
  if (is_plane(a) || is_plane(b)) return false;
  const Flyer of_a(a), of_b(b);
  const SweptHull hull_a(of_a, a, time_step), hull_b(of_b, b, time_step);
  const double allowed = near + bend_of(a, time_step) + bend_of(b, time_step);
  const ConvexGap g = convex_gap({&hull_a, Pose()}, {&hull_b, Pose()}, allowed);
  return !g.is_within_reach || g.gap > allowed;
}

/// Of what is behind a face that it has nothing to do with the gap says less than nothing.
bool is_near(const Collision& c, const ContactQuery& query) { return std::abs(c.gap) <= query.activation; }

/// No half-space turns as it goes.
bool is_rigid(const Collider& c) {
  return c.vertex_velocities.empty() && (!is_plane(c) || c.angular_velocity.isZero(0.0));
}

/// A collider later on; `vertices` holds a mesh's.
Collider moved_on(const Collider& c, double time, std::vector<Vec3>& vertices) {
  if (c.velocity.isZero(0.0) && c.angular_velocity.isZero(0.0)) return c;
  Collider later = c;
  later.pose = pose_after(c, time);
  if (c.vertices.empty()) {
    later.bounds = c.shape->bounds(later.pose);
    return later;
  }
  later.bounds = Aabb();
  for (const Vec3& x : c.mesh().mesh.vertices)
    vertices.push_back(later.pose.apply(x)), later.bounds.include(vertices.back());
  later.vertices = vertices;
  return later;
}

}  // namespace

std::optional<double> time_until_near(const Collider& a, const Collider& b, double near, double time_step) {
  if (is_plane(a)) return time_until_near(b, a, near, time_step);
  const Vec3 between = a.velocity - b.velocity;
  const double swing = swing_of(a) + swing_of(b), fastest = fastest_approach(a, b);
  const Flyer of_a(a);
  std::optional<Flyer> of_b;
  if (!is_plane(b)) of_b.emplace(b);
  double time = 0.0;
  for (int advance = 0; advance < kMostAdvances; ++advance) {
    const Pose at_a = of_a.at(time);
    const double left = time_step - time;
    double step = INFINITY;
    bool is_there = false;
    const auto advance_to = [&](double gap, const Vec3& normal) {
      is_there = is_there || gap <= near;
      const double closing = swing - normal.dot(between);  // along this normal, from now on
      if (closing > 0.0) step = std::min(step, (gap - kAim * near) / closing);
    };
    for (std::size_t i = 0; i < of_a.parts(); ++i) {
      const PlacedConvex part = of_a.part(i, at_a);
      if (!of_b) {
        const WorldPlane plane = world_plane(b);
        const double offset = plane.offset + time * plane.normal.dot(b.velocity);
        advance_to(plane.normal.dot(farthest(part, -plane.normal)) - offset, plane.normal);
        continue;
      }
      const Pose at_b = of_b->at(time);
      for (std::size_t j = 0; j < of_b->parts(); ++j) {
        const PlacedConvex other = of_b->part(j, at_b);
        // spheres round the two tell most of many parts apart
        const double least = (part.pose.position - other.pose.position).norm() - of_a.radius(i) - of_b->radius(j);
        if (least - near > fastest * std::min(step, left)) continue;
        const ConvexGap g = convex_gap(part, other, near + fastest * left);
        if (g.is_within_reach) advance_to(g.gap, g.normal);
      }
    }
    if (is_there) return time;
    if (!(step <= left)) return std::nullopt;
    time += step;
  }
  return time;
}

bool fly_together(const Collider& a, const Collider& b, const ContactQuery& query, std::span<const Collision> found) {
  const bool are_balls = is_ball(a) && is_ball(b);
  const auto touches = [&](const Collision& c) {
    return are_balls ? c.gap <= kBallsTouch * query.activation : is_near(c, query);
  };
  return query.proximity && is_rigid(a) && is_rigid(b) && query.time_step * fastest_approach(a, b) > query.activation &&
         std::none_of(found.begin(), found.end(), touches);
}

std::optional<double> time_of_meeting(const Collider& a, const Collider& b, const ContactQuery& query) {
  if (!query.either_may_stop) return time_until_near(a, b, kNear * query.activation, query.time_step);
  return keep_apart(a, b, query.activation, query.time_step) ? std::nullopt : std::optional(0.0);
}

std::vector<Collision> contacts_where_they_meet(std::span<const Collider> colliders, const BodyPair& pair,
                                                const ContactQuery& query, double time, PairContacts test) {
  const Collider &a = colliders[pair.a], &b = colliders[pair.b];
  std::vector<Vec3> vertices[2];
  const Collider then[2] = {moved_on(a, time, vertices[0]), moved_on(b, time, vertices[1])};
  ContactQuery rest = query;
  rest.time_step -= time;
  rest.sunk = time / query.time_step * query.fall;
  std::vector<Collision> found;
  test(std::span(then), {BodyIndex(0), BodyIndex(1), pair.margin}, rest, found);
  const auto first = std::find_if(found.begin(), found.end(), [&](const Collision& c) { return is_near(c, query); });
  if (first == found.end()) return {};
  const Vec3 normal = first->normal;
  std::erase_if(found, [&](const Collision& c) {
    return !is_near(c, query) && (c.gap < 0.0 || !(c.normal.dot(normal) > kSameFace));
  });
  for (Collision& c : found) {
    Meeting meeting;
    meeting.time = time, meeting.is_after = !is_near(c, query);
    meeting.from_a = a.pose.apply(then[0].pose.apply_inverse(c.point_a));
    meeting.from_b = b.pose.apply(then[1].pose.apply_inverse(c.point_b));
    const Vec3 common = c.common_point();
    // back along straight lines, as rows see motion
    c.point_a -= time * then[0].velocity_at(c.point_a), c.point_b -= time * then[1].velocity_at(c.point_b);
    c.gap = c.normal.dot(c.point_a - c.point_b);
    meeting.on_a = common + a.pose.position - then[0].pose.position - c.common_point();
    meeting.on_b = common + b.pose.position - then[1].pose.position - c.common_point();
    c.meeting = std::make_shared<const Meeting>(meeting);
    c.body_a = pair.a, c.body_b = pair.b;
    if (c.normal_owner.is_none()) continue;
    c.normal_owner = c.normal_owner == BodyIndex(0) ? pair.a : pair.b;
    if (!colliders[c.normal_owner].angular_velocity.isZero(0.0)) c.normal_owner = {};
  }
  return found;
}

}  // namespace impinge
