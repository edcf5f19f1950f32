// Planes as floors: a finite grid round what is looked at, seen from its upper side only.
#pragma once

#include "viewer/draw/draw_list.hpp"
#include "viewer/gl/buffers.hpp"
#include "viewer/gl/program.hpp"
#include "viewer/gl/view_transform.hpp"

namespace impinge {

class Grid {
 public:
  /// `ids`: for id buffers; colours are then ids (gl/id_buffer.hpp).
  explicit Grid(bool ids = false);
  /// Before the surfaces: it writes depth, so that what is below the floor stays hidden.
  void draw(const DrawPlane& plane, const Camera& camera, const ViewTransform& view, float pixel_scale);

 private:
  Program program_;
  VertexArray array_;
};

}  // namespace impinge
