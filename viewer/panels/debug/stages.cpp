// What each stage of the last frame had to do, and, where view.panel.timings is on, how long it took.
#include <fmt/format.h>

#include <algorithm>

#include "viewer/panels/debug/widgets.hpp"

namespace impinge {

namespace {

void draw(Ui& ui, const DebugModel& model, CommandLines& lines) {
  const FrameStats& s = model.record->stats;
  struct Row {
    const char* name;
    double ms;
    std::string work;
  };
  const Row rows[] = {
      {"broad", model.figure("broad_ms"), counted(s.broad_pairs, "body pair")},
      {"narrow", model.figure("narrow_ms"), counted(s.triangle_pairs, "triangle pair")},
      {"assemble", model.figure("assemble_ms"),
       fmt::format("{}, {}", counted(s.dofs, "unknown"), counted(s.contacts, "contact"))},
      {"response", model.figure("response_ms"),
       s.contacts == 0 ? "nothing to solve"
                       : fmt::format("{}, {}", counted(s.groups, "group"), counted(s.lcp_iterations, "iteration"))},
      {"integrate", model.figure("integrate_ms"), counted(s.substeps, "sub-step")}};
  const double step_ms = model.figure("step_ms");
  bool timed = model.view->show_timings;
  if (!ImGui::BeginTable("stages", 2, ImGuiTableFlags_SizingStretchProp)) return;
  ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthFixed, 66.0f * ui.unit());
  ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthStretch);
  for (const Row& row : rows) {
    ImGui::TableNextColumn();
    ImGui::TextColored(dim(), "%s", row.name);
    ImGui::TableNextColumn();
    if (!timed) {
      ImGui::TextUnformatted(row.work.c_str());
      continue;
    }
    const float share = step_ms > 0.0 ? static_cast<float>(row.ms / step_ms) : 0.0f;
    ImGui::PushStyleColor(ImGuiCol_PlotHistogram, ImGui::GetStyleColorVec4(ImGuiCol_SliderGrab));
    ImGui::ProgressBar(std::clamp(share, 0.0f, 1.0f), {-1.0f, ImGui::GetTextLineHeight()},
                       fmt::format("{:.2f} ms", row.ms).c_str());
    ImGui::PopStyleColor();
    tooltip(row.work);
  }
  ImGui::EndTable();
  if (ImGui::Checkbox("times", &timed))
    lines.push_back(fmt::format("set view.panel.timings {}", timed ? "true" : "false"));
  ui.name("stages/times");
  tooltip("wall-clock times: pictures with them are not the same twice");
  if (timed) {
    ImGui::SameLine();
    ImGui::Text("%.2f ms a frame", step_ms);
  }
}

}  // namespace

Panel stages_panel() { return {"stages", "stages of the frame", PanelPlace::right, {0.28f, 150.0f}, draw}; }

}  // namespace impinge
