#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "viewer/image/difference.hpp"
#include "viewer/image/label.hpp"

namespace impinge {

namespace {

constexpr Rgb kSheet = {24, 26, 30}, kCaption = {235, 235, 235}, kFrame = {80, 220, 255};
constexpr int kGap = 8, kMinPanelWidth = 320;

/// Each pixel of `image` as a square of `zoom` pixels, its upper left corner at (x, y).
void paste(Image& sheet, int x, int y, const Image& image, int zoom) {
  for (int row = 0; row < image.height * zoom; ++row)
    for (int column = 0; column < image.width * zoom; ++column)
      std::copy_n(image.pixel(column / zoom, row / zoom), 3, sheet.pixel(x + column, y + row));
}

/// From yellow for the least difference that counts to red for the greatest there is.
Rgb heat(int level, int tolerance) {
  const int green = 220 * (255 - level) / std::max(255 - tolerance, 1);
  return {255, static_cast<std::uint8_t>(std::clamp(green, 0, 255)), 0};
}

/// `text` in lines of at most `width` pixels, broken at blanks where there are any.
std::vector<std::string> wrap(std::string text, int width, int scale) {
  std::vector<std::string> lines;
  while (text_width(text, scale) > width) {
    std::size_t room = text.size();
    while (room > 1 && text_width(std::string_view(text).substr(0, room), scale) > width) --room;
    const std::size_t blank = text.rfind(' ', room);
    const bool breaks = blank != std::string::npos && blank > 0;
    lines.push_back(text.substr(0, breaks ? blank : room));
    text.erase(0, breaks ? blank + 1 : room);
  }
  lines.push_back(text);
  return lines;
}

}  // namespace

// over a dim grey A; the surround lets a single pixel be seen
Image difference_overlay(const Image& a, const Image& b, int tolerance, int surround, const Image* mask) {
  Image out(a.width, a.height);
  if (a.width != b.width || a.height != b.height) return out;
  const auto compared = [&](int x, int y) {
    return mask == nullptr || std::any_of(mask->pixel(x, y), mask->pixel(x, y) + 3, [](int c) { return c != 0; });
  };
  const auto for_each = [&](auto&& paint) {
    for (int y = 0; y < a.height; ++y)
      for (int x = 0; x < a.width; ++x)
        if (compared(x, y)) paint(x, y, channel_difference(a.pixel(x, y), b.pixel(x, y)));
  };
  for_each([&](int x, int y, int level) {
    const std::uint8_t* p = a.pixel(x, y);
    const auto grey = static_cast<std::uint8_t>(20 + (2 * p[0] + 5 * p[1] + p[2]) / 8 / 4);
    // tolerated differences are too small to see as they are
    const auto blue = static_cast<std::uint8_t>(level == 0 ? grey : std::min(110 + 40 * level, 255));
    fill_rectangle(out, x, y, 1, 1, {grey, grey, blue});
  });
  for_each([&](int x, int y, int level) {
    if (level > tolerance)
      fill_rectangle(out, x - surround, y - surround, 2 * surround + 1, 2 * surround + 1, {110, 20, 20});
  });
  for_each([&](int x, int y, int level) {
    if (level > tolerance) fill_rectangle(out, x, y, 1, 1, heat(level, tolerance));
  });
  return out;
}

Image difference_panels(const Image& a, const Image& b, const Difference& difference, const Image* mask) {
  const int width = std::max({a.width, b.width, 1}), height = std::max({a.height, b.height, 1});
  const int zoom = std::max(1, kMinPanelWidth / width);
  const int panel = width * zoom, scale = panel >= 900 ? 3 : 2, line = text_height(scale) + kGap / 2;
  const int sheet_width = 3 * panel + 4 * kGap, top = text_height(scale) + 2 * kGap;
  const std::vector<std::string> lines = wrap(difference.reason, sheet_width - 2 * kGap, scale);
  Image sheet(sheet_width, top + height * zoom + kGap + static_cast<int>(lines.size()) * line);
  fill_rectangle(sheet, 0, 0, sheet.width, sheet.height, kSheet);

  const Image third = difference_overlay(a, b, difference.settings.tolerance, zoom > 1 ? 0 : 2, mask);
  const Image* const images[] = {&a, &b, &third};
  const std::string captions[] = {
      fmt::format("A {} x {}", a.width, a.height), fmt::format("B {} x {}", b.width, b.height),
      fmt::format("over {} levels: {}", difference.settings.tolerance, difference.differing)};
  for (int k = 0; k < 3; ++k) {
    const int x = kGap + k * (panel + kGap);
    draw_text(sheet, x, kGap, captions[k], kCaption, scale);
    paste(sheet, x, top, *images[k], zoom);
    if (difference.worst_window == 0) continue;
    // just outside the window, so that it hides none of its pixels
    const int side = difference.settings.window * zoom + 4;
    draw_rectangle(sheet, x + difference.worst_at[0] * zoom - 2, top + difference.worst_at[1] * zoom - 2, side, side, 2,
                   kFrame);
  }
  for (std::size_t k = 0; k < lines.size(); ++k)
    draw_text(sheet, kGap, top + height * zoom + kGap + static_cast<int>(k) * line, lines[k], kCaption, scale);
  return sheet;
}

}  // namespace impinge
