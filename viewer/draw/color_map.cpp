#include "viewer/draw/color_map.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/core/types.hpp"

namespace impinge {
namespace {

constexpr double kDarkest = 0.34, kBrightest = 0.93;   // OKLab lightness
constexpr double kFirstHue = 295.0, kLastHue = 105.0;  // degrees: violet, blue, teal, green, yellow
constexpr double kChroma = 0.12, kShareOfGamut = 0.94;

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

/// The colour at u of the path, its chroma kept within what screens show.
Vec3 lab_at(double u) {
  const double lightness = kDarkest + (kBrightest - kDarkest) * u;
  const double hue = (kFirstHue + (kLastHue - kFirstHue) * u) * M_PI / 180.0;
  const auto lab = [&](double chroma) { return Vec3(lightness, chroma * std::cos(hue), chroma * std::sin(hue)); };
  double low = 0.0, high = kChroma / kShareOfGamut;
  for (int i = 0; i < 40; ++i) {
    const double chroma = 0.5 * (low + high);
    const Vec3 rgb = linear_rgb(lab(chroma));
    (rgb.minCoeff() >= 0.0 && rgb.maxCoeff() <= 1.0 ? low : high) = chroma;
  }
  return lab(kShareOfGamut * low);
}

std::array<Color, kHeatColors> make_colors() {
  // the path cut into pieces of equal length, which are equal steps to the eye
  constexpr int kFine = 2000;
  std::vector<double> length = {0.0};
  for (int i = 1; i <= kFine; ++i)
    length.push_back(length.back() +
                     (lab_at(i / static_cast<double>(kFine)) - lab_at((i - 1) / static_cast<double>(kFine))).norm());
  std::array<Color, kHeatColors> colors;
  for (int k = 0; k < kHeatColors; ++k) {
    const double wanted = length.back() * k / (kHeatColors - 1.0);
    const auto at = std::lower_bound(length.begin(), length.end() - 1, wanted) - length.begin();
    const Vec3 rgb = linear_rgb(lab_at(at / static_cast<double>(kFine)));
    const auto share = [](double v) { return static_cast<float>(to_srgb(std::clamp(v, 0.0, 1.0))); };
    colors[static_cast<std::size_t>(k)] = {share(rgb[0]), share(rgb[1]), share(rgb[2])};
  }
  return colors;
}

}  // namespace

const std::array<Color, kHeatColors>& heat_colors() {
  static const std::array<Color, kHeatColors> colors = make_colors();
  return colors;
}

Color heat_color(double t) {
  const double place = std::clamp(t, 0.0, 1.0) * (kHeatColors - 1);
  const auto below = std::min(static_cast<std::size_t>(place), heat_colors().size() - 2);
  return mix(heat_colors()[below], heat_colors()[below + 1], static_cast<float>(place - static_cast<double>(below)));
}

}  // namespace impinge
