#include <catch2/catch.hpp>

#include "engine/core/types.hpp"
#include "viewer/draw/color_map.hpp"
#include "viewer/draw/palette.hpp"

using namespace impinge;

namespace {

double linear(double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); }
Vec3 linear(const Color& c) { return {linear(c.r), linear(c.g), linear(c.b)}; }

/// CIELAB under D65: another space than the one that the colours were made in.
Vec3 lab(const Vec3& rgb) {
  Mat3 to_xyz;
  to_xyz << 0.4124564, 0.3575761, 0.1804375, 0.2126729, 0.7151522, 0.0721750, 0.0193339, 0.1191920, 0.9503041;
  const Vec3 xyz = (to_xyz * rgb).cwiseQuotient(Vec3(0.95047, 1.0, 1.08883));
  const auto f = [](double t) { return t > 216.0 / 24389.0 ? std::cbrt(t) : (24389.0 / 27.0 * t + 16.0) / 116.0; };
  return {116.0 * f(xyz[1]) - 16.0, 500.0 * (f(xyz[0]) - f(xyz[1])), 200.0 * (f(xyz[1]) - f(xyz[2]))};
}

// linear RGB as normal eyes and dichromats see it ([Machado09], severity 1): protan, deutan,
// tritan
std::array<Mat3, 4> all_eyes() {
  std::array<Mat3, 4> eyes;
  eyes[0].setIdentity();
  eyes[1] << 0.152286, 1.052583, -0.204868, 0.114503, 0.786281, 0.099216, -0.003882, -0.048116, 1.051998;
  eyes[2] << 0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.011820, 0.042940, 0.968881;
  eyes[3] << 1.255528, -0.076749, -0.178779, -0.078411, 0.930809, 0.147602, 0.004733, 0.691367, 0.303900;
  return eyes;
}

/// Hardly any colour of its own.
bool at_middle_is_pale() {
  const Vec3 middle = lab(linear(heat_color(0.5, ColorMap::balance)));
  return middle[0] > 90.0 && std::hypot(middle[1], middle[2]) < 3.0;
}

Vec3 seen(const Mat3& eye, const Color& c) { return lab((eye * linear(c)).cwiseMax(0.0).cwiseMin(1.0)); }

}  // namespace

TEST_CASE("the colours of quantities grow in lightness by even steps, for colour-blind eyes too") {
  for (const ColorMap map : {ColorMap::dusk, ColorMap::fire, ColorMap::gray})
    for (const Mat3& eye : all_eyes()) {
      CAPTURE(static_cast<int>(map), eye);
      double previous = -1.0, smallest = 1e9, largest = 0.0;
      Vec3 before = Vec3::Zero();
      for (int k = 0; k < kHeatColors; ++k) {
        const Vec3 now = seen(eye, heat_colors(map)[static_cast<std::size_t>(k)]);
        CHECK(now[0] > previous + 1.2);
        if (k > 0) {
          const double step = (now - before).norm();
          smallest = std::min(smallest, step), largest = std::max(largest, step);
        }
        previous = now[0], before = now;
      }
      CHECK(smallest > 1.5);  // just noticeable is about 1
      CHECK(largest < (eye.isIdentity() ? 2.0 : 3.5) * smallest);
    }
  for (const ColorMap map : {ColorMap::dusk, ColorMap::fire, ColorMap::gray})
    CHECK(lab(linear(heat_color(1.0, map)))[0] - lab(linear(heat_color(0.0, map)))[0] > 60.0);
}

TEST_CASE(
    "the colours of what has a sign grow evenly darker from their middle, to ends that no eye takes for each other") {
  constexpr int kMiddle = kHeatColors / 2;
  for (const Mat3& eye : all_eyes()) {
    CAPTURE(eye);
    const auto at = [&](int k) { return seen(eye, heat_colors(ColorMap::balance)[static_cast<std::size_t>(k)]); };
    for (int k = 0; k < kMiddle; ++k) {
      CHECK(at(k)[0] + 1.2 < at(k + 1)[0]);
      CHECK(at(kHeatColors - 1 - k)[0] + 1.2 < at(kHeatColors - 2 - k)[0]);
    }
    CHECK((at(0) - at(kHeatColors - 1)).norm() > 45.0);
    CHECK((at(kMiddle / 2) - at(kHeatColors - 1 - kMiddle / 2)).norm() > 15.0);
  }
  CHECK(at_middle_is_pale());
}

TEST_CASE("colours between two of the table are between them, and beyond its ends the ends") {
  const auto& table = heat_colors();
  for (int k = 0; k + 1 < kHeatColors; ++k) {
    const Color &a = table[static_cast<std::size_t>(k)], &b = table[static_cast<std::size_t>(k + 1)];
    CHECK(heat_color(static_cast<double>(k) / (kHeatColors - 1)) == a);
    CHECK(heat_color((k + 0.5) / (kHeatColors - 1)).g == Approx(0.5 * (a.g + b.g)).margin(1e-6));
  }
  CHECK(heat_color(-3.0) == table.front());
  CHECK(heat_color(7.0) == table.back());
}

TEST_CASE("plots and states of contacts are told apart by colour-blind eyes, and from what is behind them") {
  std::vector<Color> plots = {hex(0x232931)}, states = {hex(0x1b1f25), role::kOpen, role::kStick, role::kSlip};
  for (const std::uint32_t ink : kPlotInks) plots.push_back(hex(ink));
  for (const Mat3& eye : all_eyes())
    for (const auto& [colors, least] : {std::pair(plots, 9.0), {states, 30.0}})  // just noticeable is about 1
      for (std::size_t i = 0; i < colors.size(); ++i)
        for (std::size_t k = i + 1; k < colors.size(); ++k)
          CHECK((seen(eye, colors[i]) - seen(eye, colors[k])).norm() > least);
}
