// How values become colours: from which to which, evenly, by the logarithm, or from a middle at zero both ways; and the
// bar that tells so.
#pragma once

#include <string>

#include "engine/core/rows.hpp"
#include "viewer/draw/color_map.hpp"

namespace impinge {

enum class ScaleForm { automatic, linear, logarithmic, diverging };

struct ColorScale {
  ScaleForm form = ScaleForm::linear;  ///< not automatic
  double low = 0.0, high = 1.0;        ///< low < high; logarithmic: both > 0

  /// From 0 at `low` to 1 at `high`; beyond them, and for what is no number, their places.
  double place(double value) const;
};

/// What the colours mean: `scale` in SI units, numbers on it times `factor` in `unit`.
struct ColorBar {
  std::string title, unit;
  ColorScale scale;
  double factor = 1.0;
  ColorMap map = ColorMap::dusk;
  bool below = false, exceeded = false;  ///< whether something in the picture lies beyond an end

  /// The colour's place, and whether one of the ends was passed.
  float place(double value);
};

/// Of a layer: the rows by which its colours are chosen.
struct ScaleSettings {
  ScaleForm form = ScaleForm::automatic;
  double min = 0.0, max = 0.0;

  /// `most` is the largest upper end, `unit` that of the ends.
  void declare(const Rows& rows, double most, const std::string& unit);
  /// `largest`: of the frame's magnitudes, at which the bar ends where the rows leave that open, rounded up.
  ColorScale scale(double largest, bool is_signed) const;
};

/// With numbers in the prefix that the upper end has few figures in; a scale that diverges has colours of its own.
ColorBar make_color_bar(const std::string& title, const std::string& unit, const ColorScale& scale, ColorMap chosen);

/// The bar in words: "von Mises stress, 0 to >200 kPa".
std::string bar_text(const ColorBar& bar);

/// The least of 1, 2 and 5 times a power of ten that is not below a positive value.
double rounded_up(double value);

}  // namespace impinge
