// Dear ImGui for the debugger: one context, one queue of input whoever makes it (a mouse, a script), and widgets with
// names, so that a script finds them. The same input gives the same pixels: time goes by fixed ticks, nothing is kept
// in files.
#pragma once

#include <array>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "viewer/gl/imgui_backend.hpp"

struct ImGuiContext;
struct ImDrawData;
struct ImDrawList;

namespace impinge {

/// Keys and mouse buttons, as commands name them.
const std::vector<std::string>& key_names();
const std::vector<std::string>& button_names();

struct UiEvent {
  enum Kind { move, press, release, wheel, key_down, key_up, type, clicked };  ///< clicked: as after a press there
  Kind kind = move;
  float x = 0.0f, y = 0.0f;  ///< move; wheel: y
  int code = 0;              ///< of button_names() or key_names()
  std::string text = {};
};

/// All that a picture shows of the pointer.
struct UiPointer {
  double x = -1.0, y = -1.0;  ///< pixels of the window
  bool has_clicked = false;   ///< since it moved: what it points at is known, and no tooltip says it
  bool is_there() const { return x >= 0.0 && y >= 0.0; }
  std::string line() const;  ///< of a script, that brings it there
};

/// Pixels of the window.
struct UiArea {
  float x = 0.0f, y = 0.0f, width = 0.0f, height = 0.0f;
  bool holds(float px, float py) const { return px >= x && py >= y && px < x + width && py < y + height; }
};

/// A widget as it was drawn last.
struct UiWidget {
  UiArea area;
  bool visible = false;  ///< not scrolled away
  bool is_slider = false, is_whole = false;
  double low = 0.0, high = 0.0;  ///< of a slider; of a logarithmic one log10
  bool logarithmic = false;
};

/// What is being typed and not entered yet. It is the window's, like the pointer: no part of what the panels show, and of
/// a recording only the keys.
struct UiTyping {
  std::string parameter;            ///< path of the row whose value is; "": none
  bool begins = false;              ///< its field has no focus yet
  std::array<char, 512> line = {};  ///< of the console
};

class Ui {
 public:
  /// A GL context must be current, here and in every call. `scale`: text in steps of 13 pixels.
  explicit Ui(int scale);
  ~Ui();
  Ui(const Ui&) = delete;
  Ui& operator=(const Ui&) = delete;

  float unit() const { return static_cast<float>(scale_); }
  void add(UiEvent event) { queue_.push_back(std::move(event)); }
  bool has_events() const { return !queue_.empty(); }

  /// Takes events up to the first that must be seen by itself (1.86 has no queue of its own), and begins a frame.
  void begin(int width, int height);
  /// What the frame looks like; valid until the next one begins. draw() brings it, or some of its lists, into the
  /// framebuffer that is bound.
  const ImDrawData& end();
  void draw();
  void draw(std::span<const ImDrawList* const> lists);

  // in a frame
  float mouse_x() const { return mouse_x_; }
  float mouse_y() const { return mouse_y_; }
  UiPointer pointer() const { return {mouse_x_, mouse_y_, has_clicked_}; }
  bool went_down(int button) const { return went_down_[button]; }
  bool went_up(int button) const { return went_up_[button]; }
  float wheel() const { return wheel_; }
  bool key_pressed(const std::string& name) const;
  /// Whether a panel takes the mouse or the keys.
  bool takes_mouse() const;
  bool takes_keys() const;
  /// Notes where the widget that was made last is. Scrolls to it if it is asked for.
  void name(const std::string& name, const UiWidget& what = {});
  UiTyping& typing() { return typing_; }
  /// The name that a script looks for and that isn't drawn yet, or "".
  const std::string& wanted() const { return wanted_; }

  void look_for(const std::string& name) { wanted_ = name; }
  /// Where the pointer must be for a slider to show the value, pixels.
  float slider_x(const UiWidget& slider, double value) const;
  /// Null if it was not drawn in the last frame.
  const UiWidget* find(const std::string& name) const;
  std::vector<std::string> widget_names() const;

 private:
  int scale_;
  ImGuiContext* context_ = nullptr;
  std::unique_ptr<ImguiBackend> backend_;
  std::deque<UiEvent> queue_;
  std::map<std::string, UiWidget> widgets_;
  std::string wanted_;
  UiTyping typing_;
  float mouse_x_ = -1.0f, mouse_y_ = -1.0f, wheel_ = 0.0f;
  bool has_clicked_ = false;
  bool down_[3] = {}, went_down_[3] = {}, went_up_[3] = {};
  std::vector<int> keys_now_;
};

}  // namespace impinge
