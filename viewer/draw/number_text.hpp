// Numbers as people read them in tables: three figures and an SI prefix.
#pragma once

#include <string>
#include <string_view>

#include "engine/core/types.hpp"

namespace impinge {

/// A number in two parts that columns align apart: "-67.3" and "pm".
struct NumberText {
  std::string digits, unit;
  std::string whole() const { return unit.empty() ? digits : digits + " " + unit; }
};

/// With the prefix that leaves one to three figures before the point: 6.73e-11 m is "67.3 pm". A kilogram and more
/// stays in kilograms; a number without a unit, or too small or large for any prefix, has an exponent where it needs one.
NumberText number_text(double value, std::string_view unit, int figures = 3);

/// Without zeros that say nothing, "20 N", "4.905 N", with up to four figures.
std::string round_text(double value, std::string_view unit);

/// A vector in the prefix of its largest component, with as many decimals in each: "-299.0  0.0  641.3 mm".
std::string vector_text(const Vec3& value, std::string_view unit);

}  // namespace impinge
