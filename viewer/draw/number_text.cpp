#include "viewer/draw/number_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace impinge {
namespace {

constexpr const char* kPrefixes[] = {"y", "z", "a", "f", "p", "n", "µ", "m", "",
                                     "k", "M", "G", "T", "P", "E", "Z", "Y"};
constexpr int kNone = 8;  // where no prefix stands

/// "6.7e-8": of an exponent only what is needed.
std::string with_exponent(double value, int figures) {
  std::string text = fmt::format("{:.{}g}", value, figures);
  const std::size_t e = text.find('e');
  if (e == std::string::npos) return text;
  std::size_t zeros = e + 2;
  while (zeros + 1 < text.size() && text[zeros] == '0') ++zeros;
  return text.substr(0, e + 1) + (text[e + 1] == '-' ? "-" : "") + text.substr(zeros);
}

struct Prefix {
  int thousands = 0;  // powers of a thousand that it stands for
  int decimals = 0;   // that so many figures have behind the point
  std::string name;
};

/// Of a number that is rounded before its prefix is chosen: 999.96 mm is 1.00 m. None where there is no such prefix.
std::optional<Prefix> prefix_of(double value, int figures) {
  const std::string text = fmt::format("{:.{}e}", std::abs(value), figures - 1);
  const int exponent = std::stoi(text.substr(text.find('e') + 1));
  Prefix prefix;
  prefix.thousands = exponent >= 0 ? exponent / 3 : (exponent - 2) / 3;
  prefix.decimals = std::max(0, figures - 1 - (exponent - 3 * prefix.thousands));
  const int place = prefix.thousands + kNone;
  if (place < 0 || place >= static_cast<int>(std::size(kPrefixes))) return std::nullopt;
  prefix.name = kPrefixes[place];
  return prefix;
}

double scaled(double value, const Prefix& prefix) {
  // one rounding: powers of ten up to 1e22 are exact
  const double power = std::pow(10.0, 3 * std::abs(prefix.thousands));
  return prefix.thousands < 0 ? value * power : value / power;
}

}  // namespace

NumberText number_text(double value, std::string_view unit, int figures) {
  if (value == 0.0) return {"0", std::string(unit)};  // no -0
  if (!std::isfinite(value) || unit.empty()) return {with_exponent(value, figures), std::string(unit)};
  if (unit.starts_with("kg ")) return {with_exponent(value, figures), std::string(unit)};  // it has a prefix
  const bool is_mass = unit == "kg";
  if (is_mass && std::abs(value) >= 1.0) return {with_exponent(value, figures + 1), "kg"};  // nobody says megagram
  const double number = is_mass ? 1e3 * value : value;
  const std::optional<Prefix> prefix = prefix_of(number, figures);
  if (!prefix) return {with_exponent(value, figures), std::string(unit)};
  return {fmt::format("{:.{}f}", scaled(number, *prefix), prefix->decimals),
          prefix->name + (is_mass ? "g" : std::string(unit))};
}

std::string round_text(double value, std::string_view unit) {
  NumberText text = number_text(value, unit, 4);
  if (text.digits.find('.') != std::string::npos && text.digits.find('e') == std::string::npos) {
    text.digits.erase(text.digits.find_last_not_of('0') + 1);
    if (text.digits.ends_with('.')) text.digits.pop_back();
  }
  return text.whole();
}

std::string vector_text(const Vec3& value, std::string_view unit) {
  const double largest = value.cwiseAbs().maxCoeff();
  std::optional<Prefix> prefix;
  if (unit.empty())
    prefix = Prefix{0, 3, ""};
  else if (largest > 0.0 && std::isfinite(largest))
    prefix = prefix_of(largest, 4);
  std::string text;
  for (int k = 0; k < 3; ++k)
    text += (k > 0 ? "  " : "") + (prefix ? fmt::format("{:.{}f}", scaled(value[k], *prefix) + 0.0, prefix->decimals)
                                          : with_exponent(value[k] + 0.0, 3));
  if (unit.empty()) return text;
  return text + " " + (prefix ? prefix->name : "") + std::string(unit);
}

}  // namespace impinge
