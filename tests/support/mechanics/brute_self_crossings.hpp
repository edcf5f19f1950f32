// Self-crossings by looking at every pair of triangles.
#pragma once

#include <algorithm>

#include "engine/bodies/body.hpp"
#include "engine/geometry/triangle_intersection.hpp"

namespace impinge::test {

/// Crossing pairs of triangles of the body's own surface that share no vertex.
inline std::int64_t brute_self_crossings(const Body& body) {
  const std::vector<Triangle>& triangles = body.shape->mesh()->mesh.triangles;
  std::vector<TriangleCorners> corners;
  std::vector<Aabb> boxes;  // wide enough for what triangles_intersect takes for touching
  for (const Triangle& t : triangles) {
    corners.push_back({body.world_vertices[t[0]], body.world_vertices[t[1]], body.world_vertices[t[2]]});
    const Aabb box = bounds_of(corners.back()[0], corners.back()[1], corners.back()[2]);
    boxes.push_back(box.inflated(1e-6 * box.extent().maxCoeff()));
  }
  std::int64_t count = 0;
  for (std::size_t s = 0; s < triangles.size(); ++s)
    for (std::size_t t = s + 1; t < triangles.size(); ++t) {
      if (!overlap(boxes[s], boxes[t])) continue;
      const bool share = std::any_of(triangles[s].begin(), triangles[s].end(), [&](int v) {
        return std::find(triangles[t].begin(), triangles[t].end(), v) != triangles[t].end();
      });
      if (!share && triangles_intersect(corners[s], corners[t])) ++count;
    }
  return count;
}

}  // namespace impinge::test
