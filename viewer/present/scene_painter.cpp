#include "viewer/present/scene_painter.hpp"

#include <algorithm>
#include <cmath>

#include "viewer/layers/layer.hpp"

namespace impinge {
namespace {

Backdrop backdrop_of(const ViewSettings& settings) {
  if (settings.backdrop == BackdropStyle::light) return {hex(0xf7f8fa), hex(0xdfe3e8)};
  if (settings.backdrop == BackdropStyle::flat) return {hex(0x3f4650), hex(0x3f4650)};
  return {hex(0x5a6472), hex(0x23272e)};
}

/// Sizes in pixels are meant for pictures 720 high; small pictures keep marks that can be seen.
float pixel_scale(int height) { return std::max(0.5f, static_cast<float>(height) / 720.0f); }

int text_scale(const ViewSettings& settings, int height) {
  return settings.panel_scale > 0 ? settings.panel_scale : std::max(1, static_cast<int>(std::lround(height / 800.0)));
}

RenderStyle style_of(const ViewSettings& settings, int height) {
  return {backdrop_of(settings), settings.antialiasing, pixel_scale(height), settings.clip, settings.backs};
}

Camera camera_of(const StepRecord& record, const ViewSettings& settings, int width, int height) {
  return settings.camera_given ? settings.camera
                               : fitted_camera(record, settings.camera, static_cast<double>(width) / height);
}

/// What is written over the picture hides what is behind it.
void add_panel(IdImage& ids, const PanelArea& area, const char* mark) {
  const int left = std::clamp(static_cast<int>(std::floor(area.x)), 0, ids.width),
            top = std::clamp(static_cast<int>(std::floor(area.y)), 0, ids.height);
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

ScenePainter::ScenePainter(int width, int height) : target_(width, height) {}

const Framebuffer& ScenePainter::paint(const StepRecord& record, const ViewSettings& settings,
                                       const std::function<void(DrawList&)>& more) {
  const Camera camera = camera_of(record, settings, width(), height());
  list_.clear();
  for (const Layer& layer : layers()) {
    if (!settings.is_on(layer.name)) continue;
    layer.draw({record, settings, camera, surfaces_, layer.name}, list_);
    list_.end_layer(layer.name);
  }
  if (more) more(list_), list_.end_layer("selection");
  surfaces_.forget_unused();

  renderer_.draw(list_, camera, style_of(settings, height()), target_);

  const int scale = text_scale(settings, height());
  if (!overlay_ || overlay_->scale() != scale) overlay_ = std::make_unique<Overlay>(scale);
  overlay_->draw(width(), height(), [&](const Pen& pen) {
    figures_ = draw_figures(pen, record, settings);
    legend_ = draw_legend(pen, record, settings, figures_);
    bar_ = list_.color_bar ? draw_color_bar(pen, *list_.color_bar, settings, {figures_, legend_}) : PanelArea();
    draw_labels(pen, list_.labels, camera, {figures_, legend_, bar_});
  });
  return target_;
}

void ScenePainter::read_ids(const StepRecord& record, const ViewSettings& settings, IdImage& ids) {
  if (!ids_) ids_ = std::make_unique<IdBuffer>(width(), height());
  DrawList coded = list_;
  ids.objects = code_colors(coded, record);
  renderer_.draw_ids(coded, camera_of(record, settings, width(), height()), style_of(settings, height()), *ids_);
  ids_->read(ids);
  add_panel(ids, figures_, "figures");
  add_panel(ids, legend_, "legend");
  add_panel(ids, bar_, "bar");
}

}  // namespace impinge
