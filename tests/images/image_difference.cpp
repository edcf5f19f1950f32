#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdlib>

#include "engine/core/error.hpp"
#include "tests/support/pictures/pictures.hpp"
#include "viewer/image/difference.hpp"

using namespace impinge;
using namespace impinge::test;
using Catch::Matchers::Contains;

namespace {

/// A thing or two on a plain ground, as a debugger's frame has them.
Image scene(double dx = 0) {
  Image image = plain(640, 360);
  draw_disc(image, 200 + dx, 180, 90);
  draw_disc(image, 420 + dx, 200, 70, {80, 160, 220});
  return image;
}

void dot(Image& image, int x, int y) {
  for (int c = 0; c < 3; ++c) image.pixel(x, y)[c] = static_cast<std::uint8_t>(255 - image.pixel(x, y)[c]);
}

/// 1 pixel thick, `length` pixels long, with a head of 2 x 3.
void arrow(Image& image, int x, int y, int length) {
  for (int k = 0; k < length; ++k) fill_rectangle(image, x + k, y + k / 2, 1, 1, {255, 230, 60});
}

}  // namespace

TEST_CASE("Equal pictures are identical") {
  const Difference d = compare(scene(), scene());
  CHECK(d.same);
  CHECK(d.identical);
  CHECK(d.differing == 0);
  CHECK(d.max_level == 0);
  CHECK(d.compared == 640 * 360);
  CHECK(d.worst_window == 0);
  CHECK_THAT(d.reason, Contains("identical"));
  CHECK(compare(Image(), Image()).identical);
}

TEST_CASE("What renderers of other machines do passes: small levels anywhere, a few pixels far apart") {
  const Image a = scene();
  Image b = a;
  Random random(11);
  for (auto& value : b.rgb) value = static_cast<std::uint8_t>(value + random.below(7) - 3);
  Difference d = compare(a, b);
  CHECK(d.same);
  CHECK_FALSE(d.identical);
  CHECK(d.differing == 0);
  CHECK(d.max_level == 3);

  Image large = plain(1280, 720);
  draw_disc(large, 640, 360, 250);
  Image moved = large;
  for (int k = 0; k < 20; ++k) dot(moved, 50 + 60 * k, 30 + (k * 211) % 660);
  d = compare(large, moved);
  CHECK(d.same);
  CHECK(d.differing == 20);
  CHECK(d.allowed == 37);
  CHECK(d.worst_window == 1);
  CHECK_THAT(d.reason, Contains("same: 20 of 921600"));

  // twice as many are too many, though no two stand together
  for (int k = 0; k < 20; ++k) dot(moved, 70 + 60 * k, 33 + (k * 211) % 640);
  d = compare(large, moved);
  CHECK_FALSE(d.same);
  CHECK(d.differing == 40);
  CHECK(d.worst_window <= 6);
}

TEST_CASE("One level above the tolerance counts, at the tolerance it doesn't") {
  const Image a = scene();
  for (const int tolerance : {0, 3, 20}) {
    Image b = a;
    for (int k = 0; k < 50; ++k)
      b.pixel(190 + k, 180)[1] = static_cast<std::uint8_t>(a.pixel(190 + k, 180)[1] + tolerance);
    DifferenceSettings settings;
    settings.tolerance = tolerance;
    INFO("tolerance " << tolerance);
    CHECK(compare(a, b, settings).same);
    for (int k = 0; k < 50; ++k) ++b.pixel(190 + k, 180)[1];
    const Difference d = compare(a, b, settings);
    CHECK_FALSE(d.same);
    CHECK(d.differing == 50);
    CHECK(d.max_level == tolerance + 1);
    CHECK(d.box == std::array<int, 4>{190, 180, 50, 1});
    CHECK(d.worst_window == 16);
    CHECK(d.worst_at == std::array<int, 2>{190, 165});
  }
}

