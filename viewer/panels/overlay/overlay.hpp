// Text over the picture: panels and labels, through Dear ImGui's draw lists and the embedded font.
#pragma once

#include <functional>
#include <memory>

#include "viewer/draw/palette.hpp"
#include "viewer/gl/imgui_backend.hpp"
#include "viewer/image/text_font.hpp"

struct ImDrawList;
struct ImFont;
struct ImGuiContext;

namespace impinge {

/// What the panels draw with. Sizes in pixels.
struct Pen {
  ImDrawList& list;
  ImFont& font;
  float text_size = kTextSize;
  float unit = 1.0f;  ///< a pixel of a picture with text of kTextSize
  float picture_width = 0.0f, picture_height = 0.0f;

  /// Whether panels should say less and stand closer together.
  bool is_small() const { return picture_height <= 480.0f * unit; }
  // of panels
  float margin() const { return (is_small() ? 5.0f : 10.0f) * unit; }
  float padding() const { return (is_small() ? 5.0f : 9.0f) * unit; }
  float row() const { return (is_small() ? 13.0f : 16.0f) * unit; }

  float text_width(const std::string& text) const;
  void text(float x, float y, Color color, const std::string& text) const;
  /// A dark translucent sheet with round corners.
  void sheet(float x, float y, float width, float height) const;
  /// A diagonal cross: in red what is in doubt.
  void cross(float x, float y, float radius, float line_width, Color color = hex(0xc1121f)) const;
};

class Overlay {
 public:
  /// A GL context must be current, here and in every call. `scale`: text size in steps of kTextSize.
  explicit Overlay(int scale);
  ~Overlay();
  Overlay(const Overlay&) = delete;
  Overlay& operator=(const Overlay&) = delete;

  int scale() const { return scale_; }
  /// Runs `paint` and draws what it wrote into the framebuffer that is bound.
  void draw(int width, int height, const std::function<void(const Pen&)>& paint);

 private:
  int scale_;
  ImGuiContext* context_ = nullptr;
  std::unique_ptr<ImguiBackend> backend_;
};

}  // namespace impinge
