#include "viewer/draw/color_scale.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "viewer/draw/number_text.hpp"

namespace impinge {
namespace {

constexpr double kDecades = 4.0;  // of a logarithmic scale whose lower end is left open

}  // namespace

double ColorScale::place(double value) const {
  if (std::isnan(value)) return 0.0;
  if (form != ScaleForm::logarithmic) return std::clamp((value - low) / (high - low), 0.0, 1.0);
  if (value <= low) return 0.0;
  return std::min(1.0, std::log(value / low) / std::log(high / low));
}

float ColorBar::place(double value) {
  if (value < scale.low) below = true;
  if (value > scale.high) exceeded = true;
  return static_cast<float>(scale.place(value));
}

void ScaleSettings::declare(const Rows& rows, double most, const std::string& unit) {
  rows.add("scale", form,
           {{ScaleForm::automatic, "automatic"},
            {ScaleForm::linear, "linear"},
            {ScaleForm::logarithmic, "log"},
            {ScaleForm::diverging, "diverging"}},
           "How the colour bar goes: evenly from its lower to its upper end; by the logarithm; or from minus the upper "
           "end to it with a pale middle at zero. Automatic: diverging for what has a sign, else linear.");
  rows.add("min", min, {-most, most}, unit,
           "Lower end of the colour bar; diverging ones have none of their own. Logarithmic: 0 is a ten thousandth of "
           "the upper end.");
  rows.add("max", max, {0.0, most, true}, unit, "Upper end of the colour bar; 0 chooses by the frame.");
}

ColorScale ScaleSettings::scale(double largest, bool is_signed) const {
  ColorScale scale;
  scale.form = form != ScaleForm::automatic ? form : is_signed ? ScaleForm::diverging : ScaleForm::linear;
  scale.high = max > 0.0 ? max : rounded_up(largest);
  switch (scale.form) {
    case ScaleForm::diverging:
      scale.low = -scale.high;
      break;
    case ScaleForm::logarithmic:
      scale.low = min > 0.0 && min < scale.high ? min : scale.high * std::pow(10.0, -kDecades);
      break;
    default:
      scale.low = min;
      // an upper end that was left open, or stands below the lower one
      if (scale.low >= scale.high) scale.high = scale.low + rounded_up(std::max(std::abs(scale.low), largest));
  }
  return scale;
}

ColorBar make_color_bar(const std::string& title, const std::string& unit, const ColorScale& scale, ColorMap chosen) {
  const NumberText end = number_text(scale.high, unit);
  ColorBar bar;
  bar.title = title;
  bar.unit = end.unit;
  bar.scale = scale;
  bar.factor = std::pow(10.0, std::round(std::log10(std::stod(end.digits) / scale.high)));  // of the prefix alone
  bar.map = scale.form == ScaleForm::diverging ? ColorMap::balance : chosen;
  return bar;
}

double rounded_up(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double step : {1.0, 2.0, 5.0, 10.0})
    if (value <= step * power * (1.0 + 1e-12)) return step * power;
  return 10.0 * power;
}

std::string bar_text(const ColorBar& bar) {
  const auto shown = [&](double value) { return fmt::format("{:.4g}", bar.factor * value); };
  return fmt::format("{}, {}{} to {}{}{}{}{}", bar.title, bar.below ? "<" : "", shown(bar.scale.low),
                     bar.exceeded ? ">" : "", shown(bar.scale.high), bar.unit.empty() ? "" : " ", bar.unit,
                     bar.scale.form == ScaleForm::logarithmic ? ", logarithmic" : "");
}

}  // namespace impinge