TEST_CASE("A shape moved by one pixel is caught, and so is a small one") {
  CHECK_FALSE(compare(scene(), scene(1)).same);
  for (const double radius : {2.0, 4.0, 10.0, 40.0}) {
    Image a = plain(1280, 720), b = a;
    draw_disc(a, 300, 300, radius);
    draw_disc(b, 301, 300, radius);
    INFO("radius " << radius);
    CHECK_FALSE(compare(a, b).same);
    CHECK_FALSE(compare(b, a).same);
  }
}

TEST_CASE("A missing arrow of 30 pixels is caught in a picture that may differ in 37") {
  Image a = plain(1280, 720);
  draw_disc(a, 640, 360, 250);
  Image b = a;
  arrow(a, 620, 330, 30);
  const Difference d = compare(a, b);
  CHECK(d.differing == 30);
  CHECK(d.differing <= d.allowed);
  CHECK(d.worst_window == 16);
  CHECK_FALSE(d.same);
  CHECK_THAT(d.reason, Contains("different: 30 of 921600") && Contains("16 in the 16 x 16 window"));
}

TEST_CASE("Seven pixels in a window are too many, six are not, wherever the window stands") {
  const Image a = scene();
  for (const auto& [x, y] : {std::pair{0, 0}, {300, 170}, {624, 344}, {9, 331}}) {
    Image b = a;
    INFO("window at " << x << ", " << y);
    for (int k = 0; k < 6; ++k) dot(b, x + (k * 3) % 16, y + (k * 7) % 16);
    CHECK(compare(a, b).worst_window == 6);
    CHECK(compare(a, b).same);
    dot(b, x + 15, y + 15);
    CHECK(compare(a, b).worst_window == 7);
    CHECK_FALSE(compare(a, b).same);
    for (int k = 0; k < 3; ++k) dot(b, x + 1 + k, y + 11);
    CHECK(compare(a, b).differing == 10);
    CHECK_FALSE(compare(a, b).same);
  }
}

TEST_CASE("The fullest window is the one that counting every window finds") {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    Random random(seed);
    const int width = 1 + random.below(60), height = 1 + random.below(60), window = 1 + random.below(20);
    const Image a(width, height);
    Image b = a;
    const int dots = 1 + random.below(80);
    for (int k = 0; k < dots; ++k) b.pixel(random.below(width), random.below(height))[random.below(3)] = 200;
    int most = 0, total = 0;
    const auto differs = [&](int x, int y) { return !std::equal(a.pixel(x, y), a.pixel(x, y) + 3, b.pixel(x, y)); };
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        total += differs(x, y);
        int count = 0;
        for (int j = y; j < std::min(y + window, height); ++j)
          for (int i = x; i < std::min(x + window, width); ++i) count += differs(i, j);
        most = std::max(most, count);
      }
    DifferenceSettings settings;
    settings.window = window;
    const Difference d = compare(a, b, settings);
    INFO("seed " << seed << ": " << width << " x " << height << ", window " << window);
    CHECK(d.worst_window == most);
    CHECK(d.differing == total);
    // the place it names does hold that many
    int there = 0;
    for (int j = d.worst_at[1]; j < std::min(d.worst_at[1] + window, height); ++j)
      for (int i = d.worst_at[0]; i < std::min(d.worst_at[0] + window, width); ++i) there += differs(i, j);
    CHECK(there == most);
  }
}

TEST_CASE("An empty picture is not the same as a small drawing") {
  // six pixels, far apart in a megapixel: both other limits would let them vanish
  const Image empty = plain(1280, 720);
  Image drawing = empty;
  for (int k = 0; k < 6; ++k) dot(drawing, 100 + 200 * k, 100 + 100 * k);
  Difference d = compare(drawing, empty);
  CHECK(d.drawn == 6);
  CHECK(d.share_of_drawn == 1.0);
  CHECK(d.allowed == 0);
  CHECK(d.worst_window == 1);
  CHECK_FALSE(d.same);
  CHECK_FALSE(compare(empty, drawing).same);
  // nothing drawn on two grounds
  d = compare(plain(300, 200, {0, 0, 0}), plain(300, 200, {9, 9, 9}));
  CHECK_FALSE(d.same);
  CHECK(d.differing == 60000);
}

