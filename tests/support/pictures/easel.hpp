// Pictures of draw lists, and what can be counted in them.
#pragma once

#include <optional>

#include "viewer/draw/camera.hpp"
#include "viewer/gl/context.hpp"
#include "viewer/gl/renderer.hpp"

namespace impinge::test {

/// Everything that draws, by itself: nothing is shared with another one.
struct Easel {
  std::unique_ptr<GlContext> context = make_offscreen_context();
  Renderer renderer;
  Framebuffer framebuffer;
  Color background = hex(0x0000ff);

  explicit Easel(int width = 320, int height = 180) : framebuffer(width, height) {}
  ~Easel() { context->make_current(); }

  Image draw(const DrawList& list, const Camera& camera, float pixel_scale = 1.0f, bool smooth_edges = false) {
    context->make_current();
    renderer.draw(list, camera, {{background, background}, smooth_edges, pixel_scale}, framebuffer);
    Image image;
    framebuffer.read(image);
    return image;
  }
};

inline bool is_color(const std::uint8_t* pixel, Color c, int tolerance = 2) {
  const float wanted[3] = {c.r, c.g, c.b};
  for (int k = 0; k < 3; ++k)
    if (std::abs(static_cast<int>(pixel[k]) - static_cast<int>(std::lround(255.0f * wanted[k]))) > tolerance)
      return false;
  return true;
}

/// Pixels that differ between two pictures of one size.
inline int count_differing(const Image& a, const Image& b) {
  int n = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) n += !std::equal(a.pixel(x, y), a.pixel(x, y) + 3, b.pixel(x, y));
  return n;
}

/// What differs from an empty picture: how much (each pixel by its share), where its middle is, how far it reaches.
struct Blot {
  double area = 0.0;
  Vec2 center = Vec2::Zero();
  Vec2 low = Vec2::Constant(1e9), high = Vec2::Constant(-1e9);  ///< of the touched pixels' middles
};

/// Shares are taken from the blue channel: the background's is 1, the marks' must be 0.
inline Blot blot_of(const Image& image) {
  Blot blot;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const double share = 1.0 - image.pixel(x, y)[2] / 255.0;
      if (share <= 0.02) continue;
      const Vec2 middle(x + 0.5, y + 0.5);
      blot.area += share;
      blot.center += share * middle;
      blot.low = blot.low.cwiseMin(middle);
      blot.high = blot.high.cwiseMax(middle);
    }
  if (blot.area > 0.0) blot.center /= blot.area;
  return blot;
}

}  // namespace impinge::test
