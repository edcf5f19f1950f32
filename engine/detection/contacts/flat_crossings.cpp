// Two flat faces of deforming bodies meet in the corners of either and in every crossing of an edge of the one with an
// edge of the other. The gap at a crossing follows from the gaps at the ends of its edges, so that its row is one more
// than the faces have unknowns: two faces of 81 nodes have 162 corners and 444 crossings.
#include <algorithm>

#include "engine/detection/contacts/contact_points.hpp"
#include "engine/detection/contacts/proximity_parts.hpp"

namespace impinge {
namespace {

// sine of the fold below which an edge lies in a flat face: at the middle of the edge of a square the surfaces then
// overlap by less than a thousandth of the edge before a corner does
constexpr double kHardlyBent = 2e-3;
bool lies_flat(const SurfaceView& view, int e) {
  const MeshTopology::Edge& edge = view.edge(e);
  if (edge.triangle1 < 0) return false;
  const Vec3 n0 = view.face_normal(edge.triangle0), n1 = view.face_normal(edge.triangle1);
  return n0.dot(n1) > 0.0 && n0.cross(n1).norm() < kHardlyBent;
}

/// The contacts that the vertices of one body have.
class VertexContacts {
 public:
  void add(int vertex, const Vec3& normal) { items_.emplace_back(vertex, normal); }
  void close() {
    std::stable_sort(items_.begin(), items_.end(), [](const auto& l, const auto& r) { return l.first < r.first; });
  }
  bool has(int vertex, const Vec3& normal) const {
    auto at = std::lower_bound(items_.begin(), items_.end(), vertex, [](const auto& l, int v) { return l.first < v; });
    for (; at != items_.end() && at->first == vertex; ++at)
      if (at->second.dot(normal) > kSameSide) return true;
    return false;
  }

 private:
  std::vector<std::pair<int, Vec3>> items_;
};

}  // namespace

std::vector<char> without_flat_crossings(std::span<const Collider> colliders, const BodyPair& pair,
                                         std::span<const Collision> contacts) {
  const SurfaceView a(colliders[pair.a], pair.a), b(colliders[pair.b], pair.b);
  VertexContacts of_a, of_b;
  for (const Collision& c : contacts) {
    const FeaturePair features = features_of_key(c.feature);
    if (features.kind_a == Feature::vertex) of_a.add(features.index_a, c.normal);
    if (features.kind_b == Feature::vertex) of_b.add(features.index_b, c.normal);
  }
  of_a.close(), of_b.close();
  const auto is_implied = [&](const Collision& c) {
    const FeaturePair features = features_of_key(c.feature);
    if (!features.is(Feature::edge, Feature::edge)) return false;
    const MeshTopology::Edge &ea = a.edge(features.index_a), &eb = b.edge(features.index_b);
    return of_a.has(ea.v0, c.normal) && of_a.has(ea.v1, c.normal) && of_b.has(eb.v0, c.normal) &&
           of_b.has(eb.v1, c.normal) && lies_flat(a, features.index_a) && lies_flat(b, features.index_b);
  };
  std::vector<char> stays;
  for (const Collision& c : contacts) stays.push_back(is_implied(c) ? 0 : 1);
  return stays;
}

}  // namespace impinge
