#include "viewer/present/frame_painter.hpp"

#include <algorithm>
#include <cmath>

#include "viewer/gl/context.hpp"
#include "viewer/gl/renderer.hpp"
#include "viewer/layers/layer.hpp"
#include "viewer/panels/panels.hpp"

namespace impinge {
namespace {

Backdrop backdrop_of(const ViewSettings& settings) {
  if (settings.backdrop == "light") return {hex(0xf7f8fa), hex(0xdfe3e8)};
  if (settings.backdrop == "flat") return {hex(0x3f4650), hex(0x3f4650)};
  return {hex(0x5a6472), hex(0x23272e)};
}

/// Sizes in pixels are meant for pictures 720 high; small pictures keep marks that can be seen.
float pixel_scale(int height) { return std::max(0.5f, static_cast<float>(height) / 720.0f); }

int text_scale(const ViewSettings& settings, int height) {
  return settings.panel_scale > 0 ? settings.panel_scale : std::max(1, static_cast<int>(std::lround(height / 800.0)));
}

}  // namespace

struct FramePainter::Parts {
  // in order of making; the context outlives everything that lives in it
  std::unique_ptr<GlContext> context = make_offscreen_context();
  Framebuffer target;
  Renderer renderer;
  std::unique_ptr<Overlay> overlay;
  SurfaceCache surfaces;
  DrawList list;
  int width, height;

  Parts(int w, int h) : target(w, h), width(w), height(h) {}
};

FramePainter::FramePainter(int width, int height) : parts_(std::make_unique<Parts>(width, height)) {}

FramePainter::~FramePainter() {
  parts_->context->make_current();  // OpenGL's objects are given back in their own context
}

std::string FramePainter::renderer_name() const { return parts_->context->renderer_name(); }

void FramePainter::paint(const StepRecord& record, const ViewSettings& settings, Image& out) {
  Parts& p = *parts_;
  p.context->make_current();
  const Camera camera = settings.camera_given
                            ? settings.camera
                            : fitted_camera(record, settings.camera, static_cast<double>(p.width) / p.height);

  p.list.clear();
  const LayerContext context{record, settings, camera, p.surfaces};
  for (const Layer& layer : layers())
    if (settings.is_on(layer.name)) layer.draw(context, p.list);
  p.surfaces.forget_unused();

  p.renderer.draw(p.list, camera, {backdrop_of(settings), settings.antialiasing, pixel_scale(p.height), settings.clip, settings.backs()}, p.target);

  const int scale = text_scale(settings, p.height);
  if (!p.overlay || p.overlay->scale() != scale) p.overlay = std::make_unique<Overlay>(scale);
  p.overlay->draw(p.width, p.height, [&](const Pen& pen) {
    const PanelArea figures = draw_figures(pen, record, settings);
    const PanelArea legend = draw_legend(pen, record, settings, figures);
    PanelArea bar;
    if (p.list.color_bar) bar = draw_color_bar(pen, *p.list.color_bar, settings, {figures, legend});
    draw_labels(pen, p.list.labels, camera, {figures, legend, bar});
  });
  p.target.read(out);
}

void settle_camera(ViewSettings& settings, const StepRecord& record, double aspect) {
  if (settings.camera_given) return;
  settings.camera = fitted_camera(record, settings.camera, aspect);
  settings.camera_given = true;
}

}  // namespace impinge
