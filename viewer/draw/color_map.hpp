// The colours of quantities, in equal steps of perceived difference. Lightness grows all the way (of `balance` from both
// ends to the middle), so that the order is seen by colour-blind eyes and in grey prints too.
#pragma once

#include <array>

#include "viewer/draw/palette.hpp"

namespace impinge {

/// dusk: dark violet over teal to bright yellow. fire: black red over orange to pale yellow. gray. balance: from blue
/// over nearly white to rust, for what has a sign.
enum class ColorMap { dusk, fire, gray, balance };

inline constexpr int kHeatColors = 33;

/// Evenly spaced over 0..1; between them sRGB values are interpolated.
const std::array<Color, kHeatColors>& heat_colors(ColorMap map = ColorMap::dusk);
/// t below 0 or above 1 is taken for 0 or 1.
Color heat_color(double t, ColorMap map = ColorMap::dusk);

}  // namespace impinge
