// Points, lines, arrows and laid-over triangles: flat marks whose sizes are in pixels, with soft edges.
#pragma once

#include <functional>

#include "viewer/draw/draw_list.hpp"
#include "viewer/gl/buffers.hpp"
#include "viewer/gl/program.hpp"
#include "viewer/gl/view_transform.hpp"

namespace impinge {

class Marks {
 public:
  /// A context must be current, here and in every call. `ids`: for id buffers; colours are then ids (gl/id_buffer.hpp).
  explicit Marks(bool ids = false);

  /// Draws them over the surfaces whose depth is in the bound framebuffer; `pixel_scale` multiplies sizes in pixels.
  void draw(const DrawList& list, const ViewTransform& view, float pixel_scale);

 private:
  /// A line or an arrow: both ends in the eye's axes.
  struct Segment {
    Eigen::Vector3f a, b;
    std::array<std::uint8_t, 4> color;
    float width;
  };
  struct Disc {
    Eigen::Vector3f position;
    std::array<std::uint8_t, 4> color;
    float diameter, rim;
  };
  struct Corner {
    Eigen::Vector3f position;
    std::array<std::uint8_t, 4> color;
  };

  void draw_triangles(const DrawList& list, const ViewTransform& view, Depth depth);
  void draw_lines(const DrawList& list, const ViewTransform& view, float pixel_scale, Depth depth);
  void draw_arrows(const DrawList& list, const ViewTransform& view, float pixel_scale, Depth depth, bool heads);
  void draw_points(const DrawList& list, const ViewTransform& view, float pixel_scale, Depth depth);
  void draw_segments(const std::vector<Segment>& segments, const ViewTransform& view, bool heads, float rim,
                     Depth depth);

  Program segment_program_, point_program_, flat_program_;
  VertexArray segment_array_, point_array_, flat_array_;
};

}  // namespace impinge