TEST_CASE("The background is the corners' commonest colour, though panels cover three of them") {
  Image a = plain(400, 300);
  fill_rectangle(a, 0, 0, 80, 300, {90, 90, 90});       // both left corners
  fill_rectangle(a, 300, 0, 100, 40, {120, 120, 120});  // the upper right one
  const Difference d = compare(a, a);
  CHECK(d.drawn == 80 * 300 + 100 * 40);
}

TEST_CASE("Black pixels of a mask are left out") {
  const Image a = scene();
  Image b = a, mask = plain(640, 360, {255, 255, 255});
  fill_rectangle(b, 100, 20, 60, 20, {255, 255, 255});
  fill_rectangle(mask, 96, 16, 70, 30, {0, 0, 0});
  CHECK_FALSE(compare(a, b).same);
  Difference d = compare(a, b, {}, &mask);
  CHECK(d.same);
  CHECK(d.identical);
  CHECK(d.compared == 640 * 360 - 70 * 30);
  fill_rectangle(b, 300, 100, 4, 4, {255, 255, 255});
  d = compare(a, b, {}, &mask);
  CHECK_FALSE(d.same);
  CHECK(d.differing == 16);
  CHECK(d.box == std::array<int, 4>{300, 100, 4, 4});
  const Image small(10, 10);
  CHECK_THROWS_AS(compare(a, b, {}, &small), InputError);
}

TEST_CASE("Pictures of two sizes differ, and the reason gives both") {
  const Difference d = compare(plain(640, 360), plain(360, 640));
  CHECK_FALSE(d.same);
  CHECK_FALSE(d.identical);
  CHECK_THAT(d.reason, Contains("640 x 360") && Contains("360 x 640"));
  const Image panels = difference_panels(plain(640, 360), plain(360, 640), d);
  CHECK(panels.width > 3 * 640);
  CHECK(panels.height > 640);
}

TEST_CASE("The panels show both pictures untouched and mark what differs") {
  const Image a = scene();
  Image b = a;
  dot(b, 50, 60);
  fill_rectangle(b, 400, 50, 30, 3, {255, 255, 255});
  const Difference d = compare(a, b);
  const Image panels = difference_panels(a, b, d);
  REQUIRE(panels.width == 3 * 640 + 4 * 8);
  const int top = text_height(2) + 2 * 8;
  REQUIRE(panels.height > top + 360);
  // the frame runs outside the window, so rows above it and the window itself are as they were
  int unlike_a = 0, unlike_b = 0, marked = 0;
  for (int y = 0; y < 360; ++y)
    for (int x = 0; x < 640; ++x) {
      const auto in_frame = [&](int grow) {
        return x >= d.worst_at[0] - grow && x < d.worst_at[0] + 16 + grow && y >= d.worst_at[1] - grow &&
               y < d.worst_at[1] + 16 + grow;
      };
      const std::uint8_t* third = panels.pixel(8 + 2 * 648 + x, top + y);
      marked += third[0] == 255 && third[2] == 0;
      if (in_frame(2) && !in_frame(0)) continue;
      unlike_a += !std::equal(a.pixel(x, y), a.pixel(x, y) + 3, panels.pixel(8 + x, top + y));
      unlike_b += !std::equal(b.pixel(x, y), b.pixel(x, y) + 3, panels.pixel(8 + 648 + x, top + y));
    }
  CHECK(unlike_a == 0);
  CHECK(unlike_b == 0);
  CHECK(d.differing == 91);
  // all but those that the frame's two vertical strokes cover
  CHECK(marked >= 91 - 2 * 2 * 3);
  CHECK(marked <= 91);
  // small pictures are enlarged by whole factors
  CHECK(difference_panels(plain(64, 48), plain(64, 48), compare(plain(64, 48), plain(64, 48))).width ==
        3 * 320 + 4 * 8);
}
