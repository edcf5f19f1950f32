// How often a surface winds round a point, whatever the surface is like: open, crossing itself, with parts twice there.
// A whole number for a closed one; a fraction that passes 1/2 where a torn one would be if it were whole [Jacobson13].
#pragma once

#include <cmath>
#include <span>

#include "engine/geometry/box_tree.hpp"

namespace impinge {

class WindingTree {
 public:
  /// What it is given must outlive it.
  WindingTree(std::span<const Triangle> triangles, std::span<const Vec3> vertices);

  /// Far parts count as one dipole each [Barill18]: to within about 0.02.
  double at(const Vec3& x) const;
  bool is_inside(const Vec3& x) const { return at(x) > 0.5; }
  /// Of a surface that may face either way.
  bool winds_round(const Vec3& x) const { return std::abs(at(x)) > 0.5; }

 private:
  struct Dipole {
    Vec3 center = Vec3::Zero(), moment = Vec3::Zero();  ///< of the area; area times normal
    double reach = 0.0;                                 ///< how far its triangles lie from the centre
  };

  std::span<const Triangle> triangles_;
  std::span<const Vec3> vertices_;
  BoxTree tree_;
  std::vector<Dipole> dipoles_;  // by node
};

}  // namespace impinge
