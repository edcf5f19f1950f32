// What is drawn to: an own framebuffer object, multisampled, resolved before it is read.
#pragma once

#include "viewer/image/image.hpp"

namespace impinge {

class Framebuffer {
 public:
  /// `samples` 0 or 1: not multisampled. Throws InternalError if the size cannot be had.
  Framebuffer(int width, int height, int samples);
  ~Framebuffer();
  Framebuffer(const Framebuffer&) = delete;
  Framebuffer& operator=(const Framebuffer&) = delete;

  int width() const { return width_; }
  int height() const { return height_; }
  void bind() const;
  /// Averages the samples; what is drawn from here on goes to the resolved picture (no depth there).
  void resolve() const;
  /// Reads the resolved picture, top row first.
  void read(Image& out);

 private:
  int width_, height_, samples_;
  unsigned drawn_ = 0, resolved_ = 0, color_ = 0, depth_ = 0, resolved_color_ = 0;
  std::vector<std::uint8_t> rows_;  // as OpenGL gives them: RGBA, bottom row first
};

}  // namespace impinge
