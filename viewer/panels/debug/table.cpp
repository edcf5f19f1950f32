#include "viewer/panels/debug/table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "viewer/draw/number_text.hpp"

namespace impinge {
namespace {

const TableState& state_of(const DebugModel& model, const Table& table) {
  static const TableState at_first;
  const auto it = model.state.tables.find(table.name);
  return it == model.state.tables.end() ? at_first : it->second;
}

/// Positions of those that are switched on, in the order in which they were chosen; of those that nobody chose the first
/// ones as if chosen last.
std::vector<std::size_t> chosen(const Table& table, const TableState& state) {
  std::vector<std::size_t> columns;
  for (const std::string& name : state.columns) columns.push_back(table.find(name));
  if (columns.empty())
    for (std::size_t c = table.columns.size(); c-- > 0;)
      if (table.columns[c].at_first) columns.push_back(c);
  return columns;
}

float wide(const std::string& text) { return ImGui::CalcTextSize(text.c_str()).x; }

// of a number: figures end where units begin, in every row
float unit_room(const TableColumn& column) { return column.unit.empty() ? 0.0f : wide("m" + std::string(column.unit)); }
float unit_gap(const TableColumn& column) { return column.unit.empty() ? 0.0f : 0.6f * wide("0"); }

/// What its texts and its head with the arrow of sorting want.
float width_of(const TableColumn& column) {
  float content = static_cast<float>(column.letters) * wide("n");
  if (column.look == TableColumn::whole) content = static_cast<float>(column.letters) * wide("0");
  if (column.look == TableColumn::number) content = wide("-88.8") + unit_gap(column) + unit_room(column);
  const float arrow = 0.9f * ImGui::GetFontSize();
  return column.head.empty() ? content : std::max(content, wide(std::string(column.head)) + arrow);
}

struct Fitting {
  std::vector<std::size_t> columns;  // in the order of the table
  std::vector<std::string> left_out;
};

/// Words stay; of numbers those that were chosen last.
Fitting fit(const Table& table, std::vector<std::size_t> wanted, float room, float cell) {
  Fitting fitting;
  for (const std::size_t c : wanted)
    if (table.columns[c].look == TableColumn::words) room -= width_of(table.columns[c]) + cell;
  std::reverse(wanted.begin(), wanted.end());
  for (const std::size_t c : wanted) {
    const TableColumn& column = table.columns[c];
    if (column.look != TableColumn::words && (room -= width_of(column) + cell) < 0.0f) {
      fitting.left_out.emplace_back(column.name);
      continue;
    }
    fitting.columns.push_back(c);
  }
  std::sort(fitting.columns.begin(), fitting.columns.end());
  return fitting;
}

std::vector<std::size_t> sorted(const Table& table, const TableRows& rows, const TableState& state) {
  std::vector<std::size_t> order = rows.shown;
  if (state.sort.empty()) return order;
  const std::size_t column = table.find(state.sort), n = table.columns.size();
  const auto number = [&](std::size_t row) { return rows.numbers[row * n + column]; };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t l, std::size_t r) {
    const double a = number(l), b = number(r);
    if (std::isnan(a) || std::isnan(b)) return !std::isnan(a);  // what has none comes last either way
    return state.descending ? a > b : a < b;
  });
  return order;
}

/// The text, or its beginning and end where it is too wide: names often differ in their last letters.
std::string elided(const std::string& text, float width) {
  if (ImGui::CalcTextSize(text.c_str()).x <= width) return text;
  for (std::size_t letters = text.size() - 1; letters > 3; --letters) {
    const std::size_t tail = (letters - 1) / 2;
    std::string shorter = text.substr(0, letters - 2 - tail) + ".." + text.substr(text.size() - tail);
    if (ImGui::CalcTextSize(shorter.c_str()).x <= width) return shorter;
  }
  return text.substr(0, 1);
}

/// Beside its head's word: at the other end of the cell it would stand behind the word of the column before.
void draw_arrow(bool down, float middle) {
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  const float half = 0.22f * ImGui::GetFontSize(), y = 0.5f * (low.y + high.y), tip = down ? half : -half;
  ImGui::GetWindowDrawList()->AddTriangleFilled({middle - half, y - 0.6f * tip}, {middle + half, y - 0.6f * tip},
                                                {middle, y + tip}, ImGui::GetColorU32(ImGuiCol_Text));
}

void text_at(float x, float y, const std::string& text, ImU32 ink) {
  ImGui::GetWindowDrawList()->AddText({x, y}, ink, text.c_str());
}

