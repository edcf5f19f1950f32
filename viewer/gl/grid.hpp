// Planes as floors: a finite grid round what is looked at, seen from its upper side only.
#pragma once

#include "viewer/draw/draw_list.hpp"
#include "viewer/gl/buffers.hpp"
#include "viewer/gl/program.hpp"
#include "viewer/gl/view_transform.hpp"

namespace impinge {

class Grid {
 public:
  Grid();
  /// Before the surfaces: it writes depth, so that what is below the floor stays hidden.
  void draw(const DrawPlane& plane, const Camera& camera, const ViewTransform& view, float pixel_scale);

 private:
  Program program_{"grid"};
  VertexArray array_;
};

}  // namespace impinge
