// What is drawn to: an own framebuffer object, one sample a pixel.
#pragma once

#include "viewer/draw/palette.hpp"
#include "viewer/image/image.hpp"

namespace impinge {

class Framebuffer {
 public:
  /// Throws InternalError if the size cannot be had.
  Framebuffer(int width, int height);
  ~Framebuffer();
  Framebuffer(const Framebuffer&) = delete;
  Framebuffer& operator=(const Framebuffer&) = delete;

  int width() const { return width_; }
  int height() const { return height_; }
  void bind() const;
  /// Binds it, all of one colour.
  void clear(Color color);
  /// A part of it; its upper left corner at (x, y).
  void clear(Color color, int x, int y, int width, int height);
  /// Smooths the edges of what has been drawn; its depth stays.
  void smooth_edges();
  /// Copies itself into `target`, its upper left corner at (x, y) from there.
  void copy_to(Framebuffer& target, int x, int y) const;
  /// Copies itself into one of the same size, depths too.
  void copy_with_depth_to(Framebuffer& target) const;
  /// Top row first. `with_alpha`: colours are taken as times their alpha, and come out without that factor.
  void read(Image& out, bool with_alpha = false);

 private:
  void read_rows();

  int width_, height_;
  unsigned framebuffer_ = 0, color_ = 0, depth_ = 0;
  std::vector<std::uint8_t> rows_, smooth_rows_;  // as OpenGL gives them: RGBA, bottom row first
};

}  // namespace impinge
