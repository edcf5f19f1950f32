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

RenderStyle style_of(const ViewSettings& settings, int height) {
  return {backdrop_of(settings), settings.antialiasing, pixel_scale(height), settings.clip, settings.backs()};
}

Camera camera_of(const StepRecord& record, const ViewSettings& settings, int width, int height) {
  return settings.camera_given ? settings.camera : fitted_camera(record, settings.camera, static_cast<double>(width) / height);
}

/// What is written over the picture hides what is behind it.
void add_panel(IdImage& ids, const PanelArea& area, const char* mark) {
  const int left = std::clamp(static_cast<int>(std::floor(area.x)), 0, ids.width), top = std::clamp(static_cast<int>(std::floor(area.y)), 0, ids.height);
  const int right = std::clamp(static_cast<int>(std::ceil(area.x + area.width)), left, ids.width);
  const int bottom = std::clamp(static_cast<int>(std::ceil(area.y + area.height)), top, ids.height);
  if (area.width <= 0.0f || right == left || bottom == top) return;
  IdObject object;
  object.layer = "panels";
  object.mark = mark;
  ids.objects.push_back(object);
  const auto index = static_cast<std::uint32_t>(ids.objects.size());
  for (int y = top; y < bottom; ++y)
    for (int x = left; x < right; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * ids.width + x;
      ids.object[i] = index;
      ids.part[i] = IdImage::kNoPart;
    }
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
  PanelArea figures, legend, bar;  // of the last picture
  std::unique_ptr<IdBuffer> ids;
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
  const Camera camera = camera_of(record, settings, p.width, p.height);

  p.list.clear();
  const LayerContext context{record, settings, camera, p.surfaces};
  for (const Layer& layer : layers())
    if (settings.is_on(layer.name)) layer.draw(context, p.list), p.list.end_layer(layer.name);
  p.surfaces.forget_unused();

  p.renderer.draw(p.list, camera, style_of(settings, p.height), p.target);

  const int scale = text_scale(settings, p.height);
  if (!p.overlay || p.overlay->scale() != scale) p.overlay = std::make_unique<Overlay>(scale);
  p.overlay->draw(p.width, p.height, [&](const Pen& pen) {
    p.figures = draw_figures(pen, record, settings);
    p.legend = draw_legend(pen, record, settings, p.figures);
    p.bar = p.list.color_bar ? draw_color_bar(pen, *p.list.color_bar, settings, {p.figures, p.legend}) : PanelArea();
    draw_labels(pen, p.list.labels, camera, {p.figures, p.legend, p.bar});
  });
  p.target.read(out);
}

void FramePainter::paint(const StepRecord& record, const ViewSettings& settings, Image& out, IdImage& ids) {
  paint(record, settings, out);
  Parts& p = *parts_;
  if (!p.ids) p.ids = std::make_unique<IdBuffer>(p.width, p.height);
  DrawList coded = p.list;
  ids.objects = code_colors(coded, record);
  p.renderer.draw_ids(coded, camera_of(record, settings, p.width, p.height), style_of(settings, p.height), *p.ids);
  p.ids->read(ids);
  add_panel(ids, p.figures, "figures");
  add_panel(ids, p.legend, "legend");
  add_panel(ids, p.bar, "bar");
}

void settle_camera(ViewSettings& settings, const StepRecord& record, double aspect) {
  if (settings.camera_given) return;
  settings.camera = fitted_camera(record, settings.camera, aspect);
  settings.camera_given = true;
}

}  // namespace impinge
