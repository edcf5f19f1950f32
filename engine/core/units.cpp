#include "engine/core/units.hpp"

#include <fmt/format.h>

#include <cmath>

namespace impinge {
namespace {

struct Step {
  double from;  // said in this unit from here on
  Unit unit;
};

constexpr Step kLengths[] = {
    {1e3, {"km", 1e3}}, {0.1, {"m", 1.0}}, {1e-4, {"mm", 1e-3}}, {1e-7, {"µm", 1e-6}}, {0.0, {"nm", 1e-9}}};
constexpr Step kMasses[] = {
    {1e4, {"t", 1e3}}, {0.1, {"kg", 1.0}}, {1e-4, {"g", 1e-3}}, {1e-7, {"mg", 1e-6}}, {0.0, {"µg", 1e-9}}};
constexpr Step kTimes[] = {{7200.0, {"h", 3600.0}}, {120.0, {"min", 60.0}}, {1.0, {"s", 1.0}},
                           {1e-3, {"ms", 1e-3}},    {1e-6, {"µs", 1e-6}},   {0.0, {"ns", 1e-9}}};

template <std::size_t N>
Unit unit_of(const Step (&steps)[N], double value) {
  for (const Step& step : steps)
    if (std::abs(value) >= step.from) return step.unit;
  return steps[N - 1].unit;  // not a number
}

template <std::size_t N>
std::string text_of(const Step (&steps)[N], double value, Unit base) {
  if (value == 0.0 || !std::isfinite(value)) return fmt::format("{:.3g} {}", value, base.name);
  // by the digits that are said: 0.09999 is 0.1 m, and not 100 mm
  const double power = std::pow(10.0, 2.0 - std::floor(std::log10(std::abs(value))));
  const Unit unit = unit_of(steps, std::round(value * power) / power * (1.0 + 1e-12));
  return fmt::format("{:.3g} {}", value / unit.size, unit.name);
}

}  // namespace

Unit length_unit(double metres) { return unit_of(kLengths, metres); }

std::string length_text(double metres) { return text_of(kLengths, metres, {"m", 1.0}); }
std::string mass_text(double kilograms) { return text_of(kMasses, kilograms, {"kg", 1.0}); }
std::string time_text(double seconds) { return text_of(kTimes, seconds, {"s", 1.0}); }

}  // namespace impinge
