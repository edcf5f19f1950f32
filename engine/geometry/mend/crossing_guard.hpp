// Which triangles of a surface that is being changed would meet others after a change: asked before each one.
#pragma once

#include <span>

#include "engine/geometry/box_tree.hpp"
#include "engine/geometry/distance.hpp"

namespace impinge {

/// A triangle as it would be.
struct NewTriangle {
  Triangle vertices;
  TriangleCorners corners;
};

class CrossingGuard {
 public:
  /// What it is given must outlive it, and is read again at each call. Triangles with a vertex in `tangled` cross
  /// something already: they are not looked at.
  CrossingGuard(const std::vector<Triangle>& triangles, const std::vector<Vec3>& vertices,
                const std::vector<char>& tangled);

  /// Whether one of the fan crosses or touches a triangle that is neither in the fan nor among those it `replaces`, in
  /// more than the vertices they share; or another one of the fan.
  bool is_crossing(std::span<const NewTriangle> fan, std::span<const int> replaces);
  /// Where the triangle stands now; the same for one that is gone.
  void move(int triangle);
  void drop(int triangle);

 private:
  bool is_tangled(const Triangle& t) const { return (tangled_[t[0]] | tangled_[t[1]] | tangled_[t[2]]) != 0; }
  TriangleCorners corners_of(int triangle) const;
  bool meets_surface(const NewTriangle& own);
  void build();
  void fit_from(int triangle);

  const std::vector<Triangle>& triangles_;
  const std::vector<Vec3>& vertices_;
  const std::vector<char>& tangled_;
  std::vector<char> gone_;
  std::vector<int> left_out_;  // by triangle: the question in which it was
  int question_ = 0;
  int in_tree_ = 0, dropped_ = 0;

  BoxTree tree_;
  std::vector<int> triangle_of_, slot_of_;  // the tree is over those that were there when it was built
  std::vector<int> leaf_of_;                // by slot
  std::vector<int> parent_;                 // by node
  std::vector<Aabb> own_, fitted_;          // by slot, by node
};

}  // namespace impinge
