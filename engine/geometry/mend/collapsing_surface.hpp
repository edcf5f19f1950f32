// A triangle surface whose edges are drawn together into vertices: who is round what, and which edges may go.
#pragma once

#include <span>

#include "engine/geometry/distance.hpp"
#include "engine/geometry/triangle_mesh.hpp"

namespace impinge {

class CollapsingSurface {
 public:
  /// The triangles round an edge: those that keep a side when it goes, and those that go with it.
  struct Ring {
    std::vector<int> kept, lost;
    std::vector<int> all() const;
  };

  explicit CollapsingSurface(const TriangleMesh& mesh);

  int triangle_count() const { return count_; }
  int vertex_count() const { return static_cast<int>(around_.size()); }
  const std::vector<Vec3>& vertices() const { return x_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }
  TriangleCorners corners(int triangle) const;
  /// What only one of two ends has: the edge leads away from the border.
  bool is_on_border(int vertex) const { return on_border_[vertex] != 0; }

  /// Vertices that an edge leads to, each once, in the order of the triangles.
  std::vector<int> neighbours(int vertex);
  /// Whether the surface without that edge is one of the same kind: no hole or handle closes, no part vanishes, sheets
  /// touch nowhere that they did not [Dey99]. False also where sheets meet in an end of the edge, or face opposite ways.
  bool may_join(int a, int b);
  Ring ring(int a, int b) const;
  /// `a` stands at `x` now, for both; ring(a, b) is `ring`.
  void join(int a, int b, const Vec3& x, const Ring& ring);

  /// What is left, without gaps in the numbers.
  TriangleMesh mesh() const;

 private:
  std::vector<Vec3> x_;
  std::vector<Triangle> triangles_;
  int count_;
  std::vector<char> gone_;
  std::vector<std::vector<int>> around_;  // triangles, by vertex
  std::vector<char> on_border_, is_fixed_;
  std::vector<int> seen_;  // by vertex: the question in which it was
  int question_ = 0;
};

}  // namespace impinge
