// Chosen figures over the frames, one strip each: its name at its left, the present value at its right. A click or drag
// seeks.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "viewer/gl/packed_color.hpp"
#include "viewer/panels/debug/outliner.hpp"
#include "viewer/panels/debug/series.hpp"

namespace impinge {
namespace {

ImU32 ink(std::uint32_t rgb, float alpha = 1.0f) { return packed(hex(rgb, alpha)); }

constexpr float kNames = 146.0f, kValues = 100.0f, kDigits = 56.0f;  // room for them beside the strips

struct Axis {
  float left, right;
  int last;
  float x(double frame) const { return left + static_cast<float>(frame) / static_cast<float>(last) * (right - left); }
  int frame(float at) const {
    return static_cast<int>(std::lround((at - left) / (right - left) * static_cast<float>(last)));
  }
};

/// Values to heights: from 0 (or what lies below) to the largest; logarithmic by the powers of ten of what is positive.
struct Scale {
  float top, bottom;
  double low = 0.0, high = 0.0;
  bool is_log = false;

  float y(double v) const {
    if (is_log) v = v > 0.0 ? std::log10(v) : low;
    const double span = high > low ? high - low : 1.0, share = std::clamp((v - low) / span, 0.0, 1.0);
    return bottom - 2.0f - static_cast<float>(share) * (bottom - top - 4.0f);
  }
};

Scale scale_of(const std::vector<double>& values, float top, float bottom, bool is_log) {
  Scale scale{top, bottom};
  scale.is_log = is_log;
  if (is_log) {  // whole decades
    double least = 1e300, most = 0.0;
    for (const double v : values)
      if (std::isfinite(v) && v > 0.0) least = std::min(least, v), most = std::max(most, v);
    if (most > 0.0) scale.low = std::floor(std::log10(least)), scale.high = std::ceil(std::log10(most) + 1e-9);
    return scale;
  }
  for (const double v : values)
    if (std::isfinite(v)) scale.low = std::min(scale.low, v), scale.high = std::max(scale.high, v);
  return scale;
}

/// A pixel may hold many frames: from its least to its largest. Where there is no number the line is broken.
void draw_line(const std::vector<double>& values, const Axis& axis, const Scale& scale, ImU32 color, float width) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  std::vector<ImVec2> points;
  const auto finish = [&] {
    if (points.size() == 1) points.push_back({points[0].x + 1.0f, points[0].y});
    list.AddPolyline(points.data(), static_cast<int>(points.size()), color, 0, width);
    points.clear();
  };
  for (std::size_t k = 0; k < values.size();) {
    const float x = axis.x(static_cast<double>(k));
    double least = values[k], most = least;
    std::size_t end = k + 1;
    for (; end < values.size() && axis.x(static_cast<double>(end)) < x + 1.0f; ++end)
      least = std::min(least, values[end]), most = std::max(most, values[end]);
    if (std::isfinite(least) && std::isfinite(most)) {
      points.push_back({x, scale.y(most)});
      if (end > k + 1) points.push_back({x, scale.y(least)});
    } else {
      finish();
    }
    k = end;
  }
  finish();
}

/// The text, without its middle where it is too wide.
std::string shortened(const std::string& text, float width) {
  if (ImGui::CalcTextSize(text.c_str()).x <= width) return text;
  for (std::size_t tail = text.size() / 2; tail > 2; --tail) {
    std::string shorter = text.substr(0, tail) + ".." + text.substr(text.size() - tail);
    if (ImGui::CalcTextSize(shorter.c_str()).x <= width) return shorter;
  }
  return text.substr(0, 2);
}

void draw_strip(const DebugModel& model, const Series& series, const Axis& axis, float top, float bottom,
                std::uint32_t rgb, float unit) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  std::vector<double> values;
  for (int frame = 0; frame <= model.known_last; ++frame) values.push_back(series.value(frame));
  const Scale scale = scale_of(values, top, bottom, model.state.log_plots);
  list.AddRectFilled({axis.left, top}, {axis.right, bottom}, ink(0x232931));
  if (scale.is_log)
    for (double decade = scale.low + 1.0; decade < scale.high && scale.high - scale.low < 20.0; ++decade) {
      const float y = scale.y(std::pow(10.0, decade));
      list.AddLine({axis.left, y}, {axis.right, y}, ink(0x343c47));
    }
  else if (scale.low < 0.0)
    list.AddLine({axis.left, scale.y(0.0)}, {axis.right, scale.y(0.0)}, ink(0x4a5563));
  const float text = ImGui::GetFontSize(), middle = 0.5f * (top + bottom - text);
  draw_line(values, axis, scale, ink(rgb), std::max(1.0f, text / 10.0f));
  list.AddText({axis.left - kNames * unit, middle}, ink(rgb), shortened(series.name, (kNames - 6.0f) * unit).c_str());
  // digits end where units begin
  // within a frame they are not known yet
  NumberText value = series.text(values[static_cast<std::size_t>(model.frame)]);
  if (model.stages != nullptr) value = {"end " + value.digits, value.unit};
  const float edge = axis.right + kDigits * unit, width = ImGui::CalcTextSize(value.digits.c_str()).x;
  list.AddText({edge - width, middle}, ink(0xf2f4f7), value.digits.c_str());
  list.AddText({edge + 5.0f * unit, middle}, ink(0x98a2b0), value.unit.c_str());
}

