#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include "engine/core/error.hpp"
#include "tests/support/pictures/pictures.hpp"
#include "tests/support/program/temp_folder.hpp"
#include "viewer/image/contact_sheet.hpp"
#include "viewer/image/png.hpp"

using namespace impinge;
using namespace impinge::test;
using Catch::Matchers::Contains;

namespace {

/// Frame k is flat, of a colour that says k.
Rgb colour_of(int k) { return {static_cast<std::uint8_t>(100 + k), static_cast<std::uint8_t>(3 * k), 200}; }

std::vector<std::filesystem::path> flat_frames(const TempFolder& folder, int count, int width, int height) {
  std::vector<std::filesystem::path> frames;
  for (int k = 0; k < count; ++k) {
    frames.push_back(folder.path() / fmt::format("{:06}.png", k));
    write_png(frames.back(), plain(width, height, colour_of(k)));
  }
  return frames;
}

bool flat(const Image& image, int x, int y, int width, int height, Rgb colour) {
  for (int j = y; j < y + height; ++j)
    for (int i = x; i < x + width; ++i)
      if (!std::equal(colour.begin(), colour.end(), image.pixel(i, j))) return false;
  return true;
}

}  // namespace

TEST_CASE("Reducing a picture takes each area's mean") {
  // against the integral of the piecewise constant picture, sampled where its pieces are constant
  for (const auto& [from_w, from_h, to_w, to_h] :
       {std::array{12, 8, 4, 2}, {10, 9, 4, 6}, {7, 5, 7, 5}, {13, 11, 1, 1}, {64, 3, 5, 3}}) {
    const Image image = noise(from_w, from_h, 3);
    const Image small = reduce_image(image, to_w, to_h);
    REQUIRE(small.width == to_w);
    REQUIRE(small.height == to_h);
    double worst = 0;
    for (int y = 0; y < to_h; ++y)
      for (int x = 0; x < to_w; ++x)
        for (int c = 0; c < 3; ++c) {
          // from_w * to_w equal columns: none straddles a pixel border of either picture
          double sum = 0;
          for (int j = 0; j < from_h; ++j)
            for (int i = 0; i < from_w; ++i) {
              const int column = x * from_w + i, row = y * from_h + j;
              sum += image.pixel(column / to_w, row / to_h)[c];
            }
          worst = std::max(worst, std::abs(sum / (from_w * from_h) - small.pixel(x, y)[c]));
        }
    INFO(from_w << " x " << from_h << " to " << to_w << " x " << to_h);
    CHECK(worst <= 0.5 + 1e-9);
  }
  CHECK(reduce_image(noise(31, 17, 9), 31, 17) == noise(31, 17, 9));
  CHECK_THROWS_AS(reduce_image(plain(4, 4), 5, 4), InternalError);
  CHECK_THROWS_AS(reduce_image(plain(4, 4), 0, 4), InternalError);
}

