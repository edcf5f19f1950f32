#include <imgui.h>
#include <algorithm>

#include "viewer/panels/panels.hpp"

namespace impinge {
namespace {

constexpr Color kInk = hex(0xd9dee6);
constexpr float kMargin = 10.0f, kPadding = 9.0f, kRow = 16.0f, kMark = 20.0f, kAfterMark = 9.0f;

ImU32 packed(Color c) { return ImGui::ColorConvertFloat4ToU32({c.r, c.g, c.b, 1.0f}); }

/// Draws a mark as it looks in the picture, in a cell of kMark x 13 whose top left is (x, y).
void draw_mark(const Pen& pen, const LegendRow& row, float x, float y) {
  const float u = pen.unit, middle = y + 6.5f * u, right = x + kMark * u;
  const ImU32 ink = packed(row.color), dark = packed(role::kOutline);
  ImDrawList& list = pen.list;
  switch (row.mark) {
    case LegendRow::area:
      list.AddRectFilled({x + 2.0f * u, y + 1.0f * u}, {right - 2.0f * u, y + 12.0f * u}, ink, 2.0f * u);
      break;
    case LegendRow::point:
      list.AddCircleFilled({x + 0.5f * kMark * u, middle}, 5.4f * u, dark, 24);
      list.AddCircleFilled({x + 0.5f * kMark * u, middle}, 4.2f * u, ink, 24);
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

}  // namespace

PanelArea draw_legend(const Pen& pen, const ViewSettings& settings, const PanelArea& other) {
  if (!settings.show_legend) return {};
  std::vector<LegendRow> rows;
  for (const Layer& layer : layers())
    if (settings.is_on(layer.name)) rows.insert(rows.end(), layer.legend.begin(), layer.legend.end());
  if (rows.empty()) return {};
  const float u = pen.unit;
  float text = 0.0f;
  for (const LegendRow& row : rows) text = std::max(text, pen.text_width(row.text));
  PanelArea area;
  area.width = text + (2.0f * kPadding + kMark + kAfterMark) * u;
  area.height = (static_cast<float>(rows.size()) * kRow + 2.0f * kPadding - (kRow - 13.0f)) * u;
  area.x = pen.picture_width - kMargin * u - area.width;
  area.y = kMargin * u;
  const bool meets = other.width > 0.0f && area.x < other.x + other.width + kMargin * u;
  if (meets || area.width > 0.5f * pen.picture_width || area.height + 2.0f * kMargin * u > pen.picture_height)
    return {};
  pen.sheet(area.x, area.y, area.width, area.height);
  float y = area.y + kPadding * u;
  for (const LegendRow& row : rows) {
    draw_mark(pen, row, area.x + kPadding * u, y);
    pen.text(area.x + (kPadding + kMark + kAfterMark) * u, y, kInk, row.text);
    y += kRow * u;
  }
  return area;
}

}  // namespace impinge
