// Play, pause, step, step back; a slider over the frames that are known.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "viewer/panels/debug/widgets.hpp"

namespace impinge {

namespace {

void draw_transport(Ui& ui, const DebugModel& model, CommandLines& lines) {
  if (named_button(ui, "transport/first", "|<")) lines.push_back("seek 0");
  tooltip("first frame (home)");
  ImGui::SameLine();
  if (named_button(ui, "transport/back", "<") && model.frame > 0) lines.push_back("back");
  tooltip("a frame back (left)");
  ImGui::SameLine();
  if (named_button(ui, "transport/play", model.playing ? "pause" : "play ", model.playing))
    lines.push_back(model.playing ? "pause" : "play");
  tooltip("space");
  ImGui::SameLine();
  if (named_button(ui, "transport/step", ">")) lines.push_back("step");
  tooltip("a frame on (right)");
  ImGui::SameLine();
  if (named_button(ui, "transport/last", ">|")) lines.push_back(fmt::format("seek {}", model.known_last));
  tooltip("last frame that was made (end)");
  ImGui::SameLine();

  const std::string memory =
      model.computing > 0.0
          ? fmt::format("computing frame {}, {:.1f} s; esc ends it", model.frame + 1, model.computing)
          : fmt::format("{}, {:.1f} of {:.0f} MB", counted(static_cast<std::int64_t>(model.snapshots), "state"),
                        static_cast<double>(model.snapshot_bytes) / 1048576.0,
                        static_cast<double>(model.most_snapshot_bytes) / 1048576.0);
  const std::string time = fmt::format("{:.4f} s", model.record->stats.time);
  const float right = ImGui::CalcTextSize(memory.c_str()).x + ImGui::CalcTextSize(time.c_str()).x + 40.0f * ui.unit();
  ImGui::SetNextItemWidth(std::max(80.0f * ui.unit(), ImGui::GetContentRegionAvail().x - right));
  double at = model.frame;  // of whole numbers the grab is as wide as one
  const double none = 0.0, last = std::max(1, model.known_last);
  if (ImGui::SliderScalar("##frame", ImGuiDataType_Double, &at, &none, &last,
                          model.stages != nullptr
                              ? fmt::format("frame {}: {}", model.frame, model.stages->words(model.place)).c_str()
                              : fmt::format("frame {} of {}", model.frame, model.known_last).c_str(),
                          ImGuiSliderFlags_NoInput)) {
    const int to = std::clamp(static_cast<int>(std::lround(at)), 0, model.known_last);
    if (to != model.frame) lines.push_back(fmt::format("seek {}", to));
  }
  ui.name("transport/frame", {{}, false, true, false, 0.0, last, false});
  tooltip("drag to any frame that was made: the nearest state kept is taken and the frames after it are made again");
  ImGui::SameLine();
  ImGui::TextUnformatted(time.c_str());
  ImGui::SameLine();
  ImGui::TextColored(model.computing > 0.0 ? ImVec4{1.0f, 0.72f, 0.3f, 1.0f} : dim(), "%s", memory.c_str());
  tooltip("states kept for going back; where there are too many the ones that are missed least go");
}

}  // namespace

Panel transport_panel() { return {"transport", "", PanelPlace::bar, {0.0f, 34.0f}, draw_transport}; }

}  // namespace impinge
