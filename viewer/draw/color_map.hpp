// The colours of quantities: from dark violet over teal to bright yellow, in equal steps of perceived difference.
// Lightness grows all the way, so that the order is seen by colour-blind eyes and in grey prints too.
#pragma once

#include <array>

#include "viewer/draw/palette.hpp"

namespace impinge {

inline constexpr int kHeatColors = 33;

/// Evenly spaced over 0..1; between them sRGB values are interpolated.
const std::array<Color, kHeatColors>& heat_colors();
/// t below 0 or above 1 is taken for 0 or 1.
Color heat_color(double t);

}  // namespace impinge
