#include "engine/step/end_pose.hpp"

#include <algorithm>
#include <numeric>
#include <set>

#include "engine/bodies/rigid_motion.hpp"
#include "engine/contact/pair_scale.hpp"
#include "engine/core/finite.hpp"
#include "engine/geometry/convex/convex_set.hpp"
#include "engine/geometry/distance.hpp"
#include "engine/geometry/rotation.hpp"
#include "engine/shapes/primitives.hpp"
#include "engine/shapes/surface_of_revolution.hpp"
#include "engine/shapes/wall.hpp"
#include "engine/step/find_collisions.hpp"
#include "engine/step/find_pairs.hpp"

namespace impinge {
namespace {

constexpr double kAllowed = 0.04;  // of the activation distance: overlap at the end that is left to recovery
constexpr double kOfRigid = 0.02;  // of the same: where neither deforms, and nothing of the answer is smooth over nodes
/// Of the same: where two meet in flight, whose rebound is exact as long as that stays.
constexpr double kOfFlight = 0.2;
constexpr double kSwift = 10.0;    // of the same: an approach in which rigid bodies meet where their start doesn't show
constexpr double kInHollow = 5.0;  // of the same: where one is hollow, from the inside of which nothing slides away
constexpr double kDeepest = 100.0;        // of the same: what ends deeper has passed, and its normal says nothing
constexpr double kFarFromThrough = 0.25;  // of a wall: overlap that leads nowhere
constexpr double kShallow = 1e-3;         // of the same: overlap that contacts are believed
constexpr std::size_t kMostOfMeshes = 3;  // contacts of two rigid meshes that a look brings

bool deforms(const Body& body) { return body.kind() == BodyKind::deformable; }
bool is_ball(const Body& body) { return body.shape->as<Sphere>() != nullptr; }

/// Of collisions in pair order.
std::span<const Collision> of_pair(std::span<const Collision> all, const BodyPair& pair) {
  const auto is_before = [](const Collision& c, const BodyPair& p) {
    return std::pair(c.body_a, c.body_b) < std::pair(p.a, p.b);
  };
  const auto first = std::lower_bound(all.begin(), all.end(), pair, is_before);
  const auto last =
      std::find_if(first, all.end(), [&](const Collision& c) { return c.body_a != pair.a || c.body_b != pair.b; });
  return {first, last};
}

bool has_plane(const Body& a, const Body& b) {
  return a.shape->as<Plane>() != nullptr || b.shape->as<Plane>() != nullptr;
}

bool are_meshes(const Body& a, const Body& b) { return a.shape->mesh() != nullptr && b.shape->mesh() != nullptr; }

/// Whether rigid bodies may meet with what did not touch when they set out. Planes are met by the corners that their contacts
/// have from the start; and of meshes one of which hangs in the other rows of what passes tell more (world/substep).
bool may_hide(const Bodies& bodies, const BodyPair& pair, std::span<const Collision> collisions) {
  const Body &a = bodies[pair.a], &b = bodies[pair.b];
  if (has_plane(a, b)) return false;
  return !are_meshes(a, b) || !are_interlocked(collisions, pair);
}

/// Whether detection says how deep the two are where they stand, which of two meshes takes more (detection/triangles).
bool tells_its_depth(const Body& a, const Body& b) {
  return &a != &b && !has_plane(a, b) && !are_meshes(a, b) && !deforms(a) && !deforms(b);
}

bool is_hollow(const Shape& shape) { return wall_of(shape) < shape.thickness(); }

/// Bodies of some pairs where the velocities of a solved step lead; the others stay as they are.
class EndPose {
 public:
  EndPose(const Bodies& bodies, const SubStep& step, std::span<const Collider> solved, std::span<const BodyPair> pairs)
      : bodies_(bodies), step_(step), vertices_(step.colliders.size()) {
    make_colliders(bodies, colliders_);
    std::vector<const BodyVector*> changes(colliders_.size(), nullptr), flights(colliders_.size(), nullptr);
    for (std::size_t g = 0; g < step.groups.size(); ++g)
      for (std::size_t i = 0; i < step.groups[g].bodies.size(); ++i) {
        changes[step.groups[g].bodies[i]] = &step.results[g].velocity[i];
        if (step.results[g].follows_flight) flights[step.groups[g].bodies[i]] = &step.results[g].displacement[i];
      }
    std::set<BodyIndex> wanted;
    for (const BodyPair& pair : pairs) wanted.insert({pair.a, pair.b});
    std::size_t most = 0;
    for (const BodyIndex b : wanted) {
      move(b, changes[b], {solved[b].velocity, solved[b].angular_velocity}, flights[b]);
      most = std::max(most, vertices_[b].size());
    }
    resting_.assign(most, Vec3::Zero());
    for (const BodyIndex b : wanted)
      if (deforms(bodies[b])) colliders_[b].vertex_velocities = std::span(resting_).first(vertices_[b].size());
  }