/// Figures of the body or the pair that is selected.
std::vector<std::string> quantities_of_selected(const DebugModel& model) {
  std::string words;
  const std::vector<BodyIndex> selected = selected_bodies(model);
  for (const BodyIndex body : selected) words += (words.empty() ? "" : ",") + name_of(model, body);
  std::vector<std::string> all;
  for (const BodyFigure& figure : body_figures())
    if (!selected.empty() && figure.in_plots() && figure.function != BodyFunction::energy_from &&
        (selected.size() == 1 || figure.bodies == 2))
      all.push_back(fmt::format("{}({})", figure.name, words));
  return all;
}

/// Of the ledger, where books are kept: of all bodies, or of the one that is selected.
void add_sources(const DebugModel& model, std::vector<std::string>& names) {
  if (model.tracks == nullptr || model.tracks->ledger_sum(model.frame).frames == 0) return;
  const std::vector<BodyIndex> selected = selected_bodies(model);
  const std::string body = selected.size() == 1 ? "," + name_of(model, selected.front()) : "";
  for (const LedgerSourceInfo& info : ledger_sources())
    names.push_back(fmt::format("energy_from({}{})", info.name, body));
}

void draw_chooser(Ui& ui, const DebugModel& model, CommandLines& lines) {
  ImGui::SetNextItemWidth(120.0f * ui.unit());
  const bool open = ImGui::BeginCombo("##columns", "columns", ImGuiComboFlags_HeightLarge);
  ui.name("timeline/columns");
  if (!open) return;
  // what is plotted though it is of nothing that is selected now can be taken away here too
  std::vector<std::string> names = quantities_of_selected(model);
  add_sources(model, names);
  for (const std::string& plot : model.state.plots)
    if (plot.ends_with(')') && std::find(names.begin(), names.end(), plot) == names.end()) names.push_back(plot);
  names.insert(names.end(), model.figure_names->begin(), model.figure_names->end());
  for (const std::string& name : names) {
    bool on = std::find(model.state.plots.begin(), model.state.plots.end(), name) != model.state.plots.end();
    if (ImGui::Checkbox(name.c_str(), &on)) lines.push_back(fmt::format("panel plot {}{}", on ? '+' : '-', name));
    ui.name("timeline/columns:" + name);
  }
  close_on_escape(ui);
  ImGui::EndCombo();
}

void draw_header(Ui& ui, const DebugModel& model, CommandLines& lines) {
  ImGui::TextColored({0.55f, 0.78f, 0.95f, 1.0f}, "timeline");
  tooltip(
      "white: where it stands; orange ticks: frames that lines change, which the pointer over them tells;\nblue ticks: "
      "sub-steps of the frame that it is in");
  ImGui::SameLine();
  draw_chooser(ui, model, lines);
  ImGui::SameLine();
  bool is_log = model.state.log_plots;
  if (ImGui::Checkbox("log", &is_log)) lines.push_back(fmt::format("panel axis {}", is_log ? "log" : "linear"));
  ui.name("timeline/log");
  tooltip("by powers of ten; what is not positive is at the bottom");
}

