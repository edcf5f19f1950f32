#include "viewer/layers/quantity_arrow.hpp"

#include <algorithm>

namespace impinge {
namespace {

constexpr double kShortest = 0.5;    // pixels
constexpr float kHeadBehind = 2.8f;  // widths of the shaft: the second head, most of a head behind the first

}  // namespace

void add_quantity_arrow(const ViewSettings& settings, DrawArrow arrow, double share, DrawList& list) {
  const double length = settings.arrow_length * std::min(share, settings.arrow_most);
  if (!(length >= kShortest)) return;
  arrow.length_px = static_cast<float>(length);
  arrow.is_cut = share > settings.arrow_most;
  list.arrows.push_back(arrow);
  arrow.length_px -= kHeadBehind * arrow.width;
  if (arrow.is_cut && arrow.length_px > 0.0f) list.arrows.push_back(arrow);
}

void add_arrow_scale(const LayerContext& context, Color color, double unit_value, const char* unit, DrawList& list) {
  list.scales.push_back({context.layer, color, unit_value, unit, static_cast<float>(context.settings.arrow_length),
                         context.settings.arrow_most * unit_value});
}

}  // namespace impinge
