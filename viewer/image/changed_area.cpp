#include "viewer/image/changed_area.hpp"

#include <algorithm>
#include <cstring>

namespace impinge {

PixelArea whole_area(const Image& image) { return {0, 0, image.width, image.height}; }

PixelArea changed_area(const Image& before, const Image& now) {
  if (before.width != now.width || before.height != now.height) return whole_area(now);
  const std::size_t row = std::size_t{3} * now.width;
  const auto differs = [&](int y) { return std::memcmp(before.pixel(0, y), now.pixel(0, y), row) != 0; };
  int top = 0, bottom = now.height;
  while (top < bottom && !differs(top)) ++top;
  while (bottom > top && !differs(bottom - 1)) --bottom;
  std::size_t left = row, right = 0;  // bytes
  for (int y = top; y < bottom; ++y) {
    const std::uint8_t *a = before.pixel(0, y), *b = now.pixel(0, y);
    left = static_cast<std::size_t>(std::mismatch(a, a + left, b).first - a);
    std::size_t end = row;
    while (end > right && a[end - 1] == b[end - 1]) --end;
    right = std::max(right, end);
  }
  if (top == bottom) return {};
  const int x = static_cast<int>(left / 3);
  return {x, top, static_cast<int>((right + 2) / 3) - x, bottom - top};
}

}  // namespace impinge
