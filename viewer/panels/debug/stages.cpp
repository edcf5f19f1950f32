// What each stage of the last frame had to do, and, where view.panel.timings is on, how long it took. In the middle of a
// frame: all its stages, sub-step by sub-step, with what came of each; a click goes to one.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "viewer/panels/debug/widgets.hpp"

namespace impinge {

namespace {

void draw_within(Ui& ui, const DebugModel& model, CommandLines& lines) {
  const FrameStages& stages = *model.stages;
  const std::size_t now = stages.entry_at(model.place).first;
  int first = 0, substep = 0;
  std::string motion;
  for (std::size_t i = 0; i < stages.entries.size(); ++i) {
    const StageEntry& entry = stages.entries[i];
    if (entry.substep != substep) {
      substep = entry.substep;
      motion = "piece 1, attempt 1";
      ImGui::TextColored({0.55f, 0.78f, 0.95f, 1.0f}, "sub-step %d of %d", substep, stages.substeps);
    }
    if (const std::string here = fmt::format("piece {}, attempt {}", entry.piece, entry.motion);
        here != motion && entry.kind != StageKind::end) {
      motion = here;
      ImGui::TextColored(dim(), "%s", here.c_str());
    }
    std::string words = entry.words;
    if (entry.kind == StageKind::iteration) {
      const int last = entry.count - 1 + entry.first_iteration;
      words = i == now ? fmt::format("iteration {} of {}", model.place - first + entry.first_iteration, last)
                       : counted(last, "iteration");
    }
    if (ImGui::Selectable(fmt::format("##{}", i).c_str(), i == now) && first != model.place)
      lines.push_back(fmt::format("{} stage {}", first > model.place ? "step" : "back", std::abs(first - model.place)));
    // once, when another is the present one: who scrolls away meanwhile is let
    if (int& shown = *ImGui::GetStateStorage()->GetIntRef(ImGui::GetID("shown"), -1); i == now && shown != model.place)
      ImGui::SetScrollHereY(), shown = model.place;
    ui.name(fmt::format("stages/{}", i));
    ImGui::SameLine(8.0f * ui.unit());
    ImGui::TextUnformatted(std::string(name_of(entry.kind)).c_str());
    ImGui::SameLine(100.0f * ui.unit());
    ImGui::TextColored(dim(), "%s", words.c_str());
    first += entry.count;
  }
}

void draw_stages(Ui& ui, const DebugModel& model, CommandLines& lines) {
  if (model.stages != nullptr) return draw_within(ui, model, lines);
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
      {"integrate", model.figure("integrate_ms"), counted(s.substeps, "sub-step")},
      {"guard", model.figure("guard_ms"), counted(s.unsafe_motions, "unsafe motion")}};
  const double step_ms = model.figure("step_ms");
  bool timed = model.view->show_timings;
  if (ImGui::Checkbox("times", &timed))
    lines.push_back(fmt::format("set view.panel.timings {}", timed ? "true" : "false"));
  ui.name("stages/times");
  tooltip("wall-clock times: pictures with them are not the same twice");
  if (timed) {
    ImGui::SameLine();
    ImGui::Text("%.2f ms a frame", step_ms);
  }
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
}

}  // namespace

Panel stages_panel() { return {"stages", "stages of the frame", PanelPlace::right, {0.28f, 150.0f}, draw_stages}; }

}  // namespace impinge
