#include "engine/detection/pairs/polyhedron_mesh.hpp"

#include <algorithm>
#include <optional>

#include "engine/detection/contacts/contact_points.hpp"
#include "engine/detection/pairs/ball_against_mesh.hpp"
#include "engine/detection/pairs/mesh_in_mesh.hpp"
#include "engine/detection/pairs/triangles_near.hpp"
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

/// Whether any triangle reaches into the frame, however far from the solid.
bool has_neighbours(const Collider& mesh, const OrientedBox& frame, double margin) {
  const Surrounding around = surrounding(frame, margin);
  return !in_frame(triangles_near(mesh, around.box), SurfaceView(mesh, 1), frame, around).empty();
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
  const double margin =
      query.activation + std::min(sink.reach(), std::max(2.0 * solid.frame.half.maxCoeff(), mesh.mean_edge));
  const SurfaceView view(mesh, 1);
  const auto reach_against = [&](const Vec3& n) {
    const SolidFrame& own = solid.touching.frame;
    return own.height(own.pose.rotation.transpose() * -n) + n.dot(solid.frame.center - own.pose.position);
  };
  const std::vector<int> near = triangles_round_frame(sink, solid, margin);
  if (near.empty()) {
    if (may_be_inside(mesh, sink.first()) || !has_neighbours(mesh, solid.frame, margin))
      add_enclosed(sink, solid.frame.center, reach_against);
    return;
  }

  Collider own = sink.first();
  own.surface = solid.surface;
  std::vector<Vec3> corners;
  for (const Vec3& v : solid.surface->mesh.vertices) corners.push_back(own.pose.apply(v));
  own.vertices = corners;
  own.mean_edge = mean_edge_length(solid.surface->mesh);
  const Collider local[2] = {own, mesh};
  const BodyPair pair{BodyIndex(0), BodyIndex(1), margin};
  const int count = static_cast<int>(solid.surface->mesh.triangles.size());
  std::vector<Aabb> boxes;
  boxes.reserve(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) boxes.push_back(search_box(corners_of(own, k), margin));
  std::vector<TrianglePair> triangles;
  for (int t : near) {
    const TriangleCorners c = view.corners(t);
    const Aabb box = search_box(c, margin);
    for (int k = 0; k < count; ++k) {
      if (!overlap(boxes[k], box)) continue;
      const PairState state = test_triangles(corners_of(own, k), c, margin);
      if (state != PairState::apart)
        triangles.push_back({pair.a, pair.b, TriangleIndex(k), TriangleIndex(t), state == PairState::intersecting});
    }
  }
  // on its way out it comes near the surface from inside
  if (may_be_inside(sink.second(), sink.first()) && !any_crosses(triangles) &&
      add_enclosed(sink, solid.frame.center, reach_against))
    return;
  std::sort(triangles.begin(), triangles.end());
  std::vector<Collision> found;
  // asked for intersections only, the sink keeps what overlaps
  proximity_contacts(local, pair, triangles, query.activation, query.proximity ? query.time_step : 0.0, found);
  for (Collision& f : found) f.feature = with_face(f.feature, solid);
  std::stable_sort(found.begin(), found.end(),
                   [](const Collision& l, const Collision& r) { return l.feature < r.feature; });
  // A vertex of the mesh that lies below a side but beside the polyhedron is not in it: the crossing of edges there
  // tells the depth, and only if there is nothing else does the shallowest such vertex stand for the overlap.
  std::optional<Candidate> beside;
  bool overlaps = false;
  for (const Collision& f : found) {
    Candidate c = candidate_of(f);
    if (c.kind_first == Feature::face && f.normal_owner == 0 && solid.place_on_face(c) && f.gap < 0.0) {
      if (!beside || f.gap > beside->normal.dot(beside->point_first - beside->point_second)) beside = c;
      continue;
    }
    overlaps = (sink.add_new(c) && f.gap < 0.0) || overlaps;
  }
  if (beside && !overlaps) sink.add_new(*beside);
}

}  // namespace impinge
