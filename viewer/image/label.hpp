// Letters in pictures made without OpenGL: captions of difference panels and contact sheets. They are those of panels.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "viewer/image/image.hpp"

namespace impinge {

using Rgb = std::array<std::uint8_t, 3>;

/// Pixels that a line of text takes. Letters are drawn 12 pixels high, with what is above and below them, 18 with `scale`
/// 2, and 6 more with each; one row is left below for parentheses, which reach lower.
int text_width(std::string_view text, int scale = 1);
constexpr int text_height(int scale = 1) { return 7 + 6 * scale; }

/// The characters of a text, UTF-8, that no letter stands for, each once: panels and pictures show them as '?'.
std::string missing_letters(std::string_view text);

/// Draws one line, UTF-8, with its upper left corner at (x, y), clipped to the image.
void draw_text(Image& image, int x, int y, std::string_view text, Rgb colour, int scale = 1);

/// Fills, or draws inwards as a border `thickness` pixels wide, the rectangle [x, x + width) x [y, y + height),
/// clipped.
void fill_rectangle(Image& image, int x, int y, int width, int height, Rgb colour);
void draw_rectangle(Image& image, int x, int y, int width, int height, int thickness, Rgb colour);

}  // namespace impinge
