// Points that stay with the material of a body, and how a row of J acts on one.
#pragma once

#include "engine/core/index.hpp"
#include "engine/core/types.hpp"

namespace impinge {

/// In coordinates that move with the body, so that it can be carried to any later state of it.
struct MaterialPoint {
  Vec3 local = Vec3::Zero();   ///< in the body's frame; on a deformable surface: weights of the triangle's corners
  TriangleIndex triangle;      ///< of a point on a deformable surface
  int tet = -1;                ///< of a point within a deformable body
  Vec4 weight = Vec4::Zero();  ///< of the tetrahedron's nodes
};

struct NodeWeight {
  int node = -1;  ///< free node of the deformable body
  double weight = 0.0;
};

/// A share of a point's motion that no impulse changes.
struct Prescribed {
  double weight = 1.0;
  Vec3 velocity = Vec3::Zero();  ///< m/s, of the coming sub-step
};

/// What a row at a point of a body acts on.
struct CarriedPoint {
  Vec3 arm = Vec3::Zero();        ///< of what moves as a whole: from its centre of mass to where the row acts
  std::vector<NodeWeight> nodes;  ///< of what moves node by node: free nodes
  std::vector<Prescribed> prescribed;
  Vec3 velocity_before = Vec3::Zero();  ///< of the point before the sub-step, m/s
  Vec3 lead = Vec3::Zero();             ///< what of that is lead (stagger.hpp)
};

}  // namespace impinge