  std::span<const Collider> colliders() const { return colliders_; }

  /// Whether it is a ball or rod, or round about an axis that keeps its direction.
  bool rolls(BodyIndex b) const {
    if (is_ball(bodies_[b])) return true;
    const ConvexSet* solid = round_solid(*bodies_[b].shape);
    if (solid == nullptr) return false;
    return solid->rounding() > 0.0 || rolls_about_y(bodies_[b].pose.rotation, colliders_[b].pose.rotation);
  }

  /// The place at the start of the material that is at `x` at the end, where it faces `faced`; of what rolls the place on the
  /// same side of it, which a row can push without turning it, however far it rolls meanwhile.
  Vec3 at_start(BodyIndex b, TriangleIndex triangle, const Vec3& x, const Vec3& faced) const {
    const Body& body = bodies_[b];
    const Pose& then = colliders_[b].pose;
    if (is_ball(body)) return x + (body.pose.position - then.position);
    if (rolls(b)) {
      const Vec3 from = then.rotation.transpose() * faced, to = body.pose.rotation.transpose() * faced;
      return body.pose.apply(round_solid(*body.shape)->rolled(then.apply_inverse(x), from, to));
    }
    if (!deforms(body)) return body.pose.apply(then.apply_inverse(x));
    const Triangle& t = body.shape->mesh()->mesh.triangles[triangle];
    const std::vector<Vec3>& end = vertices_[b];
    const Vec3 w = nearest_weights(x, {end[t[0]], end[t[1]], end[t[2]]});
    const std::vector<Vec3>& start = body.world_vertices;
    return w.x() * start[t[0]] + w.y() * start[t[1]] + w.z() * start[t[2]];
  }

 private:
  /// `flight`: what it is put back by, or null.
  void move(BodyIndex b, const BodyVector* change, const Twist& twist, const BodyVector* flight) {
    const Body& body = bodies_[b];
    Collider& c = colliders_[b];
    if (deforms(body)) {
      if (body.asleep)
        vertices_[b] = body.world_vertices;
      else
        body.surface_at_end(change, vertices_[b]);
    } else {
      c.velocity = c.angular_velocity = Vec3::Zero();
      if (body.asleep || (twist.linear.isZero(0.0) && twist.angular.isZero(0.0))) return;
      if (const RigidBody* rigid = body.as<RigidBody>()) {
        c.pose = free_flight(*rigid, twist.linear, rigid->world_inertia() * twist.angular, step_.time_step);
      } else {
        c.pose = moved(c.pose, step_.time_step * twist.linear, step_.time_step * twist.angular);
      }
      if (flight != nullptr) c.pose = moved(c.pose, flight->twist.linear, flight->twist.angular);
      if (body.world_vertices.empty()) {
        c.bounds = body.shape->bounds(c.pose);
        return;
      }
      for (const Vec3& x : body.world_vertices) vertices_[b].push_back(c.pose.apply(body.pose.apply_inverse(x)));
    }
    c.vertices = vertices_[b];
    c.bounds = Aabb();
    for (const Vec3& x : vertices_[b]) c.bounds.include(x);
  }

