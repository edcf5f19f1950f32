// LDR-FLIP: how large the difference between two pictures looks to someone who flips back and forth between them
// [Andersson20]. For information: the verdict is that
// of difference.hpp, since a thin mark that vanishes hardly moves a mean.
#pragma once

#include <vector>

#include "viewer/image/image.hpp"

namespace impinge {

struct Flip {
  double mean = 0.0;         ///< 0: no difference seen, 1: the largest there is
  std::vector<float> error;  ///< of each pixel, row by row
};

/// Symmetric. Pixels per degree of the observer: by default a screen 0.7 m wide with 3840 pixels, seen from 0.7 m.
/// Throws InternalError on pictures of two sizes or without pixels.
Flip flip(const Image& a, const Image& b, double pixels_per_degree = 67.02064327658225);

}  // namespace impinge