TEST_CASE("A contact sheet holds evenly chosen frames in a grid, the first and the last included") {
  const TempFolder folder;
  const auto frames = flat_frames(folder, 50, 64, 36);
  struct Case {
    int columns, max_frames;
    std::vector<int> shown;
    int grid_columns, grid_rows;
  };
  const Case cases[] = {{4, 8, {0, 7, 14, 21, 28, 35, 42, 49}, 4, 2},
                        {3, 8, {0, 7, 14, 21, 28, 35, 42, 49}, 3, 3},
                        {5, 2, {0, 49}, 2, 1},
                        {5, 1, {0}, 1, 1}};
  for (const Case& c : cases) {
    INFO(c.columns << " columns, at most " << c.max_frames);
    const Image sheet = make_contact_sheet(frames, c.columns, c.max_frames, 32);
    const int line = text_height(), cell_width = 32 + 8, cell_height = 18 + 4 + line + 8;
    REQUIRE(sheet.width == 8 + c.grid_columns * cell_width);
    REQUIRE(sheet.height == 8 + c.grid_rows * cell_height);
    for (std::size_t k = 0; k < c.shown.size(); ++k) {
      const int x = 8 + static_cast<int>(k) % c.grid_columns * cell_width;
      const int y = 8 + static_cast<int>(k) / c.grid_columns * cell_height;
      CHECK(flat(sheet, x, y, 32, 18, colour_of(c.shown[k])));
      // the label: the number's digits drawn on the paper's colour
      Image label = plain(32 + 8, line, {18, 20, 24}), expected = label;
      for (int j = 0; j < line; ++j) std::copy_n(sheet.pixel(x, y + 18 + 4 + j), 3 * 40, label.pixel(0, j));
      // of which there is room for the last ones
      std::string number = fmt::format("{:06}", c.shown[k]);
      while (text_width(number) > 32) number.erase(0, 1);
      REQUIRE(number.size() >= 2);
      draw_text(expected, 0, 0, number, {225, 225, 225});
      CHECK(label == expected);
    }
    // the dark margin
    CHECK(flat(sheet, 0, 0, sheet.width, 8, {18, 20, 24}));
    CHECK(flat(sheet, 0, 0, 8, sheet.height, {18, 20, 24}));
  }
  // all frames when there are no more, each once; never enlarged
  const Image all = make_contact_sheet(frames, 10, 200, 1000);
  CHECK(all.width == 8 + 10 * (64 + 8));
  CHECK(all.height == 8 + 5 * (36 + 4 + text_height() + 8));
  CHECK(flat(all, 8 + 9 * 72, 8 + 4 * (36 + 4 + text_height() + 8), 64, 36, colour_of(49)));
}

TEST_CASE("A contact sheet says which frame it can't use") {
  const TempFolder folder;
  auto frames = flat_frames(folder, 3, 40, 20);
  write_png(frames[1], plain(20, 40));
  CHECK_THROWS_WITH(make_contact_sheet(frames, 3, 3), Contains(frames[1].string()) && Contains("20 x 40"));
  std::filesystem::remove(frames[2]);
  write_png(frames[1], plain(40, 20));
  CHECK_THROWS_WITH(make_contact_sheet(frames, 3, 3), Contains(frames[2].string()));
  CHECK_THROWS_AS(make_contact_sheet({}, 3, 3), InputError);
  CHECK_THROWS_AS(make_contact_sheet(frames, 0, 3), InternalError);
}

TEST_CASE("Captions are clipped at the picture's edge and stay in their line, and letters have shapes of their own") {
  Image image(20, 12);
  draw_text(image, -7, -3, "MMMMMMMM", {255, 255, 255}, 2);
  draw_text(image, 15, 8, "MM", {255, 255, 255});
  CHECK(std::count(image.rgb.begin(), image.rgb.end(), 255) > 0);
  for (const int scale : {1, 2, 3}) {
    CAPTURE(scale);
    CHECK(text_height(scale) == 7 + 6 * scale);
    CHECK(text_width("", scale) == 0);
    CHECK(text_width("abc", scale) == text_width("a", scale) + text_width("b", scale) + text_width("c", scale));
    for (char c = '0'; c <= '9'; ++c) CHECK(text_width(std::string(1, c), scale) == text_width("0", scale));
    CHECK(text_width("\u00e9", scale) == text_width("e", scale));  // one character in two bytes
    std::vector<Image> shapes;
    for (char c = '!'; c <= '~'; ++c) {
      CAPTURE(c);
      const int width = text_width(std::string(1, c), scale), height = text_height(scale);
      Image shape(width + 8, height + 8);
      draw_text(shape, 4, 4, std::string(1, c), {255, 255, 255}, scale);
      CHECK_FALSE(flat(shape, 0, 0, shape.width, shape.height, {0, 0, 0}));
      CHECK(flat(shape, 0, 0, shape.width, 4, {0, 0, 0}));
      CHECK(flat(shape, 0, 4 + height, shape.width, 4, {0, 0, 0}));
      CHECK(flat(shape, 0, 0, 2, shape.height, {0, 0, 0}));
      CHECK(flat(shape, width + 6, 0, 2, shape.height, {0, 0, 0}));
      if (c == 'I' || c == '|') continue;  // strokes that few fonts tell from an l
      CHECK(std::find(shapes.begin(), shapes.end(), shape) == shapes.end());
      shapes.push_back(shape);
    }
  }
}
