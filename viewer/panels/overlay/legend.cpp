#include <imgui.h>
#include <algorithm>
#include <optional>

#include "viewer/gl/packed_color.hpp"
#include "viewer/panels/overlay/legend_rows.hpp"
#include "viewer/panels/overlay/picture_panels.hpp"

namespace impinge {
namespace {

constexpr Color kLegendInk = hex(0xd9dee6);
constexpr float kMark = 20.0f, kAfterMark = 9.0f;             // in text pixels
constexpr float kLeastSize = 6.0f, kMostSize = 3.0f * kMark;  // of marks that are as large as in the picture

/// A disc of that radius with its rim.
void add_disc(const Pen& pen, const ImVec2& at, float radius, ImU32 ink) {
  pen.list.AddCircleFilled(at, radius + 1.2f * pen.unit, opaque(role::kOutline), 24);
  pen.list.AddCircleFilled(at, radius, ink, 24);
}

void add_arrow(const Pen& pen, float left, float right, float middle, bool is_cut, ImU32 ink) {
  const float u = pen.unit;
  pen.list.AddLine({left, middle}, {std::max(left, right - 6.0f * u), middle}, ink, 2.2f * u);
  for (const float tip : {right - 6.0f * u, right})
    if (is_cut || tip == right)
      pen.list.AddTriangleFilled({tip - 8.0f * u, middle - 4.0f * u}, {tip - 8.0f * u, middle + 4.0f * u},
                                 {tip, middle}, ink);
}

/// Draws a mark as it looks in the picture, in a cell of width x kTextSize whose top left is (x, y).
void draw_mark(const Pen& pen, const ShownRow& row, float x, float y, float width) {
  const float u = pen.unit, middle = y + 0.5f * pen.text_size;
  x += 0.5f * (width - std::max(kMark * u, row.mark == LegendRow::arrow ? row.size : 0.0f));
  const float right = x + kMark * u;
  const ImU32 ink = opaque(row.color), dark = opaque(role::kOutline);
  ImDrawList& list = pen.list;
  switch (row.mark) {
    case LegendRow::area:
      list.AddRectFilled({x + 2.0f * u, middle - 5.5f * u}, {right - 2.0f * u, middle + 5.5f * u}, ink, 2.0f * u);
      break;
    case LegendRow::point:
      add_disc(pen, {x + 0.5f * kMark * u, middle}, 4.2f * u, ink);
      break;
    case LegendRow::disc:
      add_disc(pen, {x + 0.5f * kMark * u, middle}, 0.5f * row.size, ink);
      break;
    case LegendRow::ring:
      add_disc(pen, {x + 0.5f * kMark * u, middle}, 4.2f * u, ink);
      list.AddCircleFilled({x + 0.5f * kMark * u, middle}, 1.9f * u, dark, 24);
      break;
    case LegendRow::target:
      add_disc(pen, {x + 0.5f * kMark * u, middle}, 5.2f * u, ink);
      list.AddCircleFilled({x + 0.5f * kMark * u, middle}, 3.4f * u, dark, 24);
      list.AddCircleFilled({x + 0.5f * kMark * u, middle}, 1.6f * u, ink, 24);
      break;
    case LegendRow::bar:
      list.AddLine({x + 2.0f * u, middle}, {right - 2.0f * u, middle}, dark, 4.4f * u);
      list.AddLine({x + 3.0f * u, middle}, {right - 3.0f * u, middle}, ink, 2.6f * u);
      break;
    case LegendRow::line:
      list.AddLine({x, middle}, {right, middle}, ink, 1.6f * u);
      break;
    case LegendRow::arrow:
      add_arrow(pen, x, row.size > 0.0f ? x + row.size : right, middle, row.is_cut, ink);
      break;
  }
}

/// Its corner, from the one at the top right clockwise.
PanelArea in_corner(const Pen& pen, PanelArea area, int corner) {
  area.x = corner == 0 || corner == 1 ? pen.picture_width - pen.margin() - area.width : pen.margin();
  area.y = corner == 0 || corner == 3 ? pen.margin() : pen.picture_height - pen.margin() - area.height;
  return area;
}

/// The first corner in which it hides nothing that is picked; none if all would.
std::optional<PanelArea> free_corner(const Pen& pen, const PanelArea& area, const PanelArea& other,
                                     const PanelArea& picked) {
  for (int corner = 0; corner < 4; ++corner)
    if (const PanelArea at = in_corner(pen, area, corner); !panels_meet(at, picked) && !panels_meet(at, other))
      return at;
  return std::nullopt;
}

float text_width_of(const Pen& pen, const std::vector<ShownRow>& rows) {
  float width = 0.0f;
  for (const ShownRow& row : rows) width = std::max(width, pen.text_width(row.text));
  return width;
}

/// Of the cells of the marks.
float mark_width(const Pen& pen, const std::vector<ShownRow>& rows) {
  float width = kMark * pen.unit;
  for (const ShownRow& row : rows)
    if (row.mark == LegendRow::arrow) width = std::max(width, row.size);
  return width;
}

/// Where the rows begin behind their marks, from the panel's edge.
float text_begin(const Pen& pen, const std::vector<ShownRow>& rows) {
  return pen.padding() + mark_width(pen, rows) + (pen.is_small() ? 0.5f : 1.0f) * kAfterMark * pen.unit;
}

void draw_rows(const Pen& pen, const PanelArea& area, float top, const std::vector<ShownRow>& rows) {
  const float text = area.x + text_begin(pen, rows), width = mark_width(pen, rows);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const float y = top + static_cast<float>(i) * pen.row();
    draw_mark(pen, rows[i], area.x + pen.padding(), y, width);
    pen.text(text, y, kLegendInk, rows[i].text);
  }
}

/// The folded legend: how many rows it has, and those without which sizes in the picture can't be read.
PanelArea draw_heading(const Pen& pen, const PanelArea& other, const PanelArea& picked,
                       const std::vector<ShownRow>& all) {
  const std::string text = "legend (" + std::to_string(all.size()) + ")";
  std::vector<ShownRow> rows;
  for (const ShownRow& row : all)
    if (!row.quantity.empty()) rows.push_back(row), rows.back().text = row.quantity;
  const float pad = pen.padding();
  const float wide = rows.empty() ? 0.0f : text_begin(pen, rows) - pad + text_width_of(pen, rows);
  PanelArea area{0.0f, 0.0f, std::max(pen.text_width(text), wide) + 2.0f * pad,
                 pen.text_size + 2.0f * pad + static_cast<float>(rows.size()) * pen.row(), true};
  area = free_corner(pen, area, other, picked).value_or(in_corner(pen, area, 0));
  if (panels_meet(area, other)) return {};
  pen.sheet(area.x, area.y, area.width, area.height);
  pen.text(area.x + pad, area.y + pad, kLegendInk, text);
  draw_rows(pen, area, area.y + pad + pen.row(), rows);
  return area;
}

}  // namespace

