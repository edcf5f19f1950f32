// What stands behind the bodies, backdrop and floors: in most pictures the same as in the last one, so that it is drawn once
// and copied from then on, colours and depths bit for bit.
#pragma once

#include <memory>

#include "viewer/draw/draw_list.hpp"
#include "viewer/gl/framebuffer.hpp"
#include "viewer/gl/grid.hpp"

namespace impinge {

/// What is behind everything: two colours, one above the other.
struct Backdrop {
  Color top, bottom;
  bool is_transparent = false;  ///< nothing instead: pixels have an alpha, and their colours are times that
};

class Scenery {
 public:
  /// A context must be current, here and in every call.
  Scenery() = default;

  /// Whatever `target` shows, with its depths, is gone afterwards; the target is left bound.
  void draw(const Backdrop& backdrop, const std::vector<DrawPlane>& planes, const Camera& camera,
            const ViewTransform& view, float pixel_scale, Framebuffer& target);

 private:
  void paint(const Backdrop& backdrop, const std::vector<DrawPlane>& planes, const Camera& camera,
             const ViewTransform& view, float pixel_scale);

  Program backdrop_program_{"backdrop"};
  VertexArray nothing_;  // a core profile draws nothing without a vertex array
  Grid grid_;
  std::vector<double> last_, kept_;  // all that it depends on: of the last picture, and of the copy
  std::unique_ptr<Framebuffer> copy_;
};

}  // namespace impinge
