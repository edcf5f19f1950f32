#include "viewer/panels/debug/layout.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/error.hpp"

namespace impinge {

namespace {

float whole(float v) { return std::round(v); }

/// What the panels of a place get of its length, in their order; `gap` lies between them.
std::vector<float> extents(PanelPlace place, float length, float gap, float unit) {
  std::vector<float> all;
  float rest = length + gap;
  int takers = 0;  // of what the others leave
  for (const Panel& panel : panels()) {
    if (panel.place != place || !panel.shares.empty()) continue;
    const auto [share, most] = panel.room;
    all.push_back(share == 0.0f ? 0.0f : whole(most == 0.0f ? share * length : std::min(share * length, most * unit)));
    takers += share == 0.0f;
    rest -= all.back() + gap;
  }
  auto extent = all.begin();
  for (const Panel& panel : panels()) {
    if (panel.place != place || !panel.shares.empty()) continue;
    if (panel.room.share == 0.0f) {
      *extent = takers == 1 ? rest : whole(rest / static_cast<float>(takers));
      rest -= *extent, --takers;
    }
    ++extent;
  }
  return all;
}

}  // namespace

int debug_scale(int height) { return std::max(1, height / 1000); }

const UiArea& DebugLayout::area(std::string_view panel) const {
  for (std::size_t i = 0; i < panels.size(); ++i)
    if (impinge::panels()[i].name == panel) return panels[i];
  throw InternalError("no panel is named '" + std::string(panel) + "'");
}

DebugLayout debug_layout(int width, int height, float unit) {
  const float w = static_cast<float>(width), h = static_cast<float>(height), gap = std::max(1.0f, unit);
  const float side = whole(std::clamp(0.225f * w, 200.0f * unit, 330.0f * unit)),
              below = whole(std::clamp(0.24f * h, 150.0f * unit, 280.0f * unit));
  const float right = whole(std::clamp(0.265f * w, 230.0f * unit, 400.0f * unit));  // the contact table wants it
  const float top = h - below - gap;
  float bars = top + gap;  // where the next bar begins, and after the last one what lies below
  for (const Panel& panel : panels())
    if (panel.place == PanelPlace::bar && panel.shares.empty()) bars += panel.room.most * unit + gap;

  DebugLayout layout;
  layout.view = {side + gap, 0, w - side - right - 2 * gap, top};
  const std::vector<float> lefts = extents(PanelPlace::left, top, gap, unit),
                           rights = extents(PanelPlace::right, top, gap, unit),
                           widths = extents(PanelPlace::below, w, gap, unit);
  std::size_t l = 0, r = 0, b = 0;
  float left_y = 0.0f, right_y = 0.0f, bar_y = top + gap, x = 0.0f;
  for (const Panel& panel : panels()) {
    if (!panel.shares.empty()) {
      layout.panels.push_back(layout.area(panel.shares));
      continue;
    }
    switch (panel.place) {
      case PanelPlace::left:
        layout.panels.push_back({0, left_y, side, lefts[l]});
        left_y += lefts[l++] + gap;
        break;
      case PanelPlace::right:
        layout.panels.push_back({w - right, right_y, right, rights[r]});
        right_y += rights[r++] + gap;
        break;
      case PanelPlace::bar:
        layout.panels.push_back({0, bar_y, w, panel.room.most * unit});
        bar_y += panel.room.most * unit + gap;
        break;
      case PanelPlace::below:
        layout.panels.push_back({x, bars, widths[b], h - bars});
        x += widths[b++] + gap;
    }
  }
  return layout;
}

}  // namespace impinge
