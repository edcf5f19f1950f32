// Arrows that are as long as what they stand for, and what a legend says of that.
#pragma once

#include "viewer/layers/layer.hpp"

namespace impinge {

/// Adds the arrow of `share` units: view.arrow_length long for one, view.arrow_most times that at most, and then with two
/// heads. Less than half a pixel is left out.
void add_quantity_arrow(const ViewSettings& settings, DrawArrow arrow, double share, DrawList& list);

/// Tells the legend what such an arrow of one unit stands for.
void add_arrow_scale(const LayerContext& context, Color color, double unit_value, const char* unit, DrawList& list);

}  // namespace impinge
