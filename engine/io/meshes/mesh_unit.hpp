// Units of length by their names.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace impinge {

/// Metres of a unit: m, mm, cm, dm, km, um, inch, foot, yard, mile; nothing for another word.
std::optional<double> metres_of(std::string_view unit);
/// All of them, with commas.
std::string unit_names();
/// What a length that no asset has suggests of a file that doesn't say its unit: "is it in ...?"; "" for one that it may
/// have. `longest`: metres, as if the file's numbers were.
std::string unit_question(double longest);

}  // namespace impinge
