// Two flat faces of deforming bodies meet in the corners of either and in every crossing of an edge of the one with an
// edge of the other. The gap at a crossing follows from the gaps at the ends of its edges, so that its row is one more
// than the faces have unknowns: two faces of 81 nodes have 162 corners and 444 crossings.
#include <algorithm>

#include "engine/detection/contacts/contact_points.hpp"
#include "engine/detection/contacts/surface_view.hpp"

namespace impinge {
namespace {

// sine of the fold below which an edge lies in a flat face: at the middle of the edge of a square the surfaces then
// overlap by less than a thousandth of the edge before a corner does
constexpr double kFlat = 2e-3;
// cosine between the normals of contacts that constrain the same side
constexpr double kSameSide = 0.95;

constexpr std::uint64_t kIndex = 0x3fffffffu;

Feature kind_of(std::uint64_t half) { return static_cast<Feature>(half >> 30); }
int index_of(std::uint64_t half) { return static_cast<int>(half & kIndex); }
std::uint64_t half_a(const Collision& c) { return c.feature >> 32; }
std::uint64_t half_b(const Collision& c) { return c.feature & 0xffffffffu; }

bool lies_flat(const SurfaceView& view, int e) {
  const MeshTopology::Edge& edge = view.edge(e);
  if (edge.triangle1 < 0) return false;
  const Vec3 n0 = view.face_normal(edge.triangle0), n1 = view.face_normal(edge.triangle1);
  return n0.dot(n1) > 0.0 && n0.cross(n1).norm() < kFlat;
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

void drop_flat_crossings(std::span<const Collider> colliders, const BodyPair& pair, std::vector<Collision>& contacts) {
  const SurfaceView a(colliders[pair.a], pair.a), b(colliders[pair.b], pair.b);
  VertexContacts of_a, of_b;
  for (const Collision& c : contacts) {
    if (kind_of(half_a(c)) == Feature::vertex) of_a.add(index_of(half_a(c)), c.normal);
    if (kind_of(half_b(c)) == Feature::vertex) of_b.add(index_of(half_b(c)), c.normal);
  }
  of_a.close(), of_b.close();
  std::erase_if(contacts, [&](const Collision& c) {
    if (kind_of(half_a(c)) != Feature::edge || kind_of(half_b(c)) != Feature::edge) return false;
    const MeshTopology::Edge &ea = a.edge(index_of(half_a(c))), &eb = b.edge(index_of(half_b(c)));
    return of_a.has(ea.v0, c.normal) && of_a.has(ea.v1, c.normal) && of_b.has(eb.v0, c.normal) &&
           of_b.has(eb.v1, c.normal) && lies_flat(a, index_of(half_a(c))) && lies_flat(b, index_of(half_b(c)));
  });
}

}  // namespace impinge