PanelArea draw_legend(const Pen& pen, const StepRecord& record, const DrawList& list, const ViewSettings& settings,
                      float pixel_scale, const PanelArea& other, const PanelArea& picked) {
  if (!settings.show_legend) return {};
  const std::vector<ShownRow> rows =
      legend_rows(record, list, settings, pixel_scale, kLeastSize * pen.unit, kMostSize * pen.unit);
  if (rows.empty()) return {};
  if (settings.legend_form == LegendForm::folded) return draw_heading(pen, other, picked, rows);
  const float pad = pen.padding();
  PanelArea area;
  area.width = text_begin(pen, rows) + text_width_of(pen, rows) + pad;
  area.height = static_cast<float>(rows.size()) * pen.row() + 2.0f * pad - (pen.row() - pen.text_size);
  area = in_corner(pen, area, 0);
  const bool is_automatic = settings.legend_form == LegendForm::automatic;
  if (is_automatic && is_large(pen, area, settings)) return draw_heading(pen, other, picked, rows);
  const bool meets = other.width > 0.0f && area.x < other.x + other.width + pen.margin();
  if (meets || area.width > 0.5f * pen.picture_width || area.height + 2.0f * pen.margin() > pen.picture_height)
    return {};
  if (picked.width > 0.0f) {
    const std::optional<PanelArea> free = free_corner(pen, area, other, picked);
    if (!free && is_automatic) return draw_heading(pen, other, picked, rows);
    area = free.value_or(area);
  }
  pen.sheet(area.x, area.y, area.width, area.height);
  draw_rows(pen, area, area.y + pad, rows);
  return area;
}

bool is_large(const Pen& pen, const PanelArea& area, const ViewSettings& settings) {
  return area.width * area.height > static_cast<float>(settings.most_legend) * pen.picture_width * pen.picture_height;
}

}  // namespace impinge