  const Bodies& bodies_;
  const SubStep& step_;
  std::vector<Collider> colliders_;
  std::vector<std::vector<Vec3>> vertices_;  // by body, of meshes that move
  std::vector<Vec3> resting_;                // velocities of what has arrived
};

Detecting at_rest(Detecting by) {
  by.either_may_stop = by.looks_ahead = by.follows_flights = false;
  return by;
}

/// Of two rigid meshes, which meet in many features at once: few of them hold the others too.
void keep_deepest(const Bodies& bodies, std::span<const double> ends, std::vector<Collision>& found) {
  std::vector<char> stays(found.size(), 1);
  for (std::size_t first = 0, last = 0; first < found.size(); first = last) {
    const Body &a = bodies[found[first].body_a], &b = bodies[found[first].body_b];
    last = first + of_pair(found, {found[first].body_a, found[first].body_b}).size();
    if (last - first <= kMostOfMeshes || !are_meshes(a, b) || deforms(a) || deforms(b)) continue;
    std::vector<std::size_t> deepest(last - first);
    std::iota(deepest.begin(), deepest.end(), first);
    std::stable_sort(deepest.begin(), deepest.end(), [&](std::size_t l, std::size_t r) { return ends[l] < ends[r]; });
    for (std::size_t k = kMostOfMeshes; k < deepest.size(); ++k) stays[deepest[k]] = 0;
  }
  std::size_t i = 0;
  std::erase_if(found, [&](const Collision&) { return stays[i++] == 0; });
}

}  // namespace

bool are_interlocked(std::span<const Collision> collisions, const BodyPair& pair) {
  const std::span<const Collision> own = of_pair(collisions, pair);
  Vec3 sum = Vec3::Zero();
  for (const Collision& c : own) sum += c.normal;
  return std::any_of(own.begin(), own.end(), [&](const Collision& c) { return c.normal.dot(sum) <= 0.0; });
}

std::vector<BodyPair> pairs_at_end(const Bodies& bodies, const ContactSettings& contact, const SubStep& step,
                                   std::span<const Collider> solved) {
  std::vector<BodyPair> pairs;
  for (const BodyPair& pair : step.pairs) {
    const Body &a = bodies[pair.a], &b = bodies[pair.b];
    if (pair.a == pair.b || a.asleep || b.asleep) continue;
    const bool is_passing = std::binary_search(step.passing.begin(), step.passing.end(), pair);
    // where two meet in flight they have the contacts of that place alone, and others come round; of a ball none do
    const bool has_mesh = a.shape->mesh() != nullptr || b.shape->mesh() != nullptr,
               is_flight = step.is_flight(pair.a, pair.b);
    const bool comes_down = is_flight && (is_passing || has_mesh || !(is_ball(a) || is_ball(b)));
    if (is_flight && !comes_down) continue;
    if (step.group_of(pair.a).is_none() && step.group_of(pair.b).is_none()) continue;
    const double activation = contact.activation(pair_size(a, b));
    const auto is_swift = [&] {
      const double way = approach(solved[pair.a], a.radius, solved[pair.b], b.radius, step.time_step);
      if (way <= kInHollow * activation || !may_hide(bodies, pair, step.collisions)) return false;
      return way > kSwift * activation || is_hollow(*a.shape) || is_hollow(*b.shape);
    };
    if (deforms(a) || deforms(b) || is_passing || comes_down || is_swift())
      pairs.push_back({pair.a, pair.b, activation});
  }
  return pairs;
}

std::vector<Collision> overlaps_at_end(const Bodies& bodies, const Detecting& by, const SubStep& step,
                                       std::span<const Collider> solved, std::span<const BodyPair> seen) {
  if (seen.empty()) return {};
  const EndPose end(bodies, step, solved, seen);
  std::vector<BodyPair> pairs;
  std::copy_if(seen.begin(), seen.end(), std::back_inserter(pairs),
               [&](const BodyPair& p) { return overlap(end.colliders()[p.a].bounds, end.colliders()[p.b].bounds); });
  if (pairs.empty()) return {};
  std::vector<TrianglePair> triangles;
  std::vector<Collision> found;
  find_collisions(end.colliders(), pairs, at_rest(by), 0.0, triangles, found);
  std::vector<double> ends;  // gaps there, of those that stay
  const auto turns = [&](BodyIndex b) { return end.colliders()[b].pose.rotation != bodies[b].pose.rotation; };
  std::erase_if(found, [&](Collision& c) {
    const double activation = by.contact.activation(pair_size(bodies[c.body_a], bodies[c.body_b]));
    const bool is_rigid = !deforms(bodies[c.body_a]) && !deforms(bodies[c.body_b]);
    const double allowed = activation * (!is_rigid                            ? kAllowed
                                         : step.is_flight(c.body_a, c.body_b) ? kOfFlight
                                                                              : kOfRigid);
    const bool is_lost = c.gap < -kDeepest * activation && !has_plane(bodies[c.body_a], bodies[c.body_b]);
    if (c.gap >= -allowed || is_lost) return true;
    const double at_end = c.gap;
    c.point_a = end.at_start(c.body_a, c.triangle_a, c.point_a, -c.normal);
    c.point_b = end.at_start(c.body_b, c.triangle_b, c.point_b, c.normal);
    c.gap = c.normal.dot(c.point_a - c.point_b);
    // what rolls and what can't move come together from the side, and a push half way between them would turn it
    if (!bodies[c.body_a].has_freedom() && end.rolls(c.body_b)) c.point_a = c.point_b + c.gap * c.normal;
    if (!bodies[c.body_b].has_freedom() && end.rolls(c.body_a)) c.point_b = c.point_a - c.gap * c.normal;
    if (!c.normal_owner.is_none() && turns(c.normal_owner)) c.normal_owner = {};
    if (at_end >= std::min(c.gap, 0.0) - allowed) return true;
    ends.push_back(at_end);
    return false;
  });
  keep_deepest(bodies, ends, found);
  return found;
}

std::vector<std::optional<Collision>> deepest_now(const Bodies& bodies, const Detecting& by,
                                                  std::vector<BodyPair> pairs) {
  std::vector<Collider> colliders;
  make_colliders(bodies, colliders);
  for (Collider& c : colliders) c.velocity = c.angular_velocity = Vec3::Zero();
  for (BodyPair& pair : pairs) pair.margin = by.contact.activation(pair_size(bodies[pair.a], bodies[pair.b]));
  std::vector<TrianglePair> triangles;
  std::vector<Collision> found;
  find_collisions(colliders, pairs, at_rest(by), 0.0, triangles, found);
  std::vector<std::optional<Collision>> deepest;
  for (const BodyPair& pair : pairs) {
    std::optional<Collision>& of = deepest.emplace_back();
    for (const Collision& c : of_pair(found, pair))
      if (c.gap < (of ? of->gap : 0.0)) of = c;
  }
  return deepest;
}

std::vector<double> overlaps_now(const Bodies& bodies, const Detecting& by, std::vector<BodyPair> pairs) {
  std::vector<double> depths;
  for (const std::optional<Collision>& c : deepest_now(bodies, by, std::move(pairs)))
    depths.push_back(c ? -c->gap : 0.0);
  return depths;
}

double overlap_at_start(const Bodies& bodies, const SubStep& step, const BodyPair& pair) {
  const Body &a = bodies[pair.a], &b = bodies[pair.b];
  if (!tells_its_depth(a, b) || (a.has_freedom() && b.has_freedom())) return 0.0;
  double depth = 0.0;
  for (const Collision& c : of_pair(step.collisions, pair)) depth = std::max(depth, -c.gap);
  return depth == 0.0 ? 0.0 : std::min(depth, kFarFromThrough * std::min(wall_of(*a.shape), wall_of(*b.shape)));
}

bool is_idle_overlap(const Vec3& lambda, double gap, double activation) {
  return lambda.isZero(0.0) && -gap > kShallow * activation;
}

bool have_parted(const Vec3& apart, const Vec3& normal, double activation) {
  return (apart - apart.dot(normal) * normal).norm() > activation;
}

double deepest_shown(const Bodies& bodies, const Detecting& by, std::span<const GroupResult> solved, double known) {
  struct Shown {
    double depth;
    BodyPair pair;
  };
  std::vector<Shown> doubtful;
  const bool may_ask = by.contact.points == ContactPoints::proximity;
  for (const GroupResult& result : solved)
    for (const SolvedContact& c : result.solved) {
      const BodyIndex a = c.collision.body_a, b = c.collision.body_b;
      const double depth = -gap_of(c, bodies);
      const auto is_doubtful = [&] {
        const double activation = by.contact.activation(pair_size(bodies[a], bodies[b]));
        const Vec3 apart = bodies[a].position_of(c.point_a) - bodies[b].position_of(c.point_b);
        return is_idle_overlap(c.lambda, -depth, activation) || have_parted(apart, normal_of(c, bodies), activation);
      };
      if (depth > known && may_ask && tells_its_depth(bodies[a], bodies[b]) && is_doubtful())
        doubtful.push_back({depth, {a, b}});
      else
        known = larger(known, depth);
    }
  std::stable_sort(doubtful.begin(), doubtful.end(), [](const Shown& l, const Shown& r) { return l.depth > r.depth; });
  std::set<BodyPair> asked;
  for (const Shown& shown : doubtful) {
    if (shown.depth <= known) break;
    if (!asked.insert(shown.pair).second) continue;
    known = std::max(known, overlaps_now(bodies, by, {shown.pair}).front());
  }
  return known;
}

}  // namespace impinge