constexpr float kNear = 4.0f;         // pixels of the smallest size: a tick is hit
constexpr std::size_t kMostTold = 8;  // commands of a frame

/// The frame of the tick that is under the pointer, else the frame itself.
int ticked(const DebugModel& model, const Axis& axis, float x, int frame, float unit) {
  int nearest = frame;
  float best = kNear * unit;
  const auto from = model.changed_frames->lower_bound(axis.frame(x - best) - 1);
  for (auto it = from; it != model.changed_frames->end() && axis.x(*it) <= x + kNear * unit; ++it)
    if (const float way = std::abs(axis.x(*it) - x); way <= best) best = way, nearest = *it;
  return nearest;
}

void draw_hovered(const DebugModel& model, const std::vector<Series>& all, int frame) {
  std::string text = fmt::format("frame {}", frame);
  if (model.changed_frames->contains(frame)) {
    const std::vector<std::string> commands = model.commands_of(frame);
    for (std::size_t i = 0; i < std::min(commands.size(), kMostTold); ++i) text += "\nchanged: " + commands[i];
    if (commands.size() > kMostTold) text += fmt::format("\nand {} more", commands.size() - kMostTold);
  }
  for (const Series& series : all)
    text += fmt::format("\n{} {}", series.name, series.text(series.value(frame)).whole());
  tooltip(text);
}

void draw_timeline(Ui& ui, const DebugModel& model, CommandLines& lines) {
  const float u = ui.unit();
  draw_header(ui, model, lines);
  std::vector<Series> all;
  for (const std::string& name : model.state.plots) all.push_back(series_of(model, name));
  const ImVec2 start = ImGui::GetCursorScreenPos(), size = ImGui::GetContentRegionAvail();
  if (size.x < 20.0f * u || size.y < 20.0f * u) return;
  const float left = start.x + kNames * u, right = std::max(left + 20.0f * u, start.x + size.x - kValues * u);
  ImGui::SetCursorScreenPos({left, start.y});
  ImGui::InvisibleButton("strips", {right - left, size.y});
  ui.name("timeline/plot");
  const Axis axis{left, right, std::max(1, model.known_last)};
  const float each = all.empty() ? size.y : size.y / static_cast<float>(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    const float top = start.y + static_cast<float>(i) * each;
    draw_strip(model, all[i], axis, top, top + each - 2.0f * u, kPlotInks[i % std::size(kPlotInks)], u);
  }
  ImDrawList& list = *ImGui::GetWindowDrawList();
  for (const int k : *model.changed_frames)
    list.AddLine({axis.x(k), start.y}, {axis.x(k), start.y + 5.0f * u}, ink(0xffb84d), 1.5f * u);
  double now = model.frame;
  if (model.stages != nullptr) {  // its sub-steps between the frame before and this one
    const FrameStages& stages = *model.stages;
    const auto after = [&](double substeps) { return model.frame - 1 + substeps / stages.substeps; };
    for (int s = 0; s <= stages.substeps; ++s)
      list.AddLine({axis.x(after(s)), start.y + size.y - 6.0f * u}, {axis.x(after(s)), start.y + size.y}, ink(0x8fd0ff),
                   u);
    const int ended = stages.ended_at(model.place);
    const int from = ended == 0 ? -1 : stages.end_of(ended), to = stages.end_of(std::min(ended + 1, stages.substeps));
    now = after(ended + (to > from ? double(model.place - from) / (to - from) : 0.0));
  }
  list.AddLine({axis.x(now), start.y}, {axis.x(now), start.y + size.y}, ink(0xffffff, 0.8f), u);
  const int at = axis.frame(ui.mouse_x());
  if (ImGui::IsItemActive()) {
    const int to = std::clamp(at, 0, model.known_last);
    if (to != model.frame) lines.push_back(fmt::format("seek {}", to));
  } else if (ImGui::IsItemHovered() && at >= 0 && at <= model.known_last) {
    draw_hovered(model, all, std::clamp(ticked(model, axis, ui.mouse_x(), at, u), 0, model.known_last));
  }
}

}  // namespace

Panel timeline_panel() { return {"timeline", "", PanelPlace::below, {}, draw_timeline}; }

}  // namespace impinge
