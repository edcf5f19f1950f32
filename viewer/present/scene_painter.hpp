// Turns a step record into pixels of a framebuffer: layers -> draw list -> renderer -> figures, legend and labels.
#pragma once

#include <functional>
#include <optional>

#include "viewer/gl/id_buffer.hpp"
#include "viewer/gl/renderer.hpp"
#include "viewer/panels/overlay/picture_panels.hpp"

namespace impinge {

/// The same record and settings give the same pixels, whatever was painted before.
class ScenePainter {
 public:
  /// A context must be current, here and in every call. Throws InternalError if the size cannot be had.
  ScenePainter(int width, int height);

  int width() const { return target_.width(); }
  int height() const { return target_.height(); }
  /// `more` adds to what the layers draw, such as what is selected.
  const Framebuffer& paint(const StepRecord& record, const ViewSettings& settings,
                           const std::function<void(DrawList&)>& more = {});
  Framebuffer& target() { return target_; }
  /// The body that is seen at a pixel of what was painted last, and which point of it; none: none, or what can't be hit
  /// there.
  struct Seen {
    BodyIndex body;
    Vec3 point;
  };
  std::optional<Seen> look_at(const StepRecord& record, const ViewSettings& settings, double x, double y);
  /// Where the legend of the last picture is; no width: nowhere.
  const PanelArea& legend() const { return legend_; }
  /// Its colour bars, drawn or left out for want of room.
  const std::vector<ColorBar>& color_bars() const { return list_.color_bars; }
  /// Where they are; no width: nowhere.
  const std::vector<PanelArea>& bars() const { return bars_; }
  /// What each pixel of what was painted last shows; panels are objects too. Labels belong to what is behind them.
  /// `pickable`: without locked bodies, so that what lies behind them is found.
  void read_ids(const StepRecord& record, const ViewSettings& settings, IdImage& ids, bool pickable = false);

 private:
  Framebuffer target_;
  Renderer renderer_;
  std::unique_ptr<Overlay> overlay_;
  SurfaceCache surfaces_;
  DrawList list_;
  // of the last picture
  PanelArea figures_, legend_, caption_;
  std::vector<PanelArea> bars_;
  std::unique_ptr<IdBuffer> ids_;
};

}  // namespace impinge
