#include "viewer/present/plot_picture.hpp"

#include "viewer/gl/context.hpp"
#include "viewer/gl/framebuffer.hpp"

namespace impinge {

std::vector<Image> paint_plots(const std::vector<Plot>& plots, int width, int height) {
  const auto context = make_offscreen_context();
  context->make_current();
  Framebuffer target(width, height);
  Overlay overlay(1);
  std::vector<Image> pictures;
  for (const Plot& plot : plots) {
    target.bind();
    overlay.draw(width, height, [&](const Pen& pen) { draw_plot(pen, plot); });
    target.read(pictures.emplace_back());
  }
  return pictures;
}

}  // namespace impinge
