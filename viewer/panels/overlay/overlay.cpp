#include "viewer/panels/overlay/overlay.hpp"

#include <imgui.h>
#include <mutex>

#include "viewer/gl/packed_color.hpp"

namespace impinge {
namespace {

std::mutex& imgui_mutex() {
  static std::mutex mutex;  // Dear ImGui's current context is one for the whole process
  return mutex;
}

}  // namespace

float Pen::text_width(const std::string& text) const {
  return font.CalcTextSizeA(text_size, FLT_MAX, 0.0f, text.c_str()).x;
}

void Pen::text(float x, float y, Color color, const std::string& text) const {
  list.AddText(&font, text_size, {x, y}, packed(color), text.c_str());
}

void Pen::sheet(float x, float y, float width, float height) const {
  list.AddRectFilled({x, y}, {x + width, y + height}, packed(hex(0x12151a, 0.78f)), 5.0f * unit);
  list.AddRect({x + 0.5f, y + 0.5f}, {x + width - 0.5f, y + height - 0.5f}, packed(hex(0xffffff, 0.10f)), 5.0f * unit,
               0, unit);
}

void Pen::cross(float x, float y, float radius, float line_width, Color color) const {
  list.AddLine({x - radius, y - radius}, {x + radius, y + radius}, packed(color), line_width);
  list.AddLine({x - radius, y + radius}, {x + radius, y - radius}, packed(color), line_width);
}

Overlay::Overlay(int scale) : scale_(scale) {
  const std::lock_guard lock(imgui_mutex());
  context_ = ImGui::CreateContext();
  ImGui::SetCurrentContext(context_);
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.LogFilename = nullptr;
  io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
  add_text_font(*io.Fonts, static_cast<float>(scale));
  backend_ = std::make_unique<ImguiBackend>(*io.Fonts);
}

Overlay::~Overlay() {
  const std::lock_guard lock(imgui_mutex());
  backend_.reset();
  ImGui::DestroyContext(context_);
}

void Overlay::draw(int width, int height, const std::function<void(const Pen&)>& paint) {
  const std::lock_guard lock(imgui_mutex());
  ImGui::SetCurrentContext(context_);
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = {static_cast<float>(width), static_cast<float>(height)};
  io.DeltaTime = 1.0f / 60.0f;
  ImGui::NewFrame();
  const float unit = static_cast<float>(scale_);
  const Pen pen{
      *ImGui::GetBackgroundDrawList(), *ImGui::GetFont(), kTextSize * unit, unit, io.DisplaySize.x, io.DisplaySize.y};
  paint(pen);
  ImGui::Render();
  backend_->draw(*ImGui::GetDrawData());
}

}  // namespace impinge
