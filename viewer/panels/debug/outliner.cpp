// All that is in the scene, to be found by name or by any of its numbers: bodies, collision groups and pairs of bodies, a
// tab each. What is selected can be hidden, looked at alone, framed and followed.
#include "viewer/panels/debug/outliner.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "viewer/draw/body_color.hpp"

namespace impinge {
namespace {

/// Of what is selected in the present tab: in that of groups all of the group.
std::vector<std::string> meant(const DebugModel& model) {
  std::vector<BodyIndex> bodies = selected_bodies(model);
  if (model.state.tab == "groups" && !bodies.empty())
    for (const std::vector<BodyIndex>& group : model.record->groups)
      if (std::find(group.begin(), group.end(), bodies.back()) != group.end()) {
        bodies = group;
        break;
      }
  std::vector<std::string> names;
  for (const BodyIndex body : bodies) names.push_back(name_of(model, body));
  return names;
}

/// Buttons beside each other, and below each other where there is no room.
class ButtonRow {
 public:
  explicit ButtonRow(Ui& ui) : ui_(ui), room_(ImGui::GetContentRegionAvail().x) {}

  bool add(const char* label, const std::string& name, const char* doc, bool enabled, bool lit = false) {
    const float width = ImGui::CalcTextSize(label).x + 2.0f * ImGui::GetStyle().FramePadding.x, gap = 4.0f * ui_.unit();
    if (used_ > 0.0f && used_ + gap + width <= room_)
      ImGui::SameLine(0.0f, gap), used_ += gap + width;
    else
      used_ = width;
    ImGui::BeginDisabled(!enabled);
    const bool clicked = named_button(ui_, name, label, lit);
    ImGui::EndDisabled();
    tooltip(doc);
    return clicked;
  }

