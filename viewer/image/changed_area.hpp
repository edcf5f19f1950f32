// Where two pictures differ.
#pragma once

#include "viewer/image/image.hpp"

namespace impinge {

/// A rectangle of a picture, pixels from its upper left corner.
struct PixelArea {
  int x = 0, y = 0, width = 0, height = 0;
  friend bool operator==(const PixelArea&, const PixelArea&) = default;
};

PixelArea whole_area(const Image& image);
/// The smallest rectangle with every pixel that differs; empty where none does. The whole picture where sizes differ.
PixelArea changed_area(const Image& before, const Image& now);

}  // namespace impinge
