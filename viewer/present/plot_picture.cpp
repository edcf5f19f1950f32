#include "viewer/present/plot_picture.hpp"

#include <functional>

#include "viewer/gl/context.hpp"
#include "viewer/gl/framebuffer.hpp"

namespace impinge {

namespace {

std::vector<Image> paint(const std::vector<std::function<void(const Pen&)>>& drawings, int width, int height) {
  const auto context = make_offscreen_context();
  context->make_current();
  Framebuffer target(width, height);
  Overlay overlay(1);
  std::vector<Image> pictures;
  for (const auto& drawing : drawings) {
    target.bind();
    overlay.draw(width, height, drawing);
    target.read(pictures.emplace_back());
  }
  return pictures;
}

}  // namespace

std::vector<Image> paint_plots(const std::vector<Plot>& plots, int width, int height) {
  std::vector<std::function<void(const Pen&)>> drawings;
  drawings.reserve(plots.size());
  for (const Plot& plot : plots) drawings.push_back([&plot](const Pen& pen) { draw_plot(pen, plot); });
  return paint(drawings, width, height);
}

Image paint_heat_table(const HeatTable& table, int width, int height) {
  return paint({[&](const Pen& pen) { draw_heat_table(pen, table); }}, width, height).front();
}

}  // namespace impinge
