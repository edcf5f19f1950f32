// Box against mesh. A box is a polyhedron: its contacts are those of two meshes, one of which has twelve triangles,
// with the box's own frame as the search structure. The box still counts as an exact shape: triangle -1, features of
// the box.
#include <algorithm>
#include <optional>

#include "engine/detection/contacts/contact_points.hpp"
#include "engine/detection/pairs/ball_against_mesh.hpp"
#include "engine/detection/pairs/primitive_pairs.hpp"
#include "engine/detection/triangles/triangle_pair_test.hpp"

namespace impinge {
namespace {

constexpr std::uint64_t kIndex = 0x3fffffffu;  // of a feature key: the index's bits

/// A feature key whose first feature is of the box's triangles, in terms of the box: the two triangles of a side and
/// the diagonal between them are one face (number: 0 to 5 for -z, +z, -y, +y, -x, +x as make_box_mesh lists them), so
/// that no contact changes its name when it crosses the diagonal.
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

void box_mesh(ContactSink& sink) {
  // a box is a polyhedron: the contacts of two meshes, one of which has twelve triangles
  const Collider& mesh = sink.second();
  const ContactQuery& query = sink.query();
  const OrientedBox oriented = world_box(sink.first());
  // as for two meshes, fast bodies widen the search by one edge length at most
  const double margin =
      query.activation + std::min(sink.reach(), std::max(2.0 * oriented.half.maxCoeff(), mesh.mean_edge));
  const SurfaceView view(mesh, 1);
  // wider by rounding: triangles that touch the box must not be lost
  const Vec3 reach = oriented.half + Vec3::Constant(margin + 1e-9 * (margin + oriented.half.sum()));
  const Vec3 extent = oriented.axes.cwiseAbs() * reach;
  std::vector<int> near;
  for (int t : triangles_near(view, static_cast<int>(mesh.mesh().mesh.triangles.size()),
                              {oriented.center - extent, oriented.center + extent})) {
    const TriangleCorners c = view.corners(t);
    if (overlap(bounds_of(oriented.to_local(c[0]), oriented.to_local(c[1]), oriented.to_local(c[2])),
                Aabb{-reach, reach}))
      near.push_back(t);
  }
  if (near.empty()) {
    add_enclosed_box(sink, view);
    return;
  }

  Collider box = sink.first();
  const Shape surface = make_box_mesh(oriented.half);
  std::vector<Vec3> corners;
  for (const Vec3& v : std::get<MeshPointer>(surface)->mesh.vertices) corners.push_back(box.pose.apply(v));
  box.shape = &surface;
  box.vertices = corners;
  box.mean_edge = mean_edge_length(box.mesh().mesh);
  const Collider local[2] = {box, mesh};
  const BodyPair pair{0, 1, margin};
  std::vector<TrianglePair> triangles;
  for (int t : near) {
    const TriangleCorners c = view.corners(t);
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
  std::stable_sort(found.begin(), found.end(),
                   [](const Collision& l, const Collision& r) { return l.feature < r.feature; });
  // A vertex of the mesh that lies below a side but beside the box is not in the box: the crossing of edges there tells
  // the depth, and only if there is nothing else does the shallowest such vertex stand for the overlap.
  std::optional<Candidate> beside;
  bool overlaps = false;
  for (const Collision& f : found) {
    Candidate c;
    c.point_first = f.point_a;
    c.point_second = f.point_b;
    c.normal = f.normal;
    c.owner = f.normal_owner == 0   ? NormalOwner::first
              : f.normal_owner == 1 ? NormalOwner::second
                                    : NormalOwner::neither;
    c.kind_first = static_cast<Feature>(f.feature >> 62);
    c.index_first = static_cast<int>(f.feature >> 32 & kIndex);
    c.kind_second = static_cast<Feature>(f.feature >> 30 & 3u);
    c.index_second = static_cast<int>(f.feature & kIndex);
    c.triangle_second = f.triangle_b;
    if (c.kind_first == Feature::face && f.normal_owner == 0) {
      const int axis = 2 - c.index_first / 2;
      const Vec3 x = oriented.to_local(c.point_second);
      Vec3 foot = x.cwiseMax(-oriented.half).cwiseMin(oriented.half);
      foot[axis] = x[axis];
      const bool is_beside = (x - foot).norm() > 1e-9 * oriented.half.sum();
      // on the side as a whole, not on the triangle of it that was found first
      foot[axis] = c.index_first % 2 == 0 ? -oriented.half[axis] : oriented.half[axis];
      c.point_first = oriented.to_world(foot);
      if (is_beside && f.gap < 0.0) {
        if (!beside || f.gap > beside->normal.dot(beside->point_first - beside->point_second)) beside = c;
        continue;
      }
    }
    overlaps = (sink.add_new(c) && f.gap < 0.0) || overlaps;
  }
  if (beside && !overlaps) sink.add_new(*beside);
}

}  // namespace impinge
