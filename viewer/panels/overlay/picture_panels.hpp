// The panels drawn over a picture.
#pragma once

#include "viewer/layers/layer.hpp"
#include "viewer/panels/overlay/overlay.hpp"

namespace impinge {

/// Pixels of the picture that a panel covers; empty (width 0) if it was left out.
struct PanelArea {
  float x = 0.0f, y = 0.0f, width = 0.0f, height = 0.0f;
  bool is_folded = false;  ///< a heading in its place
};

/// The frame's figures at the top left: deterministic ones only, unless timings are asked for; in a small picture only
/// the most important ones. Draws nothing where the panel would cover more than half the picture's width or run over
/// its height.
PanelArea draw_figures(const Pen& pen, const StepRecord& record, const ViewSettings& settings);

/// What the marks in `list` mean, and those of what the scene has at any time, at the top right; left out where it would
/// meet `other`. `pixel_scale` is that of the marks, of which some are as large in it as in the picture. What is picked,
/// at `picked`, it leaves in sight: by another corner, or folded.
PanelArea draw_legend(const Pen& pen, const StepRecord& record, const DrawList& list, const ViewSettings& settings,
                      float pixel_scale, const PanelArea& other, const PanelArea& picked = {});

/// What the colours of heated surfaces mean, at the bottom right; left out with the legend, or where it would meet one
/// of `taken`. Small where it would cover more of the picture than the legend may.
PanelArea draw_color_bar(const Pen& pen, const ColorBar& bar, const ViewSettings& settings,
                         const std::vector<PanelArea>& taken);

/// The caption and the lines of the script, at the bottom; left out where it would meet one of `taken`.
PanelArea draw_caption(const Pen& pen, const ViewSettings& settings, const std::vector<PanelArea>& taken);

/// Whether a panel of that size covers more of the picture than the settings let a legend cover.
bool is_large(const Pen& pen, const PanelArea& area, const ViewSettings& settings);

/// Whether two panels share a pixel; those that were left out don't.
bool panels_meet(const PanelArea& a, const PanelArea& b);

/// Texts at points of the scene, each above its point; one that would meet a nearer one or a panel is left out.
void draw_labels(const Pen& pen, const std::vector<DrawLabel>& labels, const Camera& camera,
                 std::vector<PanelArea> taken);

}  // namespace impinge
