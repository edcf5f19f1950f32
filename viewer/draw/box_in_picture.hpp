// Where a box of the world is in a picture.
#pragma once

#include "engine/geometry/aabb.hpp"
#include "viewer/draw/camera.hpp"

namespace impinge {

struct BoxInPicture {
  bool is_in = false;      ///< some of it, or nobody can say: past a corner of the picture
  bool is_behind = false;  ///< the eye, all of it
  double pixels = 0.0;     ///< the longer side of what it covers
};

/// Of a picture of that size, pixels; the box is not empty.
BoxInPicture box_in_picture(const Aabb& box, const Camera& camera, int width, int height);

}  // namespace impinge
