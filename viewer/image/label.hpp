// Small fixed letters for pictures made without OpenGL: captions of difference panels and contact sheets.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "viewer/image/image.hpp"

namespace impinge {

using Rgb = std::array<std::uint8_t, 3>;

/// Pixels that a text takes: letters are 5 x 7 with one column between them, times `scale`.
int text_width(std::string_view text, int scale = 1);
inline int text_height(int scale = 1) { return 7 * scale; }

/// Draws one line with its upper left corner at (x, y), clipped to the image. Lower case is drawn as capitals, a
/// character outside ASCII's printable ones, byte by byte, as a box.
void draw_text(Image& image, int x, int y, std::string_view text, Rgb colour, int scale = 1);

/// Fills, or draws inwards as a border `thickness` pixels wide, the rectangle [x, x + width) x [y, y + height),
/// clipped.
void fill_rectangle(Image& image, int x, int y, int width, int height, Rgb colour);
void draw_rectangle(Image& image, int x, int y, int width, int height, int thickness, Rgb colour);

}  // namespace impinge
