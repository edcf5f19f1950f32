// A length, a speed or a time that something is told apart by: as a scene gives it, or, which is the word "auto" there,
// a part of a scale that what it is applied to has. So a scene and its copy at another size need no numbers of their own.
#pragma once

#include <optional>

namespace impinge {

struct Threshold {
  explicit constexpr Threshold(double part_of_scale) : part(part_of_scale) {}
  Threshold& operator=(double value) {
    given = value;
    return *this;
  }

  double at(double scale) const { return given ? *given : part * scale; }

  double part;                  ///< of the scale
  std::optional<double> given;  ///< empty: auto
};

}  // namespace impinge
