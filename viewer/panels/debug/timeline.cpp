// Chosen columns of stats.csv over the frames, one strip each: its name at its left, the present value at its right. A
// click or drag seeks.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "viewer/panels/debug/widgets.hpp"

namespace impinge {
namespace {

ImU32 ink(std::uint32_t rgb, float alpha = 1.0f) {
  const Color c = hex(rgb, alpha);
  return ImGui::ColorConvertFloat4ToU32({c.r, c.g, c.b, c.a});
}

constexpr float kNames = 146.0f, kValues = 74.0f;  // room for them beside the strips

struct Axis {
  float left, right;
  int last;
  float x(double frame) const { return left + static_cast<float>(frame) / static_cast<float>(last) * (right - left); }
  int frame(float at) const {
    return static_cast<int>(std::lround((at - left) / (right - left) * static_cast<float>(last)));
  }
};

void draw_strip(const DebugModel& model, std::size_t column, const Axis& axis, float top, float bottom,
                std::uint32_t rgb, float text, float unit) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const auto& history = *model.history;
  double high = 0.0, low = 0.0;
  for (const auto& row : history)
    if (std::isfinite(row[column])) high = std::max(high, row[column]), low = std::min(low, row[column]);
  const double span = high > low ? high - low : 1.0;
  const auto y = [&](double v) { return bottom - 2.0f - static_cast<float>((v - low) / span) * (bottom - top - 4.0f); };
  list.AddRectFilled({axis.left, top}, {axis.right, bottom}, ink(0x232931));
  if (low < 0.0) list.AddLine({axis.left, y(0.0)}, {axis.right, y(0.0)}, ink(0x4a5563));
  // a pixel may hold many frames: from its least to its largest
  std::vector<ImVec2> points;
  for (std::size_t k = 0; k < history.size();) {
    const float x = axis.x(static_cast<double>(k));
    double least = history[k][column], most = least;
    std::size_t end = k + 1;
    for (; end < history.size() && axis.x(static_cast<double>(end)) < x + 1.0f; ++end)
      least = std::min(least, history[end][column]), most = std::max(most, history[end][column]);
    if (std::isfinite(least) && std::isfinite(most)) {
      points.push_back({x, y(most)});
      if (end > k + 1) points.push_back({x, y(least)});
    }
    k = end;
  }
  list.AddPolyline(points.data(), static_cast<int>(points.size()), ink(rgb), 0, std::max(1.0f, text / 10.0f));
  const double now = history[static_cast<std::size_t>(model.frame)][column];
  const float middle = 0.5f * (top + bottom - text);
  list.AddText({axis.left - kNames * unit, middle}, ink(rgb), (*model.figure_names)[column].c_str());
  const std::string value = fmt::format("{:.4g}", now);
  const float width = ImGui::CalcTextSize(value.c_str()).x;
  list.AddText({axis.right + kValues * unit - width, middle}, ink(0xf2f4f7), value.c_str());
}

void draw(Ui& ui, const DebugModel& model, CommandLines& lines) {
  const float u = ui.unit();
  ImGui::TextColored({0.55f, 0.78f, 0.95f, 1.0f}, "timeline");
  ImGui::SameLine();
  ImGui::SetNextItemWidth(120.0f * u);
  const bool open = ImGui::BeginCombo("##columns", "columns", ImGuiComboFlags_HeightLarge);
  ui.name("timeline/columns");
  if (open) {
    for (const std::string& name : *model.figure_names) {
      bool on = std::find(model.state.plots.begin(), model.state.plots.end(), name) != model.state.plots.end();
      if (ImGui::Checkbox(name.c_str(), &on)) lines.push_back(fmt::format("panel plot {}{}", on ? '+' : '-', name));
      ui.name("timeline/columns:" + name);
    }
    close_on_escape(ui);
    ImGui::EndCombo();
  }
  const std::vector<std::string>& plots = model.state.plots;
  const ImVec2 start = ImGui::GetCursorScreenPos(), size = ImGui::GetContentRegionAvail();
  if (size.x < 20.0f * u || size.y < 20.0f * u) return;
  const float left = start.x + kNames * u, right = std::max(left + 20.0f * u, start.x + size.x - kValues * u);
  ImGui::SetCursorScreenPos({left, start.y});
  ImGui::InvisibleButton("strips", {right - left, size.y});
  ui.name("timeline/plot");
  const Axis axis{left, right, std::max(1, model.known_last)};
  const float each = plots.empty() ? size.y : size.y / static_cast<float>(plots.size());
  for (std::size_t i = 0; i < plots.size(); ++i) {
    const auto column =
        std::find(model.figure_names->begin(), model.figure_names->end(), plots[i]) - model.figure_names->begin();
    const float top = start.y + static_cast<float>(i) * each;
    draw_strip(model, static_cast<std::size_t>(column), axis, top, top + each - 2.0f * u,
               kPlotInks[i % std::size(kPlotInks)], ImGui::GetFontSize(), u);
  }
  ImDrawList& list = *ImGui::GetWindowDrawList();
  for (const int k : *model.changed_frames)
    list.AddLine({axis.x(k), start.y}, {axis.x(k), start.y + 5.0f * u}, ink(0xffb84d), 1.5f * u);
  double now = model.frame;
  if (model.stages != nullptr) {  // its sub-steps between the frame before and this one
    const FrameStages& stages = *model.stages;
    const auto at = [&](double substeps) { return model.frame - 1 + substeps / stages.substeps; };
    for (int s = 0; s <= stages.substeps; ++s)
      list.AddLine({axis.x(at(s)), start.y + size.y - 6.0f * u}, {axis.x(at(s)), start.y + size.y}, ink(0x8fd0ff), u);
    const int ended = stages.ended_at(model.place);
    const int from = ended == 0 ? -1 : stages.end_of(ended), to = stages.end_of(std::min(ended + 1, stages.substeps));
    now = at(ended + (to > from ? double(model.place - from) / (to - from) : 0.0));
  }
  list.AddLine({axis.x(now), start.y}, {axis.x(now), start.y + size.y}, ink(0xffffff, 0.8f), u);
  if (ImGui::IsItemActive()) {
    const int to = std::clamp(axis.frame(ui.mouse_x()), 0, model.known_last);
    if (to != model.frame) lines.push_back(fmt::format("seek {}", to));
  } else {
    const int at = axis.frame(ui.mouse_x());
    if (ImGui::IsItemHovered() && at >= 0 && at <= model.known_last) {
      std::string text = fmt::format("frame {}", at);
      for (const std::string& name : plots) {
        const auto column =
            std::find(model.figure_names->begin(), model.figure_names->end(), name) - model.figure_names->begin();
        text += fmt::format("\n{} {:.6g}", name,
                            (*model.history)[static_cast<std::size_t>(at)][static_cast<std::size_t>(column)]);
      }
      tooltip(text);
    }
  }
}

}  // namespace

Panel timeline_panel() { return {"timeline", "", PanelPlace::below, {}, draw}; }

}  // namespace impinge
