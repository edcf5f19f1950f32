#include <fmt/format.h>
#include <imgui.h>
#include <algorithm>
#include <cmath>

#include "viewer/draw/color_map.hpp"
#include "viewer/gl/packed_color.hpp"
#include "viewer/panels/overlay/picture_panels.hpp"

namespace impinge {
namespace {

constexpr Color kBarInk = hex(0xf2f4f7), kTitle = hex(0xd9dee6);
constexpr float kWidth = 220.0f, kHeight = 12.0f, kTick = 4.0f;  // of the bar, in text pixels
constexpr float kShort = 60.0f, kGap = 5.0f;                     // of a folded one, and what is beside it

struct BarTexts {
  std::string title, low, middle, high;
};

BarTexts texts_of(const ColorBar& bar) {
  const ColorScale& scale = bar.scale;
  const bool by_logarithm = scale.form == ScaleForm::logarithmic;
  const auto shown = [&](double value) { return fmt::format("{:.4g}", bar.factor * value); };
  return {
      fmt::format("{}{}{}{}", bar.title, bar.unit.empty() ? "" : ", ", bar.unit, by_logarithm ? " (logarithmic)" : ""),
      (bar.below ? "<" : "") + shown(scale.low),
      shown(by_logarithm ? std::sqrt(scale.low * scale.high) : 0.5 * (scale.low + scale.high)),
      (bar.exceeded ? ">" : "") + shown(scale.high)};
}

/// At the bottom right, above other bars; none where there is no room.
PanelArea placed(const Pen& pen, PanelArea area, const std::vector<PanelArea>& taken) {
  area.x = pen.picture_width - pen.margin() - area.width;
  area.y = pen.picture_height - pen.margin() - area.height;
  for (const PanelArea& t : taken)
    if (panels_meet(t, area)) area.y = std::min(area.y, t.y - pen.margin() - area.height);
  const bool meets = std::any_of(taken.begin(), taken.end(), [&](const PanelArea& t) { return panels_meet(t, area); });
  return meets || area.width > 0.6f * pen.picture_width || area.y < 0.0f ? PanelArea{} : area;
}

void draw_colors(const Pen& pen, const ColorBar& bar, float left, float top, float width, float bottom) {
  const auto& colors = heat_colors(bar.map);
  for (std::size_t k = 0; k + 1 < colors.size(); ++k) {
    const float from = left + width * static_cast<float>(k) / (kHeatColors - 1),
                to = left + width * static_cast<float>(k + 1) / (kHeatColors - 1);
    const ImU32 a = opaque(colors[k]), b = opaque(colors[k + 1]);
    pen.list.AddRectFilledMultiColor({from, top}, {to, bottom}, a, b, b, a);
  }
}

/// The title, and below it the ends of the range on either side of a short bar.
PanelArea draw_folded(const Pen& pen, const ColorBar& bar, const BarTexts& texts, const std::vector<PanelArea>& taken) {
  const float u = pen.unit, pad = pen.padding(), gap = kGap * u, low = pen.text_width(texts.low),
              high = pen.text_width(texts.high);
  PanelArea area{0.0f, 0.0f, std::max(pen.text_width(texts.title), low + high + 2.0f * gap + kShort * u) + 2.0f * pad,
                 2.0f * pen.text_size + 2.0f * pad, true};
  area = placed(pen, area, taken);
  if (area.width <= 0.0f) return {};
  pen.sheet(area.x, area.y, area.width, area.height);
  const float left = area.x + pad, right = area.x + area.width - pad, y = area.y + pad + pen.text_size;
  pen.text(left, area.y + pad, kTitle, texts.title);
  pen.text(left, y, kBarInk, texts.low);
  pen.text(right - high, y, kBarInk, texts.high);
  const float from = left + low + gap, middle = y + 0.5f * pen.text_size;
  draw_colors(pen, bar, from, middle - 0.3f * kHeight * u, right - high - gap - from, middle + 0.4f * kHeight * u);
  return area;
}

}  // namespace

PanelArea draw_color_bar(const Pen& pen, const ColorBar& bar, const ViewSettings& settings,
                         const std::vector<PanelArea>& taken) {
  if (!settings.show_legend) return {};
  const float u = pen.unit, pad = pen.padding(), width = (pen.is_small() ? 0.7f : 1.0f) * kWidth * u;
  const ColorScale& scale = bar.scale;
  const BarTexts texts = texts_of(bar);
  PanelArea area;
  const float beside = 0.5f * pen.text_width(texts.high);  // the last number stands under the bar's end
  area.width = std::max(pen.text_width(texts.title), width + beside) + 2.0f * pad;
  area.height = 2.0f * pen.text_size + (kHeight + kTick + 5.0f) * u + 2.0f * pad;
  if (settings.legend_form != LegendForm::whole && is_large(pen, area, settings))
    return draw_folded(pen, bar, texts, taken);
  area = placed(pen, area, taken);
  if (area.width <= 0.0f) return {};
  pen.sheet(area.x, area.y, area.width, area.height);
  pen.text(area.x + pad, area.y + pad, kTitle, texts.title);
  const float left = area.x + pad, top = area.y + pad + pen.text_size + 3.0f * u, bottom = top + kHeight * u;
  draw_colors(pen, bar, left, top, width, bottom);
  const auto number = [&](float share, const std::string& text) {
    const float x = left + share * width, half = 0.5f * pen.text_width(text);
    pen.list.AddLine({x, bottom}, {x, bottom + kTick * u}, opaque(kBarInk), u);
    pen.text(std::max(left, x - half), bottom + (kTick + 1.0f) * u, kBarInk, text);
  };
  if (scale.form == ScaleForm::logarithmic)  // a mark for each power of ten
    for (double v = std::pow(10.0, std::ceil(std::log10(scale.low))); v < scale.high; v *= 10.0) {
      const float x = left + static_cast<float>(scale.place(v)) * width;
      pen.list.AddLine({x, bottom}, {x, bottom + 0.6f * kTick * u}, opaque(kTitle), u);
    }
  number(0.0f, texts.low);
  number(0.5f, texts.middle);
  number(1.0f, texts.high);
  return area;
}

}  // namespace impinge
