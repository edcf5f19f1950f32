// Triangles of a rigid surface that something may be near, by a walk down its tree of discs; ascending.
#pragma once

#include <algorithm>

#include "engine/geometry/surface/normal_cones.hpp"

namespace impinge {

/// A disc in the frame of its surface.
struct PlacedDisc {
  Vec3 center, normal;  ///< normal zero: not known
  double radius, thickness;
};

inline PlacedDisc disc_of(const DiscTree& discs, int level, int j, int k) {
  const DiscTree::Node& node = discs.node(level, j);
  const auto column = [&](const float(&rows)[3][4]) { return Vec3(rows[0][k], rows[1][k], rows[2][k]); };
  return {discs.origin() + column(node.center), column(node.normal), node.radius[k], node.thickness[k]};
}

/// Those below discs that `meets(disc, level, node, place in the node)` lets through with all above them.
template <class Meets>
std::vector<int> search_discs(const DiscTree& discs, Meets&& meets) {
  std::vector<int> found;
  std::vector<std::pair<int, int>> waiting;  // levels, and nodes of them
  if (discs.triangle_count() > 0) waiting.emplace_back(0, 0);
  while (!waiting.empty()) {
    const auto [level, j] = waiting.back();
    waiting.pop_back();
    for (int k = 0; k < discs.disc_count(level, j); ++k) {
      if (!meets(disc_of(discs, level, j, k), level, j, k)) continue;
      if (level + 1 < discs.levels())
        waiting.emplace_back(level + 1, 4 * j + k);
      else
        found.push_back(discs.order()[static_cast<std::size_t>(4 * j + k)]);
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

/// At least those within `reach` of a solid that hold a place nearer to it than everything round that place: on a smooth
/// surface few, however finely it is cut. `away(x)`: from x to the nearest point of the solid, zero in it, metres.
/// `or_inside`: also places that see the solid through the surface.
template <class Away>
std::vector<int> seen_triangles(const SurfaceMesh& surface, double reach, bool or_inside, Away&& away) {
  const NormalCones& cones = normal_cones(surface);
  return search_discs(surface.discs(), [&](const PlacedDisc& disc, int level, int j, int k) {
    const Vec3 way = away(disc.center);
    const double most = reach + disc.radius;
    return way.squaredNorm() <= most * most && cones.may_see(level, j, k, way, disc.radius, or_inside);
  });
}

}  // namespace impinge
