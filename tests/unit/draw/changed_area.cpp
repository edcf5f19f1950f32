// Where two pictures differ, against looking at every pixel.
#include <catch2/catch.hpp>

#include <random>

#include "viewer/image/changed_area.hpp"

using namespace impinge;

TEST_CASE("the changed area is the smallest rectangle with all pixels that differ") {
  std::mt19937 random(3);
  for (int k = 0; k < 2000; ++k) {
    const int w = 1 + static_cast<int>(random() % 17), h = 1 + static_cast<int>(random() % 11);
    Image before(w, h);
    for (auto& v : before.rgb) v = static_cast<std::uint8_t>(random());
    Image now = before;
    for (unsigned n = random() % 4; n > 0; --n) now.rgb[random() % now.rgb.size()] ^= 1;
    int left = w, top = h, right = -1, bottom = -1;
    for (int y = 0; y < h; ++y)
      for (int x = 0; x < w; ++x)
        if (!std::equal(before.pixel(x, y), before.pixel(x, y) + 3, now.pixel(x, y)))
          left = std::min(left, x), right = std::max(right, x), top = std::min(top, y), bottom = std::max(bottom, y);
    const PixelArea wanted = right < 0 ? PixelArea{} : PixelArea{left, top, right - left + 1, bottom - top + 1};
    CHECK(changed_area(before, now) == wanted);
  }
  CHECK(changed_area(Image(3, 2), Image(4, 2)) == PixelArea{0, 0, 4, 2});
}
