#include "viewer/panels/debug/ui.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "engine/core/parameter.hpp"
#include "viewer/draw/palette.hpp"
#include "viewer/image/text_font.hpp"

namespace impinge {
namespace {

struct KeyRow {
  const char* name;
  int imgui;  // ImGuiKey_, or -1
};
constexpr KeyRow kKeys[] = {{"tab", ImGuiKey_Tab},
                            {"left", ImGuiKey_LeftArrow},
                            {"right", ImGuiKey_RightArrow},
                            {"up", ImGuiKey_UpArrow},
                            {"down", ImGuiKey_DownArrow},
                            {"home", ImGuiKey_Home},
                            {"end", ImGuiKey_End},
                            {"delete", ImGuiKey_Delete},
                            {"backspace", ImGuiKey_Backspace},
                            {"space", ImGuiKey_Space},
                            {"enter", ImGuiKey_Enter},
                            {"escape", ImGuiKey_Escape},
                            {"a", ImGuiKey_A},
                            {"c", ImGuiKey_C},
                            {"v", ImGuiKey_V},
                            {"x", ImGuiKey_X},
                            {"y", ImGuiKey_Y},
                            {"z", ImGuiKey_Z},
                            {"f", -1},
                            {"r", -1},
                            {"f1", -1},
                            {"page_up", ImGuiKey_PageUp},
                            {"page_down", ImGuiKey_PageDown},
                            {"h", -1},
                            {"ctrl", -1},
                            {"shift", -1},
                            {"b", -1}};
constexpr int kCtrl = 24, kShift = 25;

ImVec4 color(std::uint32_t rgb, float alpha = 1.0f) {
  const Color c = hex(rgb, alpha);
  return {c.r, c.g, c.b, c.a};
}

void set_style(float unit) {
  ImGuiStyle& style = ImGui::GetStyle();
  ImGui::StyleColorsDark(&style);
  style.WindowRounding = 0.0f;
  style.WindowBorderSize = 0.0f;
  style.FrameRounding = 3.0f;
  style.GrabRounding = 3.0f;
  style.WindowPadding = {8.0f, 7.0f};
  style.ItemSpacing = {6.0f, 4.0f};
  style.FramePadding = {5.0f, 2.0f};
  style.ScrollbarSize = 10.0f;
  style.ScaleAllSizes(unit);
  style.AntiAliasedLinesUseTex = false;
  ImVec4* c = style.Colors;
  c[ImGuiCol_WindowBg] = color(0x1b1f25);
  c[ImGuiCol_PopupBg] = color(0x252a32);
  c[ImGuiCol_Text] = color(0xe6eaf0);
  c[ImGuiCol_TextDisabled] = color(0x98a2b0);
  c[ImGuiCol_FrameBg] = color(0x2b313a);
  c[ImGuiCol_FrameBgHovered] = color(0x37404c);
  c[ImGuiCol_FrameBgActive] = color(0x40505f);
  c[ImGuiCol_SliderGrab] = color(0x34719d);  // dark enough for the number over it
  c[ImGuiCol_SliderGrabActive] = color(0x4385b4);
  c[ImGuiCol_CheckMark] = color(0x6cc1f5);
  c[ImGuiCol_Button] = color(0x333b46);
  c[ImGuiCol_ButtonHovered] = color(0x465364);
  c[ImGuiCol_ButtonActive] = color(0x56a8e0);
  c[ImGuiCol_Header] = color(0x2c4a63);
  c[ImGuiCol_HeaderHovered] = color(0x365a78);
  c[ImGuiCol_HeaderActive] = color(0x3f6c90);
  c[ImGuiCol_Separator] = color(0x3a424d);
  c[ImGuiCol_ScrollbarBg] = color(0x1b1f25);
  c[ImGuiCol_ScrollbarGrab] = color(0x3a424d);
  c[ImGuiCol_TableRowBgAlt] = color(0xffffff, 0.03f);
}

template <class Rows>
std::vector<std::string> names_of(const Rows& rows) {
  std::vector<std::string> names;
  for (const KeyRow& row : rows) names.emplace_back(row.name);
  return names;
}

}  // namespace

const std::vector<std::string>& key_names() {
  static const std::vector<std::string> names = names_of(kKeys);
  return names;
}

const std::vector<std::string>& button_names() {
  static const std::vector<std::string> names = {"left", "right", "middle"};
  return names;
}

std::string UiPointer::line() const {
  return fmt::format("ui move {} {}{}", shortest(x), shortest(y), has_clicked ? " clicked" : "");
}

Ui::Ui(int scale) : scale_(scale) {
  context_ = ImGui::CreateContext();
  ImGui::SetCurrentContext(context_);
  ImGuiIO& io = ImGui::GetIO();
  io.UserData = this;
  io.IniFilename = nullptr;
  io.LogFilename = nullptr;
  io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
  io.ConfigInputTextCursorBlink = false;
  io.KeyRepeatDelay = 1e6f;  // repeating goes by time, which a script doesn't have
  io.MouseDoubleClickTime = 0.0f;
  io.ConfigWindowsMoveFromTitleBarOnly = true;
  for (std::size_t k = 0; k < std::size(kKeys); ++k)
    if (kKeys[k].imgui >= 0) io.KeyMap[kKeys[k].imgui] = static_cast<int>(k);
  add_text_font(*io.Fonts, static_cast<float>(scale));
  set_style(static_cast<float>(scale));
  backend_ = std::make_unique<ImguiBackend>(*io.Fonts);
}

Ui::~Ui() {
  backend_.reset();
  ImGui::DestroyContext(context_);
}

void Ui::begin(int width, int height) {
  ImGui::SetCurrentContext(context_);
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = {static_cast<float>(width), static_cast<float>(height)};
  io.DeltaTime = 1.0f / 60.0f;
  wheel_ = 0.0f;
  keys_now_.clear();
  std::fill(std::begin(went_down_), std::end(went_down_), false);
  std::fill(std::begin(went_up_), std::end(went_up_), false);
  bool moved = false;
  while (!queue_.empty()) {
    const UiEvent event = queue_.front();
    const bool alone = event.kind == UiEvent::press || event.kind == UiEvent::release ||
                       event.kind == UiEvent::key_down || event.kind == UiEvent::key_up;
    if (alone && moved) break;  // what is under the pointer is known a frame later
    queue_.pop_front();
    switch (event.kind) {
      case UiEvent::move:
        if (event.x != mouse_x_ || event.y != mouse_y_) has_clicked_ = false;
        mouse_x_ = event.x, mouse_y_ = event.y, moved = true;
        break;
      case UiEvent::press:
        down_[event.code] = went_down_[event.code] = has_clicked_ = true;
        break;
      case UiEvent::clicked:
        has_clicked_ = true;
        break;
      case UiEvent::release:
        down_[event.code] = false, went_up_[event.code] = true;
        break;
      case UiEvent::wheel:
        wheel_ += event.y;
        break;
      case UiEvent::key_down:
        io.KeysDown[event.code] = true;
        keys_now_.push_back(event.code);
        break;
      case UiEvent::key_up:
        io.KeysDown[event.code] = false;
        break;
      case UiEvent::type:
        io.AddInputCharactersUTF8(event.text.c_str());
        break;
    }
    if (alone) break;
  }
  io.KeyCtrl = io.KeysDown[kCtrl];
  io.KeyShift = io.KeysDown[kShift];
  io.MousePos = {mouse_x_, mouse_y_};
  io.MouseWheel = wheel_;
  for (int b = 0; b < 3; ++b) io.MouseDown[b] = down_[b];
  widgets_.clear();
  ImGui::NewFrame();
}

const ImDrawData& Ui::end() {
  ImGui::Render();
  return *ImGui::GetDrawData();
}

void Ui::draw() { backend_->draw(*ImGui::GetDrawData()); }
void Ui::draw(std::span<const ImDrawList* const> lists) {
  backend_->draw(lists, ImGui::GetDrawData()->DisplaySize.x, ImGui::GetDrawData()->DisplaySize.y);
}

bool Ui::key_pressed(const std::string& name) const {
  const auto it = std::find(key_names().begin(), key_names().end(), name);
  return std::find(keys_now_.begin(), keys_now_.end(), static_cast<int>(it - key_names().begin())) != keys_now_.end();
}

bool Ui::takes_mouse() const { return ImGui::GetIO().WantCaptureMouse; }
bool Ui::takes_keys() const { return ImGui::GetIO().WantTextInput; }

void Ui::name(const std::string& name, const UiWidget& what) {
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  UiWidget widget = what;
  widget.area = {low.x, low.y, high.x - low.x, high.y - low.y};
  const ImVec2 middle = {std::round(0.5f * (low.x + high.x)), std::round(0.5f * (low.y + high.y))};
  widget.visible = ImGui::IsRectVisible(middle, {middle.x + 1.0f, middle.y + 1.0f});  // where a script clicks
  if (name == wanted_) {
    if (!widget.visible) ImGui::SetScrollHereY(0.5f);
  }
  widgets_[name] = widget;
}

float Ui::slider_x(const UiWidget& slider, double value) const {
  // as ImGui::SliderBehavior places its grab
  const double at = slider.logarithmic ? std::log10(value) : value, padding = 2.0,
               size = slider.area.width - 2.0 * padding, span = slider.high - slider.low;
  double grab = ImGui::GetStyle().GrabMinSize;
  if (slider.is_whole) grab = std::max(size / (span + 1.0), grab);
  grab = std::min(grab, size);
  return static_cast<float>(slider.area.x + padding + 0.5 * grab +
                            std::clamp((at - slider.low) / span, 0.0, 1.0) * (size - grab));
}

const UiWidget* Ui::find(const std::string& name) const {
  const auto it = widgets_.find(name);
  return it == widgets_.end() ? nullptr : &it->second;
}

std::vector<std::string> Ui::widget_names() const {
  std::vector<std::string> names;
  for (const auto& [name, widget] : widgets_) names.push_back(name);
  return names;
}

}  // namespace impinge
