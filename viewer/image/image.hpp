// A picture in memory: 8-bit RGB rows, top row first, and how opaque its pixels are where not all are wholly.
#pragma once

#include <cstdint>
#include <vector>

namespace impinge {

struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;    ///< 3 * width * height; a colour is what it is whatever its alpha
  std::vector<std::uint8_t> alpha;  ///< width * height, 0: nothing is there; empty: all 255
  Image() = default;
  Image(int w, int h) : width(w), height(h), rgb(static_cast<std::size_t>(w) * h * 3, 0) {}
  std::uint8_t* pixel(int x, int y) { return rgb.data() + 3 * (static_cast<std::size_t>(y) * width + x); }
  const std::uint8_t* pixel(int x, int y) const { return rgb.data() + 3 * (static_cast<std::size_t>(y) * width + x); }
  friend bool operator==(const Image& l, const Image& r) {
    return l.width == r.width && l.height == r.height && l.rgb == r.rgb && l.alpha == r.alpha;
  }
};

/// By a mask, if there is one: it is black there.
inline bool is_left_out(const Image* mask, std::size_t pixel) {
  if (mask == nullptr) return false;
  const std::uint8_t* rgb = mask->rgb.data() + 3 * pixel;
  return rgb[0] == 0 && rgb[1] == 0 && rgb[2] == 0;
}

}  // namespace impinge
