#include "viewer/present/frame_painter.hpp"

#include "viewer/gl/context.hpp"
#include "viewer/layers/layer.hpp"
#include "viewer/layers/view_bodies.hpp"
#include "viewer/present/scene_painter.hpp"

namespace impinge {

struct FramePainter::Parts {
  // in order of making; the context outlives everything that lives in it
  std::unique_ptr<GlContext> context = make_offscreen_context();
  ScenePainter scene;

  Parts(int w, int h) : scene(w, h) {}
};

FramePainter::FramePainter(int width, int height) : parts_(std::make_unique<Parts>(width, height)) {}

FramePainter::~FramePainter() {
  parts_->context->make_current();  // OpenGL's objects are given back in their own context
}

std::string FramePainter::renderer_name() const { return parts_->context->renderer_name(); }

std::string FramePainter::colors() const {
  std::string lines;
  for (const ColorBar& bar : parts_->scene.color_bars()) lines += (lines.empty() ? "" : "\n") + bar_text(bar);
  return lines;
}

void FramePainter::paint(const StepRecord& record, const ViewSettings& settings, Image& out) {
  parts_->context->make_current();
  parts_->scene.paint(record, settings);
  parts_->scene.target().read(out, settings.backdrop == BackdropStyle::transparent);
}

void FramePainter::paint(const StepRecord& record, const ViewSettings& settings, Image& out, IdImage& ids) {
  paint(record, settings, out);
  parts_->scene.read_ids(record, settings, ids);
}

void settle_camera(ViewSettings& settings, const StepRecord& record, double aspect) {
  if (settings.camera_given) return;
  settings.camera = fitted_camera(record, settings.camera, settings.followed, aspect);
  const Vec3 origin = camera_origin(record, settings);
  settings.camera.eye -= origin;
  settings.camera.target -= origin;
  settings.camera_given = true;
}

}  // namespace impinge
