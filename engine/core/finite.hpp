// Figures that may be no numbers.
#pragma once

#include <cmath>

namespace impinge {

/// The larger of two, where what is no number counts as larger than all: std::max would lose it.
inline double larger(double a, double b) { return a >= b || std::isnan(a) ? a : b; }

}  // namespace impinge
