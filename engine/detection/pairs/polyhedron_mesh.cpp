#include "engine/detection/pairs/polyhedron_mesh.hpp"

#include <algorithm>
#include <optional>

#include "engine/detection/contacts/contact_points.hpp"
#include "engine/detection/pairs/ball_against_mesh.hpp"
#include "engine/detection/pairs/mesh_in_mesh.hpp"
#include "engine/detection/pairs/triangles_near.hpp"
#include "engine/detection/pairs/way_apart.hpp"
#include "engine/detection/triangles/tree_pairs.hpp"
#include "engine/detection/triangles/triangle_pair_test.hpp"

namespace impinge {
namespace {

/// A feature key whose first feature is of the polyhedron's triangles, in terms of its faces: the triangles of a face
/// and the diagonals between them are one, so that no contact changes its name when it crosses a diagonal.
std::uint64_t with_face(std::uint64_t key, const PolyhedronView& solid) {
  const MeshTopology& topology = solid.surface->topology;
  auto [kind, kind_b, index, index_b] = features_of_key(key);
  if (kind == Feature::edge &&
      solid.face(topology.edges[index].triangle0) == solid.face(topology.edges[index].triangle1)) {
    kind = Feature::face;
    index = topology.edges[index].triangle0;
  }
  if (kind == Feature::face) index = solid.face(index);
  return feature_key(kind, index, kind_b, index_b);
}

Candidate candidate_of(const Collision& f) {
  Candidate c;
  c.point_first = f.point_a;
  c.point_second = f.point_b;
  c.normal = f.normal;
  c.owner = f.normal_owner == 0 ? NormalOwner::first : f.normal_owner == 1 ? NormalOwner::second : NormalOwner::neither;
  const FeaturePair features = features_of_key(f.feature);
  c.kind_first = features.kind_a, c.index_first = features.index_a;
  c.kind_second = features.kind_b, c.index_second = features.index_b;
  c.triangle_second = f.triangle_b;
  return c;
}

/// The polyhedron's frame, grown by the margin; wider by rounding: triangles that touch must not be lost.
struct Surrounding {
  Vec3 reach;
  Aabb box;
};
Surrounding surrounding(const OrientedBox& frame, double margin) {
  const Vec3 reach = frame.half + Vec3::Constant(margin + 1e-9 * (margin + frame.half.sum()));
  const Vec3 extent = frame.axes.cwiseAbs() * reach;
  return {reach, {frame.center - extent, frame.center + extent}};
}

/// Those of the triangles that reach into the polyhedron's frame, grown by the margin.
std::vector<int> in_frame(std::vector<int> triangles, const SurfaceView& view, const OrientedBox& frame,
                          const Surrounding& around) {
  std::erase_if(triangles, [&](int t) {
    const TriangleCorners c = view.corners(t);
    return !overlap(bounds_of(frame.to_local(c[0]), frame.to_local(c[1]), frame.to_local(c[2])),
                    Aabb{-around.reach, around.reach});
  });
  return triangles;
}

/// The mesh's triangles that may matter within the margin of the polyhedron.
std::vector<int> triangles_round_frame(const ContactSink& sink, const PolyhedronView& solid, double margin) {
  const Collider& mesh = sink.second();
  const Surrounding around = surrounding(solid.frame, margin);
  const double reach = margin + 1e-9 * (margin + solid.frame.half.sum());
  TouchedTriangles touched =
      touched_triangles(mesh, around.box, solid.touching, touch_limits(sink, reach), relative_motion(sink));
  return in_frame(std::move(touched.triangles), SurfaceView(mesh, 1), solid.frame, around);
}

/// How far apart, at most, what the sink keeps may be beyond the activation distance: as far as it comes nearer in the time
/// step. Its own reach is a bound over the whole of both; here only where they may meet counts, where a ball that rolls
/// on a floor stands nearly still.
double closing_reach(const ContactSink& sink) {
  constexpr int kRounds = 3;  // a shorter reach leaves less room to meet in
  const Collider &a = sink.first(), &b = sink.second();
  const ContactQuery& query = sink.query();
  double reach = sink.reach();
  if (!query.proximity || query.either_may_stop || !(query.time_step > 0.0)) return reach;
  if (!a.vertex_velocities.empty() || !b.vertex_velocities.empty()) return reach;
  const double turn = std::min(a.angular_velocity.norm(), b.angular_velocity.norm());
  for (int round = 0; round < kRounds; ++round) {
    const Aabb of_a = a.bounds.inflated(reach), of_b = b.bounds.inflated(reach);
    const Aabb where{of_a.min.cwiseMax(of_b.min), of_a.max.cwiseMin(of_b.max)};
    if (where.is_empty()) return reach;
    // the relative velocity is a linear function of the place: largest at a corner
    double fastest = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 x((corner & 1) != 0 ? where.max.x() : where.min.x(), (corner & 2) != 0 ? where.max.y() : where.min.y(),
                   (corner & 4) != 0 ? where.max.z() : where.min.z());
      fastest = std::max(fastest, (a.velocity_at(x) - b.velocity_at(x)).norm());
    }
    // the two points aren't at one place
    const double closes = query.time_step * (fastest + turn * reach) * (1.0 + 1e-6);
    reach = std::min(reach, std::max(query.activation, closes));
  }
  return reach;
}

/// A triangle of the polyhedron in the world.
struct OwnTriangle {
  OwnTriangle(const Collider& own, int triangle, double margin)
      : index(triangle),
        corners(corners_of(own, triangle)),
        bounds(bounds_of(corners[0], corners[1], corners[2])),
        search(search_box(corners, margin)) {}
  int index;
  TriangleCorners corners;
  Aabb bounds, search;
};

/// Pairs of the polyhedron's triangles and those of the mesh that are within the margin of the pair, ascending.
std::vector<TrianglePair> close_pairs(const Collider& own, const Collider& mesh, const std::vector<int>& near,
                                      const BodyPair& pair) {
  constexpr int kLookAtAll = 256;  // triangles: so many are looked at sooner than a tree is asked
  const SurfaceView view(mesh, 1);
  const double reach = tree_margin(own, mesh, pair.margin);
  const int count = static_cast<int>(own.mesh().mesh.triangles.size());
  std::vector<OwnTriangle> all;
  for (int k = 0; k < count && count <= kLookAtAll && !near.empty(); ++k) all.emplace_back(own, k, pair.margin);
  std::vector<TrianglePair> pairs;
  for (const int t : near) {
    const TriangleCorners c = view.corners(t);
    const Aabb box = search_box(c, pair.margin), around = bounds_of(c[0], c[1], c[2]).inflated(reach);
    const auto look = [&](const OwnTriangle& triangle) {
      if (!overlap(triangle.search, box)) return;
      const PairState state = test_triangles(triangle.corners, c, pair.margin);
      if (state != PairState::apart)
        pairs.push_back(
            {pair.a, pair.b, TriangleIndex(triangle.index), TriangleIndex(t), state == PairState::intersecting});
    };
    if (count > kLookAtAll)
      for (const int k : triangles_near(own, around)) look(OwnTriangle(own, k, pair.margin));
    for (const OwnTriangle& triangle : all)
      if (overlap(triangle.bounds, around)) look(triangle);
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

/// What a way out is looked for with, where surfaces cross: as far as features tell an overlap (proximity_points.cpp), and
/// a corner farther.
constexpr double kTold = 0.05;           // of the smaller body's size
constexpr std::size_t kWorthALook = 64;  // triangles of the polyhedron: with fewer the widest margin costs little
constexpr double kRunsDeeper = 0.4;      // a sine: edges that run more steeply against a way out may close it
constexpr double kTouching = 1e-4;       // of the mean edge

/// The polyhedron's corners, and those of the mesh, that may be in the other one, as far as pairs of triangles within the
/// margin tell.
class OverlapLook {
 public:
  OverlapLook(const PolyhedronView& solid, const Collider& own, const Collider& mesh)
      : solid_(solid), own_(own, 0), mesh_(mesh, 1), pose_(own.pose), touch_(kTouching * own.mean_edge) {
    for (const MeshTopology::Edge& e : solid.surface->topology.edges)
      longest_ = std::max(longest_, (own_.vertex(e.v0) - own_.vertex(e.v1)).norm());
  }

  double longest_edge() const { return longest_; }

  /// Whether a wider margin would show no more of the overlap: no corner of the mesh is in the solid, and each of the
  /// solid's that is in the mesh is seen, with its way out. (On the way along edges from one that is not seen to one that is
  /// outside each is deeper than the next by an edge at most.) `near`: triangles of the mesh within the widest margin.
  bool is_all(const std::vector<TrianglePair>& pairs, const std::vector<int>& near, double margin) {
    for (const int t : near)
      for (const int v : mesh_.triangle(t))
        if (solid_.touching.frame.distance(pose_.apply_inverse(mesh_.vertex(v))) < 0.0) return false;
    std::vector<std::pair<int, int>> met;  // a corner and a triangle of the mesh
    for (const TrianglePair& pair : pairs)
      for (const int v : own_.triangle(pair.triangle_a)) met.emplace_back(v, pair.triangle_b);
    std::sort(met.begin(), met.end());
    met.erase(std::unique(met.begin(), met.end()), met.end());
    bool is_any_outside = false;
    double deepest = 0.0;
    for (std::size_t i = 0; i < met.size();) {
      const int v = met[i].first;
      double least_sq = 1e300, depth = 0.0;
      Vec3 out = Vec3::Zero();
      for (; i < met.size() && met[i].first == v; ++i) {
        const PointTriangle p = closest_on_triangle(own_.vertex(v), mesh_.corners(met[i].second));
        if (p.squared_distance >= least_sq) continue;
        least_sq = p.squared_distance;
        const Vec3 normal = mesh_.normal(mesh_.feature(met[i].second, p.feature)), way = p.point - own_.vertex(v);
        depth = way.dot(normal) > 0.0 ? std::sqrt(least_sq) : 0.0;
        out = depth > touch_ ? Vec3(way / depth) : normal;
      }
      is_any_outside |= depth == 0.0;
      deepest = std::max(deepest, depth);
      if ((depth > 0.0 || least_sq <= touch_ * touch_) && runs_deeper(v, out)) return false;
    }
    return is_any_outside && deepest + longest_ <= margin;
  }

 private:
  bool runs_deeper(int v, const Vec3& out) {
    own_.star({Feature::vertex, v}, star_);
    return std::any_of(star_.begin(), star_.end(), [&](const Vec3& e) { return e.dot(out) < -kRunsDeeper; });
  }

  const PolyhedronView& solid_;
  const SurfaceView own_, mesh_;
  const Pose pose_;
  const double touch_;
  double longest_ = 0.0;
  std::vector<Vec3> star_;
};

/// Whether any triangle reaches into the frame, however far from the solid.
bool has_neighbours(const Collider& mesh, const OrientedBox& frame, double margin) {
  const Surrounding around = surrounding(frame, margin);
  return !in_frame(triangles_near(mesh, around.box), SurfaceView(mesh, 1), frame, around).empty();
}

/// What is nearer touches, metres: places are known no better.
double touch_of(const Collider& mesh, const PolyhedronView& solid) {
  return 1e-9 * (mesh.mean_edge + solid.frame.half.sum());
}

/// A closed mesh that lies in the polyhedron as a whole: out where its middle is nearest to the outside. Returns whether it does.
bool add_swallowed(ContactSink& sink, const PolyhedronView& solid) {
  const Collider& mesh = sink.second();
  const SolidFrame& own = solid.touching.frame;
  const double touch = touch_of(mesh, solid);
  const Aabb outer = sink.first().bounds.inflated(touch), &inner = mesh.bounds;
  if (!(outer.min.array() <= inner.min.array()).all() || !(inner.max.array() <= outer.max.array()).all()) return false;
  if (!mesh.mesh().topology.is_closed()) return false;
  const auto is_in = [&](const Vec3& x) { return own.distance(own.pose.apply_inverse(x)) <= touch; };
  for (const Triangle& t : mesh.mesh().mesh.triangles)
    if (!is_in(mesh.vertices[static_cast<std::size_t>(t[0])])) return false;
  const Vec3 local = solid.touching.outward(own.pose.apply_inverse(inner.center())), out = own.pose.rotation * local;
  int last = mesh.mesh().mesh.triangles.front()[0];
  for (const Triangle& t : mesh.mesh().mesh.triangles)
    for (const int v : t)
      if (out.dot(mesh.vertices[static_cast<std::size_t>(v)]) < out.dot(mesh.vertices[static_cast<std::size_t>(last)]))
        last = v;
  Candidate c;
  c.normal = -out;
  c.point_second = mesh.vertices[static_cast<std::size_t>(last)];
  c.point_first = c.point_second + (own.height(local) - out.dot(c.point_second - own.pose.position)) * out;
  c.kind_second = Feature::vertex;
  c.index_second = last;
  c.triangle_second = SurfaceView(mesh, 1).triangle_of({Feature::vertex, last});
  return sink.add(c);
}

/// How far it reaches from its frame's centre against a direction, metres.
auto reach_of(const PolyhedronView& solid) {
  return [&solid](const Vec3& n) {
    const SolidFrame& own = solid.touching.frame;
    return own.height(own.pose.rotation.transpose() * -n) + n.dot(solid.frame.center - own.pose.position);
  };
}

/// Where the surfaces cross, and no contact tells of an overlap: what touches, but doesn't part the two, says nothing of what
/// crosses there, as a corner exactly on a corner.
void add_way_apart(ContactSink& sink, const PolyhedronView& solid, double own_edge,
                   const std::vector<Collision>& found) {
  const Collider& mesh = sink.second();
  // in the mesh as a whole, but for a corner that touches its surface from within
  const auto reach_against = reach_of(solid);
  if (may_be_inside(mesh, sink.first()) && add_enclosed(sink, solid.frame.center, reach_against)) return;
  const double touch = kTouching * std::min(own_edge, mesh.mean_edge);
  const SurfaceView view(mesh, 1);
  const auto rises = [&](const Collision& f, int t) {
    const TriangleCorners c = view.corners(t);
    return std::any_of(c.begin(), c.end(), [&](const Vec3& x) { return f.normal.dot(x - f.point_b) > touch; });
  };
  const auto is_below = [&](const Collision& f) {
    if (f.gap > touch) return false;
    if (reach_against(f.normal) > f.normal.dot(solid.frame.center - f.point_a) + touch) return true;
    const FeaturePair on = features_of_key(f.feature);
    if (on.kind_b != Feature::vertex) return rises(f, f.triangle_b);
    const std::span<const int> round = view.triangles_round(on.index_b);
    return std::any_of(round.begin(), round.end(), [&](int t) { return rises(f, t); });
  };
  if (std::none_of(found.begin(), found.end(), is_below)) return;
  const PlacedConvex placed{solid.touching.frame.set, solid.touching.frame.pose};
  if (const auto way = way_apart(view, placed, sink.first().bounds, triangles_near(mesh, sink.first().bounds), touch))
    sink.add_new(*way);
}

}  // namespace

bool add_enclosed(ContactSink& sink, const Vec3& center, const std::function<double(const Vec3&)>& reach_against) {
  const std::optional<Collision> way = way_out(sink, SurfaceView(sink.second(), 1), center);
  if (!way) return false;
  Candidate c;
  c.normal = way->normal;
  c.point_first = center - reach_against(way->normal) * way->normal;
  c.point_second = way->point_b;
  c.triangle_second = way->triangle_b;
  c.kind_second = Feature::face;
  c.index_second = way->triangle_b;
  sink.add(c);
  return true;
}

void polyhedron_against_mesh(ContactSink& sink, const PolyhedronView& solid) {
  const Collider& mesh = sink.second();
  const ContactQuery& query = sink.query();
  // as for two meshes, fast bodies widen the search by one edge length at most
  const double most = std::max(2.0 * solid.frame.half.maxCoeff(), mesh.mean_edge);
  const double wide = query.activation + std::min(sink.reach(), most);
  BodyPair pair{BodyIndex(0), BodyIndex(1), query.activation + std::min(closing_reach(sink), most)};
  const auto reach_against = reach_of(solid);
  const std::vector<int> near = triangles_round_frame(sink, solid, pair.margin);
  if (near.empty()) {
    const bool may_enclose = may_be_inside(mesh, sink.first()) || !has_neighbours(mesh, solid.frame, wide);
    if (!may_enclose || !add_enclosed(sink, solid.frame.center, reach_against)) add_swallowed(sink, solid);
    return;
  }

  Collider own = sink.first();
  own.surface = solid.surface;
  std::vector<Vec3> corners;
  for (const Vec3& v : solid.surface->mesh.vertices) corners.push_back(own.pose.apply(v));
  own.vertices = corners;
  own.mean_edge = mean_edge_length(solid.surface->mesh);
  const Collider local[2] = {own, mesh};
  std::vector<TrianglePair> triangles = close_pairs(own, mesh, near, pair);
  // the margin is also how deep a way out is looked for
  if (pair.margin < wide && any_crosses(triangles)) {
    const std::vector<int> all_near = triangles_round_frame(sink, solid, wide);
    bool is_all = false;
    if (solid.surface->mesh.triangles.size() > kWorthALook) {
      OverlapLook look(solid, own, mesh);
      const double seen = query.activation + std::max(kTold * std::min(own.size, mesh.size), 2.0 * look.longest_edge());
      if (seen < wide) {
        pair.margin = std::max(pair.margin, seen);
        triangles = close_pairs(own, mesh, all_near, pair);
        is_all = look.is_all(triangles, all_near, pair.margin);
      }
    }
    if (!is_all) pair.margin = wide, triangles = close_pairs(own, mesh, all_near, pair);
  }
  // on its way out it comes near the surface from inside
  if (may_be_inside(sink.second(), sink.first()) && !any_crosses(triangles) &&
      add_enclosed(sink, solid.frame.center, reach_against))
    return;
  std::vector<Collision> found;
  // asked for intersections only, the sink keeps what overlaps
  proximity_contacts(local, pair, triangles, query.activation, query.proximity ? query.time_step : 0.0, found);
  for (Collision& f : found) f.feature = with_face(f.feature, solid);
  std::stable_sort(found.begin(), found.end(),
                   [](const Collision& l, const Collision& r) { return l.feature < r.feature; });
  // A vertex of the mesh that lies below a side but beside the polyhedron is not in it: the crossing of edges there
  // tells the depth, and only if there is nothing else does the shallowest such vertex stand for the overlap.
  std::optional<Candidate> beside;
  const double touch = touch_of(mesh, solid);
  bool overlaps = false, tells = false;  // by how much is rounding, or not
  for (const Collision& f : found) {
    Candidate c = candidate_of(f);
    if (c.kind_first == Feature::face && f.normal_owner == 0 && solid.place_on_face(c) && f.gap < 0.0) {
      if (!beside || f.gap > beside->normal.dot(beside->point_first - beside->point_second)) beside = c;
      continue;
    }
    if (!sink.add_new(c)) continue;
    overlaps = f.gap < 0.0 || overlaps;
    tells = f.gap < -touch || tells;
  }
  if (beside && !overlaps) sink.add_new(*beside);
  tells = tells || (beside && !overlaps && gap_of(*beside) < -touch);
  if (!tells && !add_swallowed(sink, solid) && any_crosses(triangles)) add_way_apart(sink, solid, own.mean_edge, found);
}

}  // namespace impinge
