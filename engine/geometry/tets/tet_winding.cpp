#include "engine/geometry/tets/tet_winding.hpp"

#include <algorithm>

namespace impinge {
namespace {

// corners (a, b) of an edge, then (c, d) such that (a, b, c, d) has the tetrahedron's orientation
constexpr std::array<std::array<int, 4>, 6> kEdgeCorners = {
    {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 2, 0, 3}, {1, 3, 2, 0}, {2, 3, 0, 1}}};

struct Part {
  std::array<int, 2> edge, others;
};

/// Whether the parts close a ring: every corner is left once for each time it is entered.
bool closes(const std::vector<Part>& parts, std::size_t begin, std::size_t end) {
  std::vector<int> from, to;
  for (std::size_t k = begin; k < end; ++k) {
    from.push_back(parts[k].others[0]);
    to.push_back(parts[k].others[1]);
  }
  std::sort(from.begin(), from.end());
  std::sort(to.begin(), to.end());
  return from == to;
}

}  // namespace

TetWinding::TetWinding(const TetMesh& rest) {
  std::vector<Part> parts;
  parts.reserve(6 * rest.tets.size());
  for (const Tet& tet : rest.tets)
    for (const auto& [a, b, c, d] : kEdgeCorners) {
      Part part{{tet[a], tet[b]}, {tet[c], tet[d]}};
      if (part.edge[0] > part.edge[1]) part = {{tet[b], tet[a]}, {tet[d], tet[c]}};
      parts.push_back(part);
    }
  std::stable_sort(parts.begin(), parts.end(), [](const Part& p, const Part& q) { return p.edge < q.edge; });
  begin_.push_back(0);
  for (std::size_t k = 0, next; k < parts.size(); k = next) {
    for (next = k; next < parts.size() && parts[next].edge == parts[k].edge;) ++next;
    if (!closes(parts, k, next)) continue;
    edge_.push_back(parts[k].edge);
    for (std::size_t i = k; i < next; ++i) ring_.push_back(parts[i].others);
    begin_.push_back(static_cast<int>(ring_.size()));
  }
}

int TetWinding::winding(const VecX& x, int i) const {
  const Vec3 a = x.segment<3>(3 * edge_[i][0]);
  const Vec3 axis = Vec3(x.segment<3>(3 * edge_[i][1])) - a;
  // two directions across the axis; the ring seen along it is a closed polygon, and the winding is how often it crosses
  // the half-line of the first direction from right to left
  int smallest = 0;
  axis.cwiseAbs().minCoeff(&smallest);
  const Vec3 right = axis.cross(Vec3::Unit(smallest)), up = axis.cross(right);
  int count = 0;
  for (int k = begin_[i]; k < begin_[i + 1]; ++k) {
    const Vec3 p = Vec3(x.segment<3>(3 * ring_[k][0])) - a, q = Vec3(x.segment<3>(3 * ring_[k][1])) - a;
    const double pu = up.dot(p), qu = up.dot(q);
    if ((pu >= 0.0) == (qu >= 0.0)) continue;
    // where the side crosses the line of `right`: its sign, times |qu − pu|
    const double side = right.dot(p) * qu - right.dot(q) * pu;
    if (qu > pu && side > 0.0) ++count;
    if (qu < pu && side < 0.0) --count;
  }
  return count;
}

}  // namespace impinge
