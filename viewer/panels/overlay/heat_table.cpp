#include "viewer/panels/overlay/heat_table.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "viewer/draw/color_scale.hpp"
#include "viewer/gl/packed_color.hpp"

namespace impinge {
namespace {

constexpr Color kTableInk = hex(0x20242a), kTablePaper = hex(0xffffff), kNoValue = hex(0xe9ecef), kLine = hex(0xb9c0c8),
                kWhite = hex(0xffffff);
constexpr double kWide = 20.0;  // from this ratio on, colours go by the logarithm

Color ink_on(Color c) {
  return 0.2126f * std::pow(c.r, 2.2f) + 0.7152f * std::pow(c.g, 2.2f) + 0.0722f * std::pow(c.b, 2.2f) > 0.2f
             ? kTableInk
             : kWhite;
}

/// Colours from the least to the largest value; none where there is no number.
std::optional<ColorScale> scale_of(const std::vector<double>& values) {
  double low = 1e300, high = -1e300, least = 1e300;
  for (const double v : values) {
    if (!std::isfinite(v)) continue;
    low = std::min(low, v), high = std::max(high, v);
    if (v > 0.0) least = std::min(least, v);
  }
  if (low > high) return std::nullopt;
  if (low >= 0.0 && least < 1e300 && high > kWide * least) return ColorScale{ScaleForm::logarithmic, least, high};
  return ColorScale{ScaleForm::linear, low, high};
}

Color color_of(const ColorScale& scale, double v) { return heat_color(scale.high > scale.low ? scale.place(v) : 0.5); }

std::string shortened(const Pen& pen, std::string text, float width) {
  if (pen.text_width(text) <= width) return text;
  while (text.size() > 1 && pen.text_width(text + "..") > width) text.pop_back();
  return text + "..";
}

void draw_bar(const Pen& pen, const HeatTable& table, const ColorScale& scale, float x, float y, float width) {
  const float height = 0.9f * pen.text_size;
  constexpr int kSteps = 96;
  for (int k = 0; k < kSteps; ++k)
    pen.list.AddRectFilled({x + width * static_cast<float>(k) / kSteps, y},
                           {x + width * static_cast<float>(k + 1) / kSteps, y + height},
                           packed(heat_color((k + 0.5) / kSteps)));
  const std::string low = fmt::format("{:.3g}", scale.low), high = fmt::format("{:.3g}", scale.high);
  pen.text(x - pen.text_width(low) - 8.0f * pen.unit, y, kTableInk, low);
  pen.text(
      x + width + 8.0f * pen.unit, y, kTableInk,
      fmt::format("{}   {}{}", high, table.value_label, scale.form == ScaleForm::logarithmic ? ", logarithmic" : ""));
}

struct TableCell {
  float x, y, width, height;
};

/// On any colour: a white one is below it.
void draw_cross(const Pen& pen, float x, float y) {
  pen.cross(x, y, 5.0f * pen.unit, 5.0f * pen.unit, kWhite);
  pen.cross(x, y, 5.0f * pen.unit, 2.0f * pen.unit);
}

void draw_cell(const Pen& pen, const HeatTable& table, std::size_t cell, const std::optional<ColorScale>& scale,
               const TableCell& box) {
  const auto& [x, y, width, height] = box;
  const float u = pen.unit;
  const bool has_value = std::isfinite(table.values[cell]);
  const Color color = has_value ? color_of(*scale, table.values[cell]) : kNoValue;
  pen.list.AddRectFilled({x + u, y + u}, {x + width - u, y + height - u}, packed(color));
  if (!has_value) pen.list.AddRect({x + u, y + u}, {x + width - u, y + height - u}, packed(kLine), 0.0f, 0, u);
  const std::string note = table.notes[cell].empty() ? "" : " " + table.notes[cell];
  const std::string text = shortened(pen,
                                     has_value      ? fmt::format("{:.3g}{}", table.values[cell], note)
                                     : note.empty() ? "no figure"
                                                    : table.notes[cell],
                                     width - 4.0f * u);
  pen.text(x + 0.5f * (width - pen.text_width(text)), y + 0.5f * (height - pen.text_size),
           has_value ? ink_on(color) : kTableInk, text);
  if (cell < table.doubtful.size() && table.doubtful[cell]) draw_cross(pen, x + width - 12.0f * u, y + 12.0f * u);
}

}  // namespace

void draw_heat_table(const Pen& pen, const HeatTable& table) {
  const float u = pen.unit, line = 1.5f * pen.text_size, margin = 18.0f * u;
  pen.list.AddRectFilled({0, 0}, {pen.picture_width, pen.picture_height}, packed(kTablePaper));
  pen.text(margin, margin, kTableInk,
           shortened(pen, fmt::format("{}: {}", table.title, table.value_label), pen.picture_width - 2.0f * margin));
  float heads = pen.text_width(table.row_label);
  for (const std::string& row : table.rows) heads = std::max(heads, pen.text_width(row));
  heads = std::min(heads, 0.34f * pen.picture_width);
  const bool has_doubts = std::find(table.doubtful.begin(), table.doubtful.end(), true) != table.doubtful.end();
  const float left = margin + heads + 12.0f * u, top = margin + 4.2f * line, right = pen.picture_width - margin,
              bottom = pen.picture_height - margin - (has_doubts ? 3.2f : 2.0f) * line;
  const float width = std::min((right - left) / static_cast<float>(table.columns.size()), 300.0f * u),
              height = std::min((bottom - top) / static_cast<float>(table.rows.size()), 120.0f * u);
  pen.text(left, margin + 1.9f * line, kTableInk, table.column_label);
  pen.text(margin, margin + 3.0f * line, kTableInk, shortened(pen, table.row_label, heads));
  const std::optional<ColorScale> scale = scale_of(table.values);
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    const std::string head = shortened(pen, table.columns[c], width - 4.0f * u);
    pen.text(left + (static_cast<float>(c) + 0.5f) * width - 0.5f * pen.text_width(head), margin + 3.0f * line,
             kTableInk, head);
  }
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    const float y = top + static_cast<float>(r) * height;
    pen.text(margin, y + 0.5f * (height - pen.text_size), kTableInk, shortened(pen, table.rows[r], heads));
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      const std::size_t cell = r * table.columns.size() + c;
      draw_cell(pen, table, cell, scale, {left + static_cast<float>(c) * width, y, width, height});
    }
  }
  if (scale)
    draw_bar(pen, table, *scale, left + 60.0f * u, top + static_cast<float>(table.rows.size()) * height + 0.8f * line,
             240.0f * u);
  if (!has_doubts) return;
  const float below = top + static_cast<float>(table.rows.size()) * height + (scale ? 2.0f : 0.8f) * line;
  draw_cross(pen, left + 60.0f * u, below + 0.5f * pen.text_size);
  pen.text(left + 74.0f * u, below, kTableInk, "crossed: in doubt");
}

}  // namespace impinge
