#include "viewer/panels/debug/keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "viewer/panels/debug/outliner.hpp"

namespace impinge {

namespace {

/// Hide, look at alone and frame what is selected; a contact means its two bodies.
void bodies_to_lines(const Ui& ui, const DebugModel& model, CommandLines& lines) {
  std::string names;
  for (const BodyIndex body : selected_bodies(model)) names += " " + name_of(model, body);
  if (ui.key_pressed("f")) lines.push_back(names.empty() ? "camera fit" : "frame" + names);
  if (!ui.key_pressed("h")) return;
  if (ImGui::GetIO().KeyCtrl)
    lines.push_back("show all");
  else if (!names.empty())
    lines.push_back((ImGui::GetIO().KeyShift ? "isolate" : "hide") + names);
}

/// One word, and another for each state.
std::string bundle_name(const DebugModel& model) {
  std::string stem = model.scene.substr(0, model.scene.rfind('.'));
  for (char& c : stem)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '-') c = '_';
  return fmt::format("{}_{:06}_{:08x}.tar", stem, model.frame, model.record->stats.state_hash >> 32);
}

}  // namespace

void keys_to_lines(const Ui& ui, const DebugModel& model, CommandLines& lines) {
  if (ui.key_pressed("f1")) lines.push_back(model.state.help ? "panel help off" : "panel help on");
  if (model.computing > 0.0 && ui.key_pressed("escape")) {
    lines.push_back("stop");
    return;
  }
  if (ui.takes_keys()) return;
  if (ui.key_pressed("space")) lines.push_back(model.playing ? "pause" : "play");
  if (ui.key_pressed("right")) lines.push_back("step");
  if (ui.key_pressed("left") && model.frame > 0) lines.push_back("back");
  if (ui.key_pressed("page_up")) lines.push_back("step 10");
  if (ui.key_pressed("page_down") && model.frame > 0)
    lines.push_back(fmt::format("back {}", std::min(10, model.frame)));
  if (ui.key_pressed("down")) lines.push_back("step stage");
  if (ui.key_pressed("up") && model.frame > 0) lines.push_back("back stage");
  if (ui.key_pressed("home")) lines.push_back("seek 0");
  if (ui.key_pressed("end")) lines.push_back(fmt::format("seek {}", model.known_last));
  if (ui.key_pressed("a")) lines.push_back("camera fit");
  if (ui.key_pressed("z") && ImGui::GetIO().KeyCtrl) lines.push_back(ImGui::GetIO().KeyShift ? "redo" : "undo");
  if (ui.key_pressed("b")) lines.push_back("bundle " + bundle_name(model));
  bodies_to_lines(ui, model, lines);
  constexpr ImGuiPopupFlags kAnyPopup = ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel;
  if (ui.key_pressed("escape") && !ImGui::IsPopupOpen("", kAnyPopup))
    lines.push_back(model.state.help ? "panel help off" : "select none");
}

void draw_help(const DebugModel& model, const UiArea& view) {
  if (!model.state.help) return;
  static constexpr const char* kRows[][2] = {{"space", "play, pause"},
                                             {"right, left", "a frame on, a frame back"},
                                             {"down, up", "a stage on, a stage back"},
                                             {"page up, down", "ten frames"},
                                             {"home, end", "first, last known frame"},
                                             {"f", "frame the selected, else all"},
                                             {"a", "fit the view to all"},
                                             {"h, shift h", "hide the selected, all others"},
                                             {"ctrl h", "show all"},
                                             {"ctrl z, ctrl shift z", "undo, redo a change"},
                                             {"b", "all of this into one file, to be opened elsewhere"},
                                             {"escape", "end the frame in work; deselect; close this"},
                                             {"left button", "orbit; a click picks"},
                                             {"ctrl + left button", "pull a body"},
                                             {"right, middle", "pan"},
                                             {"wheel", "zoom; scroll a panel"},
                                             {"ctrl + click", "type a slider's value"},
                                             {"f1", "this list"}};
  ImGui::SetNextWindowPos({view.x + 0.5f * view.width, view.y + 0.5f * view.height}, 0, {0.5f, 0.5f});
  ImGui::Begin("help", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_AlwaysAutoResize |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoNav);
  ImGui::TextColored({0.55f, 0.78f, 0.95f, 1.0f}, "keys and mouse");
  ImGui::Separator();
  if (ImGui::BeginTable("keys", 2, ImGuiTableFlags_SizingFixedFit)) {
    for (const auto& row : kRows) {
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(row[0]);
      ImGui::TableNextColumn();
      ImGui::TextColored(dim(), "  %s", row[1]);
    }
    ImGui::EndTable();
  }
  ImGui::End();
}

}  // namespace impinge
