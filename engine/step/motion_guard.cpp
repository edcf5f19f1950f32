#include "engine/step/motion_guard.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "engine/core/archive.hpp"
#include "engine/core/error.hpp"
#include "engine/core/parallel.hpp"
#include "engine/detection/continuous/plane_between.hpp"
#include "engine/detection/continuous/plane_passage.hpp"
#include "engine/detection/continuous/round_path.hpp"
#include "engine/detection/continuous/solid_passages.hpp"
#include "engine/detection/continuous/solids_apart.hpp"
#include "engine/geometry/rotation.hpp"
#include "engine/shapes/primitives.hpp"
#include "engine/shapes/sheet.hpp"
#include "engine/shapes/wall.hpp"
#include "engine/step/find_pairs.hpp"

namespace impinge {
namespace {

constexpr double kTurn = 0.25;      // radians between the poses of a path
constexpr double kSafe = 0.1;       // of a body's thickness: what contacts found before the motion don't lose
constexpr double kSeen = 0.3;       // of that: what they see well
constexpr double kRough = 5.0;      // of that, half the thickness: less than this leads nobody through
constexpr double kShallow = 5e-3;   // of the same: what ends no deeper is left to contacts and their push-out
constexpr double kLeast = 9e-4;     // the same of rigid bodies in the pieces of a sub-step, whose overlaps add up
constexpr double kGraze = 0.1;      // the same of rigid bodies on a way that ends no deeper than that
constexpr double kOfCurved = 1e-3;  // of its own thickness: the same of what is round beside triangles
constexpr double kWithin = 5.0;     // of what paths are straight to: half the activation distance, which contacts see
constexpr double kStraight = 0.5;   // of a safe approach: what paths beside a sheet are straight to
constexpr double kCreep = 0.01;     // of these depths: what rigid bodies may end deeper than they began
constexpr double kSink = 0.1;       // the same where they may end as deep as safe: as much again leads through in four
constexpr int kMostPieces = 4096;   // a body that turns farther, 160 times in a sub-step, is followed in larger turns

bool deforms(const Body& body) { return body.kind() == BodyKind::deformable; }

bool is_plane(const Body& body) { return body.shape->as<Plane>() != nullptr; }

/// Contacts hold every corner of what bends, and a ball has the same lowest point however it turns. What somebody pulls at
/// goes where it is pulled.
bool may_hide_from_plane(const Body& body) {
  return !deforms(body) && !is_plane(body) && body.shape->as<Sphere>() == nullptr && !body.pull;
}

/// The approach to a plane up to which contacts hold a mesh's corners, and looks at the end those that come round in flight,
/// metres.
double held_to_plane(const Body& body) { return body.shape->mesh() != nullptr ? body.shape->thickness() : 0.0; }

/// How far two points of one deforming body can come towards each other, metres.
double self_approach(const Body& body, const std::vector<Vec3>& nodes) {
  Vec3 mean = Vec3::Zero();
  for (std::size_t i = 0; i < nodes.size(); ++i) mean += body.world_vertices[i] - nodes[i];
  mean /= static_cast<double>(nodes.size());
  double most = 0.0;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    most = std::max(most, (body.world_vertices[i] - nodes[i] - mean).squaredNorm());
  return 2.0 * std::sqrt(most);
}

/// A share of the thickness, metres: where a rigid body is hollow, of its walls'. What bends is held to its edges in any case.
double safe_share(const Body& body) { return kSafe * (deforms(body) ? body.shape->thickness() : wall_of(*body.shape)); }

double safe_approach(const Body& body) {
  const double share = safe_share(body);
  return body.world_vertices.empty() ? share : std::min(share, body.mean_edge);
}

/// The approach that contacts of two bodies see well, metres: the smaller share, and where the search is one for triangles
/// of two surfaces, or a surface bends, no more than an edge of theirs.
double safe_for(const Body& a, const Body& b) {
  const bool has_shape = a.world_vertices.empty() || b.world_vertices.empty();
  if (has_shape && !deforms(a) && !deforms(b)) return std::min(safe_share(a), safe_share(b));
  return std::min(safe_approach(a), safe_approach(b));
}

/// As the pair's safe approach is, but of walls also where what is hollow bends, metres.
double seen_of(const Bodies& bodies, const UnsafeMotion::Pair& pair) {
  return std::min(pair.safe, kSafe * std::min(wall_of(*bodies[pair.a].shape), wall_of(*bodies[pair.b].shape)));
}

/// The same of any two bodies; of meshes if they are small.
bool is_known_clear(const Body& a, const Body& b, const SurfacePath& of_a, const SurfacePath& of_b, double depth) {
  if (deforms(a) || deforms(b)) return false;
  const bool a_is_mesh = a.shape->mesh() != nullptr, b_is_mesh = b.shape->mesh() != nullptr;
  if (a_is_mesh && b_is_mesh) return stays_beside(of_a, of_b, depth);
  if (a_is_mesh) return stay_off(*b.shape, of_b, of_a, depth);
  if (b_is_mesh) return stay_off(*a.shape, of_a, of_b, depth);
  const std::optional<RoundCore> core_a = round_core(*a.shape), core_b = round_core(*b.shape);
  return (core_a && core_b && stays_out(*core_a, of_a, *core_b, of_b, depth)) ||
         stay_apart(*a.shape, of_a, *b.shape, of_b, depth);
}

/// What is round, and not the triangles that stand for it in pictures.
bool is_curved(const Body& body) { return !is_faceted(*body.shape) && !is_plane(body); }

/// Whether triangles say of a body what its surface is to what is round: a mesh's do, and those of a box or a hull where
/// they are thin to it. Planes between the two tell most of the rest.
bool is_seen_as_triangles(const Body& body, const Body& by) {
  return body.shape->mesh() != nullptr || (is_faceted(*body.shape) && thick_beside_sheet(*body.shape, *by.shape) > 0.0);
}

/// Of what is round and such a body, how deep it may be in one of its triangles on its way, metres: to come through, it has to
/// be in it by about half its thickness.
double curved_graze(const Body& a, const Body& b) {
  if (is_curved(a) && is_seen_as_triangles(b, a)) return kOfCurved * a.shape->thickness();
  return is_curved(b) && is_seen_as_triangles(a, b) ? kOfCurved * b.shape->thickness() : 0.0;
}

void exchange(std::vector<Passage>& passages) {
  for (Passage& p : passages) {
    std::swap(p.point_a, p.point_b), std::swap(p.triangle_a, p.triangle_b);
    p.normal = -p.normal;
    const FeaturePair f = features_of_key(p.feature);
    p.feature = feature_key(f.kind_b, f.index_b, f.kind_a, f.index_a);
  }
}

/// Of what is round and what is seen as triangles, whichever is which, by the formula; a ball or capsule touches all along its way
/// as a rule, and distances tell it as far as they do.
std::optional<std::vector<Passage>> passages_by_formula(const Body& a, const SurfacePath& of_a, const Body& b,
                                                        const SurfacePath& of_b, const PassageSettings& settings) {
  if (is_faceted(*a.shape) && is_curved(b)) {
    auto passages = passages_by_formula(b, of_b, a, of_a, settings);
    if (passages) exchange(*passages);
    return passages;
  }
  if (!is_curved(a) || !is_seen_as_triangles(b, a) || deforms(a) || deforms(b)) return std::nullopt;
  const std::optional<RoundCore> core = round_core(*a.shape);
  if (core && stays_out(*core, of_a, of_b, settings.depth)) return std::vector<Passage>();
  if (b.shape->mesh() == nullptr && stay_apart(*a.shape, of_a, *b.shape, of_b, settings.depth))
    return std::vector<Passage>();
  return first_solid_passages(*a.shape, of_a, of_b, settings);
}

/// Of a body and a plane, whichever is which.
std::vector<Passage> passages_through_plane(const Body& a, const SurfacePath& of_a, const Body& b,
                                            const SurfacePath& of_b, const PassageSettings& settings) {
  if (is_plane(a)) {
    std::vector<Passage> passages = passages_through_plane(b, of_b, a, of_a, settings);
    for (Passage& p : passages) std::swap(p.point_a, p.point_b), p.normal = -p.normal;
    return passages;
  }
  const auto passage = passage_through_plane(*a.shape, of_a, *b.shape->as<Plane>(), of_b, settings);
  return passage ? std::vector<Passage>{*passage} : std::vector<Passage>();
}

}  // namespace

struct MotionGuard::Known {
  MeshPointer made;  // the triangles of a shape that is no mesh
  std::unique_ptr<PathSurface> surface;
};

MotionGuard::MotionGuard() = default;
MotionGuard::~MotionGuard() = default;

const PathSurface& MotionGuard::surface_of(const Body& body) {
  Known& known = known_[body.shape.get()];
  if (known.surface == nullptr) {
    const SurfaceMesh* mesh = body.shape->mesh();
    if (mesh == nullptr) known.made = make_surface(body.shape->drawn()), mesh = known.made.get();
    known.surface = std::make_unique<PathSurface>(*mesh);
  }
  return *known.surface;
}

void MotionGuard::open(const Bodies& bodies) {
  const std::size_t count = static_cast<std::size_t>(bodies.size().value());
  start_.resize(count), turns_.resize(count), nodes_.resize(count), sweeps_.resize(count), boxes_.resize(count);
  if (bodies.all_active()) look_at_all(bodies);
  for (const BodyIndex b : bodies.active()) {
    start_[b] = bodies[b].pose;
    nodes_[b].clear();
    if (deforms(bodies[b])) nodes_[b] = bodies[b].world_vertices;
  }
}

void MotionGuard::look_at_all(const Bodies& bodies) {
  least_ = INFINITY;
  all_rigid_ = true;
  for (const Body& body : bodies) {
    if (body.deleted) continue;
    if (!is_plane(body)) least_ = std::min(least_, safe_approach(body));
    all_rigid_ = all_rigid_ && !deforms(body);
  }
}

void MotionGuard::follow(Bodies& bodies, const TimeIntegration& how, double end) {
  for (const BodyIndex b : bodies.active()) {
    Body& body = bodies[b];
    turns_[b].clear();
    if (body.asleep || !body.is_moving() || deforms(body)) continue;
    const double angle = body.twist().angular.norm() * how.time_step;
    int pieces = 1;
    while (pieces * kTurn < angle && pieces < kMostPieces) pieces *= 2;
    if (pieces == 1) continue;
    ByteWriter kept;
    body.save(kept);
    try {
      for (int k = 1; k < pieces; ++k) {
        TimeIntegration part = how;
        part.time_step = how.time_step * k / pieces;
        body.advance(part, end - how.time_step + part.time_step);
        turns_[b].push_back(body.pose);
        ByteReader back(kept.bytes());
        body.restore(back);
      }
    } catch (const DivergenceError&) {  // integrate() will meet it too, and knows the group
      turns_[b].clear();
      ByteReader back(kept.bytes());
      body.restore(back);
    }
    body.update_world_vertices();
  }
}

MotionGuard::Sweep MotionGuard::sweep_of(const Body& body, BodyIndex b) const {
  const Pose& start = start_[b];
  const std::vector<Pose>& turns = turns_[b];
  const std::vector<Vec3>& nodes = nodes_[b];
  Sweep s;
  s.box = body.bounds();
  if (deforms(body)) {
    for (const Vec3& x : nodes) s.box.include(x);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      s.turn = std::max(s.turn, (body.world_vertices[i] - nodes[i]).norm());
    return s;
  }
  s.shift = body.pose.position - start.position;
  if (s.shift.isZero(0.0) && body.pose.rotation == start.rotation) return s;
  const bool is_ball = body.shape->as<Sphere>() != nullptr;  // whose turning moves none of its surface
  double angle = 0.0;
  Pose last = start;
  const auto go = [&](const Pose& to) {
    angle += rotation_log(to.rotation * last.rotation.transpose()).norm();
    last = to;
  };
  for (const Pose& pose : turns) go(pose);
  go(body.pose);
  s.turn = is_ball ? 0.0 : angle * body.radius;
  // about its centre it stays within its radius
  for (const Vec3& at : {start.position, body.pose.position}) s.box.include(Aabb{at, at}.inflated(body.radius));
  for (const Pose& pose : turns) s.box.include(Aabb{pose.position, pose.position}.inflated(body.radius));
  return s;
}

SurfacePath MotionGuard::path_of(const Body& body, BodyIndex b) {
  SurfacePath path;
  if (!is_plane(body)) path.of = &surface_of(body);
  if (deforms(body)) {
    path.start = nodes_[b], path.end = body.world_vertices;
    path.exempt = body.exempt_pairs.get();
    return path;
  }
  path.poses.push_back(start_[b]);
  path.poses.insert(path.poses.end(), turns_[b].begin(), turns_[b].end());
  path.poses.push_back(body.pose);
  return path;
}

/// A body's contacts with itself are found within the activation distance and no farther, and a crossing of its surface,
/// however shallow, is one for good: it is looked at whenever it is told to keep off itself and moves.
void MotionGuard::add_self(const Bodies& bodies, Continuous which, std::vector<UnsafeMotion::Pair>& pairs) {
  for (const BodyIndex b : bodies.active()) {
    if (!bodies[b].can_touch_itself()) continue;
    const double both = self_approach(bodies[b], nodes_[b]), safe = safe_approach(bodies[b]);
    if (both > (which == Continuous::off ? safe : 0.0)) pairs.push_back({b, b, {}, 0.5 * both, 0.5 * both, both, safe});
  }
}

std::vector<UnsafeMotion::Pair> MotionGuard::pairs_at_risk(const Bodies& bodies, Continuous which, bool is_rough) {
  std::vector<double> far;
  for (const BodyIndex b : bodies.active()) {
    sweeps_[b] = sweep_of(bodies[b], b);
    boxes_[b] = sweeps_[b].box;
    far.push_back(sweeps_[b].way());
  }
  // a pair approaches by no more than the two that move farthest: most scenes are done here
  const auto two = far.begin() + std::min<std::ptrdiff_t>(2, static_cast<std::ptrdiff_t>(far.size()));
  std::partial_sort(far.begin(), two, far.end(), std::greater<>());
  const double most = std::accumulate(far.begin(), two, 0.0);
  std::vector<UnsafeMotion::Pair> pairs;
  add_self(bodies, which, pairs);
  const bool all = which == Continuous::on;
  const double seen = which == Continuous::off ? 1.0 : is_rough && all_rigid_ ? kRough : kSeen;
  if (most == 0.0 || (!all && most <= seen * least_)) return pairs;

  if (broad_phase_ == nullptr) broad_phase_ = broad_phases().front().make();
  std::vector<BoxPair> box_pairs;
  find_moving_pairs(bodies, boxes_, *broad_phase_, box_pairs);
  for (const auto& [first, second] : box_pairs) {
    const BodyIndex a(std::min(first, second)), b(std::max(first, second));
    const Body &of_a = bodies[a], &of_b = bodies[b];
    if (!may_respond(bodies, a, b)) continue;
    const double both = approach(sweeps_[a], sweeps_[b]);
    // what is through a plane is inside it still; but what turns may come down with points that have no contacts
    if (is_plane(of_a) || is_plane(of_b)) {
      const Body& other = is_plane(of_a) ? of_b : of_a;
      if (which == Continuous::off || !may_hide_from_plane(other) || both <= held_to_plane(other)) continue;
    }
    const double safe = safe_for(of_a, of_b);
    if (all || both > seen * safe) pairs.push_back({a, b, {}, sweeps_[a].way(), sweeps_[b].way(), both, safe});
  }
  std::sort(pairs.begin(), pairs.end(),
            [](const auto& l, const auto& r) { return std::tie(l.a, l.b) < std::tie(r.a, r.b); });
  return pairs;
}

void MotionGuard::search(const Bodies& bodies, std::vector<UnsafeMotion::Pair>& pairs, const PassagesOf& settings,
                         Depth depth) {
  std::vector<std::pair<SurfacePath, SurfacePath>> paths;
  paths.reserve(pairs.size());
  for (const UnsafeMotion::Pair& pair : pairs)
    paths.emplace_back(path_of(bodies[pair.a], pair.a), path_of(bodies[pair.b], pair.b));
  parallel_for(pairs.size(), 1, [&](std::size_t i) {
    const Body &of_a = bodies[pairs[i].a], &of_b = bodies[pairs[i].b];
    PassageSettings own = settings(pairs[i].a, pairs[i].b);
    const double seen = seen_of(bodies, pairs[i]);
    if (depth == Depth::safe)
      own.depth = pairs[i].safe;
    else if (depth == Depth::rough && !deforms(of_a) && !deforms(of_b)) {
      own.depth = std::max(own.depth, pairs[i].safe);
      own.creep = kSink * own.depth;
    } else if (deforms(of_a) || deforms(of_b))
      own.depth = pairs[i].a != pairs[i].b ? std::max(own.depth, kShallow * seen) : own.depth;
    else {
      own.depth = std::max(own.depth, (depth == Depth::least ? kLeast : kShallow) * seen);
      if (depth == Depth::graze) own.depth = std::max(own.depth, std::min(kGraze * seen, kWithin * own.reach));
      own.creep = kCreep * own.depth;
    }
    own.graze = curved_graze(of_a, of_b);
    if (!deforms(of_a) && !deforms(of_b) && thick_beside_sheet(*of_a.shape, *of_b.shape) > 0.0)
      own.reach = std::max(own.reach, kStraight * pairs[i].safe);
    if (is_plane(of_a) || is_plane(of_b)) {
      pairs[i].passages = passages_through_plane(of_a, paths[i].first, of_b, paths[i].second, own);
      return;
    }
    if (auto known = passages_by_formula(of_a, paths[i].first, of_b, paths[i].second, own)) {
      pairs[i].passages = std::move(*known);
      return;
    }
    if (is_known_clear(of_a, of_b, paths[i].first, paths[i].second, own.depth)) return;
    pairs[i].passages = pairs[i].a == pairs[i].b ? first_self_passages(paths[i].first, own)
                                                 : first_passages(paths[i].first, paths[i].second, own);
  });
}

/// Takes out the pairs of rigid bodies that slide through one another's corners by little and are out again at the end: a
/// shorter motion would end no better.
void MotionGuard::forgive_grazes(const Bodies& bodies, std::vector<UnsafeMotion::Pair>& pairs,
                                 const PassagesOf& settings, const OverlapsOf& overlaps) {
  std::vector<UnsafeMotion::Pair> grazing;
  std::vector<BodyPair> of;
  for (const UnsafeMotion::Pair& pair : pairs) {
    if (deforms(bodies[pair.a]) || deforms(bodies[pair.b])) continue;
    grazing.push_back(pair), grazing.back().passages.clear();
    of.push_back({pair.a, pair.b});
  }
  if (grazing.empty()) return;
  const std::vector<double> depths = overlaps(of);
  std::size_t i = 0;
  std::erase_if(grazing, [&](const UnsafeMotion::Pair& pair) {
    const double allowed = settings(pair.a, pair.b).depth;
    return depths[i++] > std::max(allowed, kShallow * seen_of(bodies, pair));
  });
  search(bodies, grazing, settings, Depth::graze);
  std::erase_if(pairs, [&](const UnsafeMotion::Pair& pair) {
    return std::any_of(grazing.begin(), grazing.end(), [&](const UnsafeMotion::Pair& g) {
      return g.a == pair.a && g.b == pair.b && g.passages.empty();
    });
  });
}

MotionGuard::PairMotion MotionGuard::motion_of(const Bodies& bodies, BodyIndex a, BodyIndex b) {
  const Sweep of_a = sweep_of(bodies[a], a), of_b = sweep_of(bodies[b], b);
  PairMotion motion{is_plane(bodies[a]) || is_plane(bodies[b]), overlap(of_a.box, of_b.box), of_a.way(), of_b.way(),
                    approach(of_a, of_b)};
  motion.safe = safe_for(bodies[a], bodies[b]);
  return motion;
}

void MotionGuard::find_passages(const Bodies& bodies, UnsafeMotion& motion, const PassagesOf& settings) {
  search(bodies, motion.pairs, settings, Depth::safe);
}

std::optional<UnsafeMotion> MotionGuard::look(const Bodies& bodies, Continuous which, const PassagesOf& settings,
                                              bool is_rough, bool is_cut, const OverlapsOf& overlaps) {
  std::vector<UnsafeMotion::Pair> pairs = pairs_at_risk(bodies, which, is_rough);
  if (pairs.empty()) return std::nullopt;
  if (which == Continuous::off) return UnsafeMotion{std::move(pairs)};
  search(bodies, pairs, settings, is_rough ? Depth::rough : is_cut ? Depth::least : Depth::shallow);
  std::erase_if(pairs, [](const UnsafeMotion::Pair& pair) { return pair.passages.empty(); });
  if (!is_cut && overlaps) forgive_grazes(bodies, pairs, settings, overlaps);
  if (pairs.empty()) return std::nullopt;
  return UnsafeMotion{std::move(pairs)};
}

}  // namespace impinge
