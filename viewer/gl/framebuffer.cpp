#include "viewer/gl/framebuffer.hpp"

#include <algorithm>

#include "viewer/gl/gl.hpp"

namespace impinge {
namespace {

GLuint renderbuffer(GLenum format, int width, int height, int samples) {
  GLuint id = 0;
  glGenRenderbuffers(1, &id);
  glBindRenderbuffer(GL_RENDERBUFFER, id);
  if (samples > 1)
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, format, width, height);
  else
    glRenderbufferStorage(GL_RENDERBUFFER, format, width, height);
  return id;
}

GLuint framebuffer(GLuint color, GLuint depth) {
  GLuint id = 0;
  glGenFramebuffers(1, &id);
  glBindFramebuffer(GL_FRAMEBUFFER, id);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, color);
  if (depth != 0) glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw InternalError("the framebuffer is not complete");
  return id;
}

}  // namespace

Framebuffer::Framebuffer(int width, int height, int samples) : width_(width), height_(height), samples_(samples) {
  color_ = renderbuffer(GL_RGBA8, width, height, samples);
  depth_ = renderbuffer(GL_DEPTH_COMPONENT24, width, height, samples);
  drawn_ = framebuffer(color_, depth_);
  if (samples_ > 1) {
    resolved_color_ = renderbuffer(GL_RGBA8, width, height, 0);
    resolved_ = framebuffer(resolved_color_, 0);
  }
}

Framebuffer::~Framebuffer() {
  for (const GLuint id : {drawn_, resolved_}) glDeleteFramebuffers(1, &id);
  for (const GLuint id : {color_, depth_, resolved_color_}) glDeleteRenderbuffers(1, &id);
}

void Framebuffer::bind() const {
  glBindFramebuffer(GL_FRAMEBUFFER, drawn_);
  glViewport(0, 0, width_, height_);
}

void Framebuffer::resolve() const {
  if (samples_ <= 1) return;
  glBindFramebuffer(GL_READ_FRAMEBUFFER, drawn_);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, resolved_);
  glBlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  glBindFramebuffer(GL_FRAMEBUFFER, resolved_);
}

void Framebuffer::read(Image& out) {
  rows_.resize(static_cast<std::size_t>(width_) * height_ * 4);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, samples_ > 1 ? resolved_ : drawn_);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, rows_.data());
  if (out.width != width_ || out.height != height_) out = Image(width_, height_);
  for (int y = 0; y < height_; ++y) {
    const std::uint8_t* from = rows_.data() + static_cast<std::size_t>(height_ - 1 - y) * width_ * 4;
    std::uint8_t* to = out.pixel(0, y);
    for (int x = 0; x < width_; ++x, from += 4, to += 3) to[0] = from[0], to[1] = from[1], to[2] = from[2];
  }
}

}  // namespace impinge