void draw_head(const TableColumn& column, bool by, bool down) {
  const ImVec2 at = ImGui::GetItemRectMin(), end = ImGui::GetItemRectMax();
  const std::string head(column.head);
  const float pad = 0.5f * ImGui::GetStyle().ItemSpacing.x, wide = ImGui::CalcTextSize(head.c_str()).x;
  const bool is_words = column.look == TableColumn::words;
  const float left = is_words ? at.x + pad : end.x - pad - wide, aside = 0.45f * ImGui::GetFontSize();
  text_at(left, at.y + ImGui::GetStyle().CellPadding.y, head, ImGui::GetColorU32(ImGuiCol_Text));
  if (by) draw_arrow(down, is_words ? left + wide + aside : left - aside);
}

void draw_cell(const TableColumn& column, double value) {
  if (std::isnan(value)) return;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float right = at.x + ImGui::GetContentRegionAvail().x;
  const ImU32 ink = ImGui::GetColorU32(ImGuiCol_Text);
  if (column.look == TableColumn::whole) {
    const std::string text = fmt::format("{:.0f}", value);
    return text_at(right - ImGui::CalcTextSize(text.c_str()).x, at.y, text, ink);
  }
  const NumberText text = number_text(value, column.unit);
  const float between = unit_gap(column), edge = right - unit_room(column) - between;
  text_at(edge - ImGui::CalcTextSize(text.digits.c_str()).x, at.y, text.digits, ink);
  text_at(edge + between, at.y, text.unit, ImGui::GetColorU32(ImGuiCol_TextDisabled));
}

/// Scrolls to the selected row where it is out of sight.
void seek_selected(CommandLines& lines, std::string_view panel, std::size_t place, float height) {
  const float top = static_cast<float>(place) * height, room = ImGui::GetWindowHeight() - height,
              now = ImGui::GetScrollY();
  if (top >= now && top + height <= now + room) return;
  lines.push_back(fmt::format("panel scroll {} {}", panel, std::round(std::max(0.0f, top - 0.4f * room))));
}

}  // namespace

std::size_t Table::find(std::string_view column) const {
  return static_cast<std::size_t>(
      std::find_if(columns.begin(), columns.end(), [&](const TableColumn& c) { return c.name == column; }) -
      columns.begin());
}

std::vector<const Table*> tables() { return {&contacts_table(), &bodies_table(), &groups_table(), &pairs_table()}; }

void draw_column_chooser(Ui& ui, const DebugModel& model, CommandLines& lines, std::string_view panel,
                         const Table& table) {
  const bool open = ImGui::BeginCombo("##columns", "columns", ImGuiComboFlags_HeightLarge);
  ui.name(fmt::format("{}/columns", panel));
  if (!open) return;
  const std::vector<std::size_t> on = chosen(table, state_of(model, table));
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    const TableColumn& column = table.columns[c];
    bool is_on = std::find(on.begin(), on.end(), c) != on.end();
    if (ImGui::Checkbox(std::string(column.name).c_str(), &is_on))
      lines.push_back(fmt::format("panel columns {} {}{}", table.name, is_on ? '+' : '-', column.name));
    ui.name(fmt::format("{}/columns:{}", panel, column.name));
    tooltip(std::string(column.doc));
  }
  close_on_escape(ui);
  ImGui::EndCombo();
}

