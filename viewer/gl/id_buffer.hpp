// The pass that says for each pixel what it shows: layer, body or contact, and of a surface the triangle. Drawn by the
// shaders of the picture itself (built with IDS defined), so both have the same shapes; only edges are not smooth, and
// a soft rim belongs to its mark where it is at least a third there. Integers in an own framebuffer; the picture stays
// as it is.
#pragma once

#include "engine/world/step_record.hpp"
#include "viewer/draw/draw_list.hpp"
#include "viewer/image/id_image.hpp"

namespace impinge {

class IdBuffer {
 public:
  /// A context must be current, here and in every call. Throws InternalError if the size cannot be had.
  IdBuffer(int width, int height);
  ~IdBuffer();
  IdBuffer(const IdBuffer&) = delete;
  IdBuffer& operator=(const IdBuffer&) = delete;

  int width() const { return width_; }
  int height() const { return height_; }
  /// For Renderer::draw_ids.
  void bind_cleared() const;
  /// Fills width, height, object and part.
  void read(IdImage& out);

 private:
  int width_, height_;
  unsigned framebuffer_ = 0, ids_ = 0, depth_ = 0;
  std::vector<std::uint32_t> rows_;  // as OpenGL gives them: object and part, bottom row first
};

/// Names what is in the list, one object for each layer, kind of mark and body or contact, and gives each item the
/// object's index as its colour, a byte a channel, red the lowest.
std::vector<IdObject> code_colors(DrawList& list, const StepRecord& record);

}  // namespace impinge
