#include "viewer/draw/color_map.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/core/types.hpp"

namespace impinge {
namespace {

/// A way through OKLab: lightness and hue go evenly, chroma as far as both the map and screens allow.
struct Way {
  double first_lightness, last_lightness;
  double first_hue, last_hue;  ///< degrees
  double first_chroma, last_chroma;
};
constexpr Way kDusk = {0.34, 0.93, 295.0, 105.0, 0.12, 0.12};  // violet, blue, teal, green, yellow
constexpr Way kFire = {0.20, 0.96, 15.0, 105.0, 0.20, 0.12};
constexpr Way kGray = {0.24, 0.97, 0.0, 0.0, 0.0, 0.0};
constexpr Way kBlue = {0.42, 0.96, 258.0, 240.0, 0.16, 0.0}, kRust = {0.42, 0.96, 38.0, 60.0, 0.16, 0.0};
constexpr double kShareOfGamut = 0.94;

double to_srgb(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

/// Linear sRGB of an OKLab colour [Ottosson20].
Vec3 linear_rgb(const Vec3& lab) {
  const double l = lab[0] + 0.3963377774 * lab[1] + 0.2158037573 * lab[2];
  const double m = lab[0] - 0.1055613458 * lab[1] - 0.0638541728 * lab[2];
  const double s = lab[0] - 0.0894841775 * lab[1] - 1.2914855480 * lab[2];
  const Vec3 cube(l * l * l, m * m * m, s * s * s);
  return {4.0767416621 * cube[0] - 3.3077115913 * cube[1] + 0.2309699292 * cube[2],
          -1.2684380046 * cube[0] + 2.6097574011 * cube[1] - 0.3413193965 * cube[2],
          -0.0041960863 * cube[0] - 0.7034186147 * cube[1] + 1.7076147010 * cube[2]};
}

/// The colour at u of the way, its chroma kept within what screens show.
Vec3 lab_at(const Way& way, double u) {
  const double lightness = way.first_lightness + (way.last_lightness - way.first_lightness) * u;
  const double hue = (way.first_hue + (way.last_hue - way.first_hue) * u) * M_PI / 180.0;
  const auto lab = [&](double chroma) { return Vec3(lightness, chroma * std::cos(hue), chroma * std::sin(hue)); };
  double low = 0.0, high = (way.first_chroma + (way.last_chroma - way.first_chroma) * u) / kShareOfGamut;
  for (int i = 0; i < 40; ++i) {
    const double chroma = 0.5 * (low + high);
    const Vec3 rgb = linear_rgb(lab(chroma));
    (rgb.minCoeff() >= 0.0 && rgb.maxCoeff() <= 1.0 ? low : high) = chroma;
  }
  return lab(kShareOfGamut * low);
}

Color color_of(const Vec3& lab) {
  const Vec3 rgb = linear_rgb(lab);
  const auto share = [](double v) { return static_cast<float>(to_srgb(std::clamp(v, 0.0, 1.0))); };
  return {share(rgb[0]), share(rgb[1]), share(rgb[2])};
}

/// The way cut into pieces of equal length, which are equal steps to the eye.
std::vector<Color> cut(const Way& way, int count) {
  constexpr int kFine = 2000;
  std::vector<double> length = {0.0};
  for (int i = 1; i <= kFine; ++i)
    length.push_back(
        length.back() +
        (lab_at(way, i / static_cast<double>(kFine)) - lab_at(way, (i - 1) / static_cast<double>(kFine))).norm());
  std::vector<Color> colors;
  for (int k = 0; k < count; ++k) {
    const double wanted = length.back() * k / (count - 1.0);
    const auto at = std::lower_bound(length.begin(), length.end() - 1, wanted) - length.begin();
    colors.push_back(color_of(lab_at(way, at / static_cast<double>(kFine))));
  }
  return colors;
}

std::array<Color, kHeatColors> make_colors(ColorMap map) {
  std::vector<Color> all;
  if (map == ColorMap::balance) {
    constexpr int kHalf = kHeatColors / 2 + 1;  // the middle is in both
    all = cut(kBlue, kHalf);
    const std::vector<Color> other = cut(kRust, kHalf);
    all.insert(all.end(), other.rbegin() + 1, other.rend());
  } else {
    all = cut(map == ColorMap::dusk ? kDusk : map == ColorMap::fire ? kFire : kGray, kHeatColors);
  }
  std::array<Color, kHeatColors> colors;
  std::copy(all.begin(), all.end(), colors.begin());
  return colors;
}

template <ColorMap map>
const std::array<Color, kHeatColors>& made_once() {  // when they are first asked for
  static const std::array<Color, kHeatColors> colors = make_colors(map);
  return colors;
}

}  // namespace

const std::array<Color, kHeatColors>& heat_colors(ColorMap map) {
  switch (map) {
    case ColorMap::fire:
      return made_once<ColorMap::fire>();
    case ColorMap::gray:
      return made_once<ColorMap::gray>();
    case ColorMap::balance:
      return made_once<ColorMap::balance>();
    default:
      return made_once<ColorMap::dusk>();
  }
}

Color heat_color(double t, ColorMap map) {
  const double place = std::clamp(t, 0.0, 1.0) * (kHeatColors - 1);
  const auto& colors = heat_colors(map);
  const auto below = std::min(static_cast<std::size_t>(place), colors.size() - 2);
  return mix(colors[below], colors[below + 1], static_cast<float>(place - static_cast<double>(below)));
}

}  // namespace impinge
