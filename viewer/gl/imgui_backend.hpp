// Draws Dear ImGui's output with plain OpenGL 3.3. (The packaged backend looks for libGL.so.1 and cannot start here.)
#pragma once

#include <span>

#include "viewer/gl/buffers.hpp"
#include "viewer/gl/program.hpp"

struct ImDrawData;
struct ImDrawList;
struct ImFontAtlas;

namespace impinge {

class ImguiBackend {
 public:
  /// A context must be current, here and in every call. Uploads the atlas and sets its texture id.
  explicit ImguiBackend(ImFontAtlas& atlas);
  ~ImguiBackend();
  ImguiBackend(const ImguiBackend&) = delete;
  ImguiBackend& operator=(const ImguiBackend&) = delete;

  /// Into the framebuffer that is bound.
  void draw(const ImDrawData& data);
  /// Some of its lists, for a display of that size, pixels.
  void draw(std::span<const ImDrawList* const> lists, float width, float height);

 private:
  Program program_{"imgui"};
  VertexArray array_;
  unsigned texture_ = 0;
};

}  // namespace impinge