 private:
  Ui& ui_;
  float room_, used_ = 0.0f;
};

const BodyRecord& record_of(const DebugModel& model, const std::string& name) {
  return *std::find_if(model.record->bodies.begin(), model.record->bodies.end(),
                       [&](const BodyRecord& body) { return body.name == name; });
}

bool can_be_copied(const DebugModel& model, const std::string& name) {
  const BodyRecord& body = record_of(model, name);
  return !body.deleted && (body.kind == BodyKind::dynamic || body.kind == BodyKind::deformable);
}

/// NAME_2, NAME_3, ...: the first that no body has, nor will have.
std::string free_name(const DebugModel& model, const std::string& name) {
  std::string stem = name;
  if (const std::size_t end = stem.find_last_not_of("0123456789"); end != std::string::npos && stem[end] == '_')
    stem = stem.substr(0, end);  // of a copy another copy
  for (int k = 2;; ++k)
    if (const std::string free = fmt::format("{}_{}", stem, k);
        model.rows->find("body." + free + ".friction") == nullptr)
      return free;
}

/// As the scene has it, as high above where it is now that the two don't touch.
std::string copy_line(const DebugModel& model, const std::string& name) {
  const BodyRecord& body = record_of(model, name);
  const Vec3 up = model.record->gravity.norm() > 0.0 ? Vec3(-model.record->gravity.normalized()) : Vec3(Vec3::UnitY());
  Vec3 origin = body.file_pose.position;
  if (body.deformable != nullptr) {
    const DeformableBody& soft = *body.deformable;
    Vec3 center = Vec3::Zero();
    for (int i = 0; i < soft.nodes(); ++i) center += soft.fem.node_mass()[i] * soft.rest_position(i);
    origin = body.pose.position - soft.placed.rotation * center / soft.fem.total_mass();
  }
  // the box round it as it lies may be smaller than the one round the copy, which is turned as at the start
  const double size = body.bounds.extent().norm();
  const Vec3 at = origin + 1.05 * size * up;
  const auto number = [&](double x) {  // to a thousandth of its size
    const double unit = std::pow(10.0, std::floor(std::log10(size)) - 3.0);
    return fmt::format("{:.{}g}", std::round(x / unit) * unit + 0.0, 12);
  };
  return fmt::format("add {} like {} at {} {} {}", free_name(model, name), name, number(at.x()), number(at.y()),
                     number(at.z()));
}

/// Colours to choose from for bodies, in a list that is open: the palette's and strong ones.
void draw_swatches(Ui& ui, const std::string& names, CommandLines& lines) {
  constexpr int kOfPalette = 7, kInRow = 8;
  constexpr std::uint32_t kStrong[] = {0xffffff, 0xd02020, 0xe8a010, 0x60b020, 0x1080d0, 0x8040c0, 0x202428, 0x808890};
  std::vector<Color> colors;
  for (int i = 0; i < kOfPalette; ++i) colors.push_back(series_color(i));
  for (const std::uint32_t rgb : kStrong) colors.push_back(hex(rgb));
  const float size = 1.2f * ImGui::GetTextLineHeight();
  for (std::size_t i = 0; i < colors.size(); ++i) {
    if (i % kInRow != 0) ImGui::SameLine(0.0f, 2.0f * ui.unit());
    const std::string text = color_text(colors[i]);
    const Color c = colors[i];
    if (ImGui::ColorButton(text.c_str(), {c.r, c.g, c.b, 1.0f}, ImGuiColorEditFlags_NoTooltip, {size, size}))
      lines.push_back("color " + names + " " + text);
    ui.name("outliner/color:" + text);
    tooltip(text);
  }
  if (ImGui::Selectable("as before")) lines.push_back("color " + names + " none");
  ui.name("outliner/color:none");
  tooltip("the palette's");
}

void draw_deeds(Ui& ui, const DebugModel& model, CommandLines& lines) {
  const std::vector<std::string> names = meant(model);
  const std::string all = fmt::format("{}", fmt::join(names, " "));
  const bool is_some = !names.empty();
  ButtonRow row(ui);
  if (row.add("isolate", "outliner/isolate", "hide all but the selected (shift h)", is_some))
    lines.push_back("isolate " + all);
  if (row.add("frame", "outliner/frame", "look at the selected (f)", is_some)) lines.push_back("frame " + all);
  const bool follows = is_some && model.view->followed == names.front();
  if (row.add("follow", "outliner/follow", "the camera goes along with the selected body",
              is_some || !model.view->followed.empty(), follows))
    lines.push_back("follow " + (follows || !is_some ? "none" : names.front()));
  if (row.add("color", "outliner/color", "colours for the selected bodies", is_some)) ImGui::OpenPopup("##swatches");
  if (ImGui::BeginPopup("##swatches")) {
    if (is_some) draw_swatches(ui, all, lines);
    close_on_escape(ui);
    ImGui::EndPopup();
  }
  if (row.add("copy", "outliner/copy", "one more of the selected body, above it, from the next frame on (add)",
              is_some && can_be_copied(model, names.front())))
    lines.push_back(copy_line(model, names.front()));
  if (row.add("show all", "outliner/show_all", "nothing is hidden (ctrl h)", !model.view->hidden.empty()))
    lines.push_back("show all");
}

void draw_kinds(Ui& ui, const DebugModel& model, CommandLines& lines) {
  const float gap = 4.0f * ui.unit();
  for (const std::string& tab : outliner_tabs()) {
    const bool is_open = tab == model.state.tab;
    if (named_button(ui, "outliner/" + tab, tab.c_str(), is_open) && !is_open) lines.push_back("panel tab " + tab);
    ImGui::SameLine(0.0f, gap);
  }
  if (ImGui::GetContentRegionAvail().x < 80.0f * ui.unit()) ImGui::NewLine();
}

void draw_outliner(Ui& ui, const DebugModel& model, CommandLines& lines) {
  draw_kinds(ui, model, lines);
  const Table& table = model.state.tab == "bodies"   ? bodies_table()
                       : model.state.tab == "groups" ? groups_table()
                                                     : pairs_table();
  ImGui::SetNextItemWidth(-1.0f);
  draw_column_chooser(ui, model, lines, "outliner", table);
  if (const auto words = search_field(ui, "outliner/search", model.state.search))
    lines.push_back("panel search " + *words);
  draw_deeds(ui, model, lines);
  const TableRows rows = model.state.tab == "bodies"   ? body_rows(ui, model, lines)
                         : model.state.tab == "groups" ? group_rows(model)
                                                       : pair_rows(model);
  ImGui::PushID(model.state.tab.c_str());
  draw_table(ui, model, lines, "outliner", table, rows);
  ImGui::PopID();
}

std::string count_of_bodies(const DebugModel& model) {
  const std::size_t hidden = model.view->hidden.size();
  return hidden == 0 ? "" : fmt::format(": {} hidden", hidden);
}

}  // namespace

const std::vector<std::string>& outliner_tabs() {
  static const std::vector<std::string> tabs = {"bodies", "groups", "pairs"};
  return tabs;
}

bool is_sought(const DebugModel& model, std::string_view name) {
  return model.state.search.empty() || name.find(model.state.search) != std::string_view::npos;
}

std::string name_of(const DebugModel& model, BodyIndex body) {
  return std::string(model.record->bodies[static_cast<std::size_t>(body.value())].name);
}

std::vector<BodyIndex> selected_bodies(const DebugModel& model) {
  const Selection& s = model.selection;
  if (!s.is_there()) return {};
  if (s.kind == Selection::body) return {BodyIndex(s.index)};
  const ContactRecord& c = model.record->contacts[static_cast<std::size_t>(s.index)];
  if (c.body_a == c.body_b) return {c.body_a};
  return {c.body_a, c.body_b};
}

double substep_time(const StepRecord& record) {
  return record.stats.substeps > 0 ? record.frame_time / record.stats.substeps : 0.0;
}

Panel outliner_panel() {
  Panel panel{"outliner", "outliner", PanelPlace::left, {}, draw_outliner, count_of_bodies};
  panel.shares = "parameters";
  panel.scrolls_inside = true;
  return panel;
}

}  // namespace impinge
