// Quantities in the unit that people would say them in: 3.2 µm, 0.25 m, 12 min. For messages and tables that are read;
// files are SI.
#pragma once

#include <string>
#include <string_view>

namespace impinge {

struct Unit {
  std::string_view name;
  double size = 1.0;  ///< of one, SI
};

/// What lengths of about `metres` are said in: nm, µm, mm, m or km; mm from 0.1 mm and m from 0.1 m on.
Unit length_unit(double metres);

/// Three digits and the unit that fits.
std::string length_text(double metres);
std::string mass_text(double kilograms);
std::string time_text(double seconds);

}  // namespace impinge
