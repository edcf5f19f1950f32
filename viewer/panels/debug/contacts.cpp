// The frame's contacts as a table. A heading sorts, a row selects.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "viewer/panels/debug/widgets.hpp"

namespace impinge {
namespace {

constexpr std::size_t kLetters = 7;  // that a column has room for

std::string narrow(double v) {
  const std::string text = brief(v);
  return text.size() > kLetters ? brief(v, 1) : text;
}

/// The text, or its beginning and end where it is too wide: names often differ in their last letters.
std::string elided(const std::string& text, float width) {
  const auto letters = static_cast<std::size_t>(width / ImGui::CalcTextSize("0").x);
  if (text.size() <= letters || letters < 5) return text;
  const std::size_t tail = (letters - 1) / 2;
  return text.substr(0, letters - 2 - tail) + ".." + text.substr(text.size() - tail);
}

void draw_arrow(bool down) {
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  const float half = 0.25f * ImGui::GetFontSize(), x = high.x - 2.5f * half, y = 0.5f * (low.y + high.y),
              tip = down ? half : -half;
  ImGui::GetWindowDrawList()->AddTriangleFilled({x - half, y - 0.6f * tip}, {x + half, y - 0.6f * tip}, {x, y + tip},
                                                ImGui::GetColorU32(ImGuiCol_Text));
}

double value_of(const ContactRecord& c, std::size_t column) {
  switch (column) {
    case 1:
      return c.body_a;
    case 2:
      return c.body_b;
    case 3:
      return c.gap;
    case 4:
      return c.lambda.x();
    case 5:
      return std::hypot(c.lambda.y(), c.lambda.z());
    case 6:
      return static_cast<double>(c.state);
    default:
      return 0.0;
  }
}

Color state_color(ContactState state) {
  return state == ContactState::stick ? role::kStick : state == ContactState::slip ? role::kSlip : role::kOpen;
}

std::vector<int> sorted(const DebugModel& model) {
  const std::vector<ContactRecord>& contacts = model.record->contacts;
  std::vector<int> order(contacts.size());
  std::iota(order.begin(), order.end(), 0);
  const auto column = static_cast<std::size_t>(
      std::find(contact_columns().begin(), contact_columns().end(), model.state.sort) - contact_columns().begin());
  const bool down = model.state.descending;
  if (column == 0 && down) std::reverse(order.begin(), order.end());
  if (column > 0)
    std::stable_sort(order.begin(), order.end(), [&](int l, int r) {
      const double a = value_of(contacts[static_cast<std::size_t>(l)], column),
                   b = value_of(contacts[static_cast<std::size_t>(r)], column);
      return down ? a > b : a < b;
    });
  return order;
}

std::string count(const DebugModel& model) {
  const int asleep = model.record->stats.asleep;  // their contacts are not looked for
  return fmt::format(": {}{}   mm, N s", model.record->contacts.size(),
                     asleep > 0 ? fmt::format(" ({} asleep)", asleep) : "");
}

void draw(Ui& ui, const DebugModel& model, CommandLines& lines) {
  const std::vector<ContactRecord>& contacts = model.record->contacts;
  static constexpr const char* kHeads[] = {"#", "A", "B", "gap", "n", "t", ""};
  static constexpr const char* kTips[] = {
      "index in this frame",        "the body that stands earlier in the scene", "the other body",
      "mm, negative: they overlap", "normal impulse of the last sub-step, N s",  "size of the friction impulse, N s",
      "open, stick or slip"};
  const ImGuiTableFlags flags = ImGuiTableFlags_SizingStretchProp | ImGuiTableFlags_RowBg | ImGuiTableFlags_PadOuterX;
  ImGui::PushStyleVar(ImGuiStyleVar_CellPadding, ImVec2(2.0f * ui.unit(), 1.0f * ui.unit()));
  const bool open = ImGui::BeginTable("rows", 7, flags);
  ImGui::PopStyleVar();
  if (!open) return;
  constexpr float kWeights[] = {2.6f, 5.0f, 5.0f, 4.9f, 4.5f, 4.9f, 1.2f};
  for (int k = 0; k < 7; ++k) ImGui::TableSetupColumn(kHeads[k], ImGuiTableColumnFlags_WidthStretch, kWeights[k]);
  ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
  for (std::size_t k = 0; k < contact_columns().size(); ++k) {
    ImGui::TableNextColumn();
    const bool by = model.state.sort == contact_columns()[k];
    const std::string label = fmt::format("{} ###{}", kHeads[k], k);  // the space: of #### the first would not show
    if (ImGui::Selectable(label.c_str(), by))
      lines.push_back(
          fmt::format("panel sort {}{}", contact_columns()[k], by && !model.state.descending ? " down" : ""));
    ui.name("contacts/sort:" + contact_columns()[k]);
    if (by) draw_arrow(model.state.descending);
    tooltip(kTips[k]);
  }
  const std::vector<int> order = sorted(model);
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(order.size()));
  while (clipper.Step())
    for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
      const int index = order[static_cast<std::size_t>(i)];
      const ContactRecord& c = contacts[static_cast<std::size_t>(index)];
      const auto body = [&](int b) { return std::string(model.record->bodies[static_cast<std::size_t>(b)].name); };
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      const bool is_selected = model.selection.kind == Selection::contact && model.selection.index == index;
      if (ImGui::Selectable(fmt::format("{}##{}", index, i).c_str(), is_selected, ImGuiSelectableFlags_SpanAllColumns))
        lines.push_back(fmt::format("select contact {}", index));
      ui.name(fmt::format("contacts/row:{}", i));
      tooltip(fmt::format("{} and {}, {}", body(c.body_a), body(c.body_b), state_name(c.state)));
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(elided(body(c.body_a), ImGui::GetContentRegionAvail().x).c_str());
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(elided(body(c.body_b), ImGui::GetContentRegionAvail().x).c_str());
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(narrow(1e3 * c.gap).c_str());
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(narrow(c.lambda.x()).c_str());
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(narrow(std::hypot(c.lambda.y(), c.lambda.z())).c_str());
      ImGui::TableNextColumn();
      const Color s = state_color(c.state);
      const ImVec2 at = ImGui::GetCursorScreenPos();
      const float half = 0.5f * ImGui::GetTextLineHeight();
      ImGui::GetWindowDrawList()->AddCircleFilled({at.x + half, at.y + half}, 0.7f * half,
                                                  ImGui::ColorConvertFloat4ToU32({s.r, s.g, s.b, 1.0f}));
    }
  ImGui::EndTable();
}

}  // namespace

Panel contacts_panel() { return {"contacts", "contacts", PanelPlace::right, {}, draw, count}; }

}  // namespace impinge
