// The debugger's window as pixels: the view of the scene and the panels around it in one framebuffer, with or without a
// screen.
#pragma once

#include <optional>

#include "viewer/gl/context.hpp"
#include "viewer/image/image.hpp"
#include "viewer/panels/debug/layout.hpp"
#include "viewer/panels/debug/panel_changes.hpp"
#include "viewer/present/scene_painter.hpp"

namespace impinge {

class DebugWindow {
 public:
  /// `scale`: of text, 0: by the height. Throws std::runtime_error without OpenGL.
  DebugWindow(int width, int height, int scale = 0);
  ~DebugWindow();
  DebugWindow(const DebugWindow&) = delete;
  DebugWindow& operator=(const DebugWindow&) = delete;

  int width() const { return window_.width(); }
  int height() const { return window_.height(); }
  /// Of the part that shows the scene.
  double view_aspect() const { return layout_.view.width / layout_.view.height; }
  Ui& ui() { return ui_; }
  std::string renderer_name() const { return context_->renderer_name(); }

  /// Takes the next input, draws, and says what the input asks for, as command lines. Scene and panels are drawn again
  /// only where they changed. `quick`: while the view is dragged its edges are left as they are.
  CommandLines paint(const DebugModel& model, bool quick = false);
  /// Whether the view is not as it is to be once it stands still.
  bool is_rough() const { return rough_; }
  /// Whether the last paint() changed a pixel, or may have.
  bool has_changed() const { return has_changed_; }
  /// The next frame is drawn as a whole.
  void forget() { changes_.forget(), painted_.clear(); }
  void read(Image& out);

 private:
  void use_mouse(const DebugModel& model, CommandLines& lines);
  Camera camera(const DebugModel& model) const;
  void take_hold(const DebugModel& model);
  void drag(const DebugModel& model, CommandLines& lines);
  std::string pick(const DebugModel& model, float x, float y);
  std::string scene_key(const DebugModel& model) const;

  std::unique_ptr<GlContext> context_;
  Framebuffer window_;
  Ui ui_;
  DebugLayout layout_;
  ScenePainter scene_;
  PanelChanges changes_;
  std::string painted_;  // key of what scene_ shows
  int held_ = -1;        // button that went down over the view
  float pressed_x_ = 0.0f, pressed_y_ = 0.0f, last_x_ = 0.0f, last_y_ = 0.0f;
  /// The point of a body that the mouse has hold of.
  struct Hold {
    std::string body;
    Vec3 own = Vec3::Zero();  ///< the body's coordinates
    double depth = 0.0;       ///< of the plane that the mouse moves in, along the line of sight, metres
    bool is_moved = false;    ///< whether forces do that
    bool has_pulled = false;
  };
  std::optional<Hold> hold_;
  bool dragged_ = false, rough_ = false, has_changed_ = true;
};

}  // namespace impinge
