// LDR-FLIP against values of its authors' own program (FLIP.h of github.com/NVlabs/flip, version 1.6, September 2025),
// computed for these pictures.
#include <catch2/catch.hpp>

#include "engine/core/error.hpp"
#include "tests/support/pictures/pictures.hpp"
#include "viewer/image/flip.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

constexpr int kWidth = 96, kHeight = 64;

/// From whole-number formulas, so that they are the same everywhere.
template <class Paint>
Image painted(Paint paint) {
  Image image(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) paint(x, y, image.pixel(x, y));
  return image;
}

Image gradient() {
  return painted([](int x, int y, std::uint8_t* p) {
    p[0] = static_cast<std::uint8_t>(x * 255 / (kWidth - 1));
    p[1] = static_cast<std::uint8_t>(y * 255 / (kHeight - 1));
    p[2] = static_cast<std::uint8_t>((x + y) * 255 / (kWidth + kHeight - 2));
  });
}

Image disc_at(int center) {
  Image image = plain(kWidth, kHeight);
  draw_disc(image, center, 30, 20);
  return image;
}

Image grains() {
  std::uint32_t state = 12345;
  return painted([&](int, int, std::uint8_t* p) {
    for (int c = 0; c < 3; ++c) {
      state = state * 1664525u + 1013904223u;
      p[c] = static_cast<std::uint8_t>(state >> 24);
    }
  });
}

Image line() {
  Image image = plain(kWidth, kHeight);
  fill_rectangle(image, 20, 25, 40, 1, {255, 230, 60});
  return image;
}

Image all_of(Rgb color) { return plain(kWidth, kHeight, color); }

}  // namespace

TEST_CASE("FLIP agrees with its authors' program") {
  struct Published {
    const char* name;
    Image a, b;
    double mean, center;
  };
  const Published published[] = {
      {"black and white", all_of({0, 0, 0}), all_of({255, 255, 255}), 0.967388, 0.967388},
      {"green and blue, the farthest there are", all_of({0, 255, 0}), all_of({0, 0, 255}), 1.0, 1.0},
      {"gradient and grains", gradient(), grains(), 0.790700, 0.480704},
      {"a disc and the disc one pixel on", disc_at(40), disc_at(41), 0.049385, 0.000311},
      {"a line one pixel thick and none", line(), plain(kWidth, kHeight), 0.045325, 0.071824},
      {"gradient and disc", gradient(), disc_at(40), 0.862427, 0.908327},
      {"grains and nothing", grains(), plain(kWidth, kHeight), 0.905381, 0.957830},
  };
  for (const Published& p : published) {
    INFO(p.name);
    const Flip f = flip(p.a, p.b);
    CHECK(f.mean == Approx(p.mean).margin(1e-4));
    CHECK(f.error[static_cast<std::size_t>(kHeight / 2) * kWidth + kWidth / 2] == Approx(p.center).margin(1e-4));
    CHECK(flip(p.b, p.a).mean == f.mean);
  }
}

TEST_CASE("FLIP is zero for equal pictures, within 0 and 1, and grows with the difference") {
  for (const Image& image : {gradient(), grains(), disc_at(30)}) {
    const Flip f = flip(image, image);
    CHECK(f.mean == 0.0);
    CHECK(*std::max_element(f.error.begin(), f.error.end()) == 0.0f);
  }
  double before = 0.0;
  for (const int by : {1, 2, 4, 8}) {
    const Flip f = flip(disc_at(40), disc_at(40 + by));
    CHECK(f.mean > before);
    before = f.mean;
    CHECK(*std::min_element(f.error.begin(), f.error.end()) >= 0.0f);
    CHECK(*std::max_element(f.error.begin(), f.error.end()) <= 1.0f);
  }
  // from far away black and white pixels in turn are the grey that gives as much light: half of white's, level 188
  const Image checkers =
      painted([](int x, int y, std::uint8_t* p) { std::fill_n(p, 3, static_cast<std::uint8_t>((x + y) % 2 * 255)); });
  const double near = flip(checkers, all_of({188, 188, 188}), 20.0).mean,
               far = flip(checkers, all_of({188, 188, 188}), 200.0).mean;
  CHECK(near > 0.1);
  CHECK(far < 0.25 * near);
  CHECK_THROWS_AS(flip(Image(3, 3), Image(3, 4)), InternalError);
}
