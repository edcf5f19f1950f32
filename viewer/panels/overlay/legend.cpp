#include <imgui.h>
#include <algorithm>
#include <optional>

#include "viewer/gl/packed_color.hpp"
#include "viewer/panels/overlay/picture_panels.hpp"

namespace impinge {
namespace {

constexpr Color kLegendInk = hex(0xd9dee6);
constexpr float kMark = 20.0f, kAfterMark = 9.0f;

/// Draws a mark as it looks in the picture, in a cell of kMark x kTextSize whose top left is (x, y).
void draw_mark(const Pen& pen, const LegendRow& row, float x, float y) {
  const float u = pen.unit, middle = y + 0.5f * pen.text_size, right = x + kMark * u;
  const ImU32 ink = opaque(row.color), dark = opaque(role::kOutline);
  ImDrawList& list = pen.list;
  switch (row.mark) {
    case LegendRow::area:
      list.AddRectFilled({x + 2.0f * u, middle - 5.5f * u}, {right - 2.0f * u, middle + 5.5f * u}, ink, 2.0f * u);
      break;
    case LegendRow::point:
      list.AddCircleFilled({x + 0.5f * kMark * u, middle}, 5.4f * u, dark, 24);
      list.AddCircleFilled({x + 0.5f * kMark * u, middle}, 4.2f * u, ink, 24);
      break;
    case LegendRow::ring:
      list.AddCircleFilled({x + 0.5f * kMark * u, middle}, 5.4f * u, dark, 24);
      list.AddCircleFilled({x + 0.5f * kMark * u, middle}, 4.2f * u, ink, 24);
      list.AddCircleFilled({x + 0.5f * kMark * u, middle}, 1.9f * u, dark, 24);
      break;
    case LegendRow::target:
      list.AddCircleFilled({x + 0.5f * kMark * u, middle}, 6.4f * u, dark, 24);
      list.AddCircleFilled({x + 0.5f * kMark * u, middle}, 5.2f * u, ink, 24);
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
      list.AddLine({x, middle}, {right - 6.0f * u, middle}, ink, 2.2f * u);
      list.AddTriangleFilled({right - 8.0f * u, middle - 4.0f * u}, {right - 8.0f * u, middle + 4.0f * u},
                             {right, middle}, ink);
      break;
  }
}

std::vector<LegendRow> legend_rows(const StepRecord& record, const DrawList& list, const ViewSettings& settings) {
  std::vector<LegendRow> rows;
  for (const Layer& layer : layers())
    if (settings.is_on(layer.name))
      std::copy_if(layer.legend.begin(), layer.legend.end(), std::back_inserter(rows), [&](const LegendRow& row) {
        const bool is_there = row.present == nullptr ? list.has_color(layer.name, row.color) : row.present(record);
        return is_there && (row.used == nullptr || row.used(settings));
      });
  return rows;
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

PanelArea draw_heading(const Pen& pen, const PanelArea& other, const PanelArea& picked, std::size_t marks) {
  const std::string text = "legend (" + std::to_string(marks) + ")";
  const float pad = pen.padding();
  PanelArea area{0.0f, 0.0f, pen.text_width(text) + 2.0f * pad, pen.text_size + 2.0f * pad, true};
  area = free_corner(pen, area, other, picked).value_or(in_corner(pen, area, 0));
  if (panels_meet(area, other)) return {};
  pen.sheet(area.x, area.y, area.width, area.height);
  pen.text(area.x + pad, area.y + pad, kLegendInk, text);
  return area;
}

}  // namespace

PanelArea draw_legend(const Pen& pen, const StepRecord& record, const DrawList& list, const ViewSettings& settings,
                      const PanelArea& other, const PanelArea& picked) {
  if (!settings.show_legend) return {};
  const std::vector<LegendRow> rows = legend_rows(record, list, settings);
  if (rows.empty()) return {};
  if (settings.legend_form == LegendForm::folded) return draw_heading(pen, other, picked, rows.size());
  const float mark = (kMark + (pen.is_small() ? 0.5f : 1.0f) * kAfterMark) * pen.unit, pad = pen.padding();
  float text = 0.0f;
  for (const LegendRow& row : rows) text = std::max(text, pen.text_width(row.text));
  PanelArea area;
  area.width = text + 2.0f * pad + mark;
  area.height = static_cast<float>(rows.size()) * pen.row() + 2.0f * pad - (pen.row() - pen.text_size);
  area = in_corner(pen, area, 0);
  const bool is_automatic = settings.legend_form == LegendForm::automatic;
  if (is_automatic && is_large(pen, area, settings)) return draw_heading(pen, other, picked, rows.size());
  const bool meets = other.width > 0.0f && area.x < other.x + other.width + pen.margin();
  if (meets || area.width > 0.5f * pen.picture_width || area.height + 2.0f * pen.margin() > pen.picture_height)
    return {};
  if (picked.width > 0.0f) {
    const std::optional<PanelArea> free = free_corner(pen, area, other, picked);
    if (!free && is_automatic) return draw_heading(pen, other, picked, rows.size());
    area = free.value_or(area);
  }
  pen.sheet(area.x, area.y, area.width, area.height);
  float y = area.y + pad;
  for (const LegendRow& row : rows) {
    draw_mark(pen, row, area.x + pad, y);
    pen.text(area.x + pad + mark, y, kLegendInk, row.text);
    y += pen.row();
  }
  return area;
}

bool is_large(const Pen& pen, const PanelArea& area, const ViewSettings& settings) {
  return area.width * area.height > static_cast<float>(settings.most_legend) * pen.picture_width * pen.picture_height;
}

}  // namespace impinge
