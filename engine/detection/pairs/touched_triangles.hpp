// Where a convex solid may touch a rigid mesh: places of its surface that are nearer to the solid than everything round
// them. On a smooth surface they are few, however finely it is cut and however much of it is in reach, as under the flat
// side of a box; on a flat one the solid's own corners say it all.
#pragma once

#include "engine/detection/pairs/contact_sink.hpp"
#include "engine/detection/pairs/triangles_near.hpp"

namespace impinge {

/// How a solid moves against a mesh in the time step, in the solid's frame: metres and radians.
struct RelativeMotion {
  Vec3 shift = Vec3::Zero();  ///< of what is at the frame's origin
  Vec3 turn = Vec3::Zero();
};

/// What of a solid decides where it touches; the rest is its SolidFrame.
struct TouchingSolid {
  SolidFrame frame;
  /// Unit: the way out of the solid that is nearest from a point, or about so.
  std::function<Vec3(const Vec3&)> outward;
  /// What it could rest on, however it is tilted; of a curved solid nothing.
  std::span<const Vec3> corners;
};

struct TouchedTriangles {
  std::vector<int> triangles;  ///< ascending
  bool is_all = false;         ///< all within reach, none is left out
};

/// How far apart what touches may be, metres.
struct TouchLimits {
  double reach = 0.0;          ///< at most
  double activation = 0.0;     ///< beyond this only what the motion closes; and how deep the solid may be in the mesh
  bool is_either_way = false;  ///< whatever the motion: all within reach
};

/// The motion of the sink's first shape against its second in the time step of the query, and what the sink would keep.
RelativeMotion relative_motion(const ContactSink& sink);
TouchLimits touch_limits(const ContactSink& sink, double reach);

/// Of those whose bounds overlap the box at least the ones that hold a corner, an edge or a face against which the solid
/// can rest, as it is or turned by the motion. All within reach where they are few, where some may be deeper in the solid
/// than the activation distance, and of a mesh that deforms.
TouchedTriangles touched_triangles(const Collider& mesh, const Aabb& box, const TouchingSolid& solid,
                                   const TouchLimits& limits, const RelativeMotion& motion);

}  // namespace impinge
