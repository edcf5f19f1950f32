#include "viewer/gl/framebuffer.hpp"

#include <algorithm>

#include "viewer/gl/edge_smoothing.hpp"
#include "viewer/gl/gl.hpp"

namespace impinge {

Framebuffer::Framebuffer(int width, int height) : width_(width), height_(height) {
  GLint limit = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &limit);
  if (width < 1 || height < 1 || width > limit || height > limit) throw InternalError("no framebuffer of that size");
  glGenRenderbuffers(1, &depth_);
  glBindRenderbuffer(GL_RENDERBUFFER, depth_);
  glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, width, height);
  glGenTextures(1, &color_);
  glBindTexture(GL_TEXTURE_2D, color_);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
  glGenFramebuffers(1, &framebuffer_);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, color_, 0);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw InternalError("the framebuffer is not complete");
}

Framebuffer::~Framebuffer() {
  glDeleteFramebuffers(1, &framebuffer_);
  glDeleteTextures(1, &color_);
  glDeleteRenderbuffers(1, &depth_);
}

void Framebuffer::bind() const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glViewport(0, 0, width_, height_);
}

void Framebuffer::clear(Color color) {
  bind();
  glClearColor(color.r, color.g, color.b, 1.0f);
  glClear(GL_COLOR_BUFFER_BIT);
}

void Framebuffer::clear(Color color, int x, int y, int width, int height) {
  glEnable(GL_SCISSOR_TEST);
  glScissor(x, height_ - y - height, width, height);
  clear(color);
  glDisable(GL_SCISSOR_TEST);
}

void Framebuffer::read_rows() {
  rows_.resize(static_cast<std::size_t>(width_) * height_ * 4);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, rows_.data());
}

void Framebuffer::smooth_edges() {
  read_rows();
  impinge::smooth_edges(rows_, smooth_rows_, width_, height_);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, color_);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, smooth_rows_.data());
}

void Framebuffer::copy_to(Framebuffer& target, int x, int y) const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target.framebuffer_);
  const int bottom = target.height_ - y - height_;
  glBlitFramebuffer(0, 0, width_, height_, x, bottom, x + width_, bottom + height_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

void Framebuffer::copy_with_depth_to(Framebuffer& target) const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target.framebuffer_);
  glDisable(GL_SCISSOR_TEST);
  glBlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT,
                    GL_NEAREST);
}

void Framebuffer::read(Image& out, bool with_alpha) {
  read_rows();
  if (out.width != width_ || out.height != height_) out = Image(width_, height_);
  out.alpha.resize(with_alpha ? static_cast<std::size_t>(width_) * height_ : 0);
  for (int y = 0; y < height_; ++y) {
    const std::uint8_t* from = rows_.data() + static_cast<std::size_t>(height_ - 1 - y) * width_ * 4;
    std::uint8_t* to = out.pixel(0, y);
    for (int x = 0; x < width_; ++x, from += 4, to += 3) to[0] = from[0], to[1] = from[1], to[2] = from[2];
  }
  if (!with_alpha) return;
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) {
      const int a = rows_[(static_cast<std::size_t>(height_ - 1 - y) * width_ + x) * 4 + 3];
      out.alpha[static_cast<std::size_t>(y) * width_ + x] = static_cast<std::uint8_t>(a);
      if (a == 0 || a == 255) continue;
      for (std::uint8_t *c = out.pixel(x, y), *end = c + 3; c != end; ++c)
        *c = static_cast<std::uint8_t>(std::min(255, (*c * 255 + a / 2) / a));
    }
}

}  // namespace impinge