namespace {

void draw_heads(Ui& ui, const TableState& state, CommandLines& lines, std::string_view panel, const Table& table,
                const std::vector<std::size_t>& columns, int icons) {
  ImGui::TableSetupScrollFreeze(0, 1);
  ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
  if (icons > 0) ImGui::TableNextColumn();
  for (const std::size_t c : columns) {
    const TableColumn& column = table.columns[c];
    ImGui::TableNextColumn();
    const bool by = state.sort == column.name;
    const std::string whose = &table == &contacts_table() ? "" : std::string(table.name) + " ";
    if (ImGui::Selectable(fmt::format("##head{}", c).c_str(), by))
      lines.push_back(fmt::format("panel sort {}{}{}", whose, column.name, by && !state.descending ? " down" : ""));
    ui.name(fmt::format("{}/sort:{}", panel, column.name));
    draw_head(column, by, state.descending);
    tooltip(std::string(column.doc));
  }
}

void draw_row(Ui& ui, CommandLines& lines, std::string_view panel, const Table& table, const TableRows& rows,
              const std::vector<std::size_t>& columns, std::size_t row, std::size_t place) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::PushID(static_cast<int>(row));
  const ImVec2 start = ImGui::GetCursorPos();
  ImGui::PushStyleColor(ImGuiCol_Text, rows.is_dim(row) ? dim() : ImGui::GetStyleColorVec4(ImGuiCol_Text));
  if (ImGui::Selectable("##row", rows.is_selected(row),
                        ImGuiSelectableFlags_SpanAllColumns | ImGuiSelectableFlags_AllowItemOverlap))
    lines.push_back(rows.select(row));
  ImGui::SetItemAllowOverlap();
  // it is as wide as the table, and so is where it can be clicked
  const ImVec2 low = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
  ImGui::PushClipRect(low, {low.x + size.x, low.y + size.y}, false);
  ui.name(fmt::format("{}/row:{}", panel, place));
  if (const std::string name = rows.name(row); !name.empty()) ui.name(fmt::format("{}/row:{}", panel, name));
  ImGui::PopClipRect();
  // icons have tips of their own
  if (rows.icons == 0 || ui.mouse_x() > low.x + start.x + static_cast<float>(rows.icons) * ImGui::GetTextLineHeight())
    tooltip(rows.tip(row));
  ImGui::SetCursorPos(start);
  if (rows.icons > 0) rows.draw_icons(row), ImGui::TableNextColumn();
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (k > 0) ImGui::TableNextColumn();
    const TableColumn& column = table.columns[columns[k]];
    if (column.look != TableColumn::words)
      draw_cell(column, rows.numbers[row * table.columns.size() + columns[k]]);
    else if (column.letters <= 2)
      rows.draw_mark(row, columns[k]);
    else
      ImGui::TextUnformatted(elided(rows.words(row, columns[k]), ImGui::GetContentRegionAvail().x).c_str());
  }
  ImGui::PopStyleColor();
  ImGui::PopID();
}

}  // namespace

std::vector<std::string> draw_table(Ui& ui, const DebugModel& model, CommandLines& lines, std::string_view panel,
                                    const Table& table, const TableRows& rows) {
  const TableState& state = state_of(model, table);
  const float cell = 4.0f * ui.unit(), line = ImGui::GetTextLineHeight();
  const float icons = static_cast<float>(rows.icons) * (line + 2.0f * ui.unit());
  const float room = ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ScrollbarSize - 2.0f * cell -
                     (rows.icons > 0 ? icons + cell : 0.0f);
  const Fitting fitting = fit(table, chosen(table, state), room, cell);
  const int n = static_cast<int>(fitting.columns.size()) + (rows.icons > 0 ? 1 : 0);
  ImGui::PushStyleVar(ImGuiStyleVar_CellPadding, ImVec2(2.0f * ui.unit(), 1.0f * ui.unit()));
  const bool open = n > 0 && ImGui::BeginTable("rows", n,
                                               ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_RowBg |
                                                   ImGuiTableFlags_PadOuterX | ImGuiTableFlags_ScrollY);
  ImGui::PopStyleVar();
  if (!open) return fitting.left_out;
  take_scroll(std::string(panel), ui, model, lines);
  if (rows.icons > 0) ImGui::TableSetupColumn("icons", ImGuiTableColumnFlags_WidthFixed, icons);
  for (const std::size_t c : fitting.columns) {
    const TableColumn& column = table.columns[c];
    const bool stretches = column.look == TableColumn::words && column.letters > 2;
    ImGui::TableSetupColumn("", stretches ? ImGuiTableColumnFlags_WidthStretch : ImGuiTableColumnFlags_WidthFixed,
                            stretches ? static_cast<float>(column.letters) : width_of(column));
  }
  draw_heads(ui, state, lines, panel, table, fitting.columns, rows.icons);
  const std::vector<std::size_t> order = sorted(table, rows, state);
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(order.size()));
  const std::string wanted = ui.wanted().starts_with(fmt::format("{}/", panel)) ? ui.wanted() : "";
  bool is_sought = model.state.is_selected_sought;
  for (std::size_t i = 0; i < order.size() && (is_sought || !wanted.empty()); ++i) {
    if (is_sought && rows.is_selected(order[i])) {
      seek_selected(lines, panel, i, line + 2.0f * ui.unit());
      is_sought = false;
    }
    if (wanted.empty()) continue;
    const std::string name = rows.name(order[i]);
    if (wanted.ends_with(fmt::format(":{}", i)) || (!name.empty() && wanted.ends_with(":" + name)))
      clipper.ForceDisplayRangeByIndices(static_cast<int>(i), static_cast<int>(i) + 1);
  }
  while (clipper.Step())
    for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i)
      draw_row(ui, lines, panel, table, rows, fitting.columns, order[static_cast<std::size_t>(i)],
               static_cast<std::size_t>(i));
  ImGui::EndTable();
  return fitting.left_out;
}

}  // namespace impinge
