// The inside of a closed surface as intervals along a grid of parallel rays: cheap to make for millions of triangles,
// exact along the rays.
#pragma once

#include <span>

#include "engine/geometry/triangle_mesh.hpp"

namespace impinge {

class RayColumns {
 public:
  struct Interval {
    double low, high;
  };

  /// Rays along `axis`, `spacing` apart, over the surface's bounds. Surface: closed, oriented outwards, welded
  /// (neighbours share vertices). Where it overlaps itself, winding numbers above zero are inside.
  RayColumns(const TriangleMesh& surface, int axis, double spacing);

  int axis() const { return axis_; }
  int u_axis() const { return (axis_ + 1) % 3; }
  int v_axis() const { return (axis_ + 2) % 3; }
  // positions of rays; the grid goes on without end, only rays of some indices meet the surface
  double u(int i) const { return start_[0] + i * spacing_; }
  double v(int j) const { return start_[1] + j * spacing_; }
  /// Range of ray indices [first, last) with positions in [low, high].
  std::pair<int, int> u_range(double low, double high) const { return range(0, low, high); }
  std::pair<int, int> v_range(double low, double high) const { return range(1, low, high); }
  /// What is inside along ray (i, j): ascending, disjoint; nothing for a ray beside the surface's bounds.
  std::span<const Interval> inside(int i, int j) const {
    if (!exists(i, j)) return {};
    return {intervals_.data() + begin_[index(i, j)], begin_[index(i, j) + 1] - begin_[index(i, j)]};
  }
  /// Rays that leave the surface as often as they enter it only after rounding decided otherwise: dropped, normally
  /// none.
  int dropped_rays() const { return dropped_; }
  bool is_dropped(int i, int j) const { return exists(i, j) && is_dropped_[index(i, j)] != 0; }

 private:
  bool exists(int i, int j) const { return i >= 0 && i < count_[0] && j >= 0 && j < count_[1]; }
  std::size_t index(int i, int j) const { return static_cast<std::size_t>(j) * count_[0] + i; }
  std::pair<int, int> range(int k, double low, double high) const;

  int axis_;
  double spacing_;
  std::array<double, 2> start_{};
  std::array<int, 2> count_{};
  std::vector<std::size_t> begin_;
  std::vector<Interval> intervals_;
  std::vector<char> is_dropped_;
  int dropped_ = 0;
};

}  // namespace impinge
