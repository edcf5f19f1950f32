#include "viewer/image/label.hpp"

#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>

#include "viewer/image/text_font.hpp"

namespace impinge {

namespace {

/// The letters of one size, as they lie in their atlas.
struct Letters {
  ImFontAtlas atlas;
  unsigned char* alpha = nullptr;
  int width = 0, height = 0;

  explicit Letters(int size) {
    add_text_font(atlas, static_cast<float>(size) / kTextSize);
    atlas.GetTexDataAsAlpha8(&alpha, &width, &height);
  }
  const ImFont& font() const { return *atlas.Fonts[0]; }
};

/// Made when they are first asked for, and kept.
const Letters& letters_of(int scale) {
  static std::mutex mutex;
  static std::map<int, std::unique_ptr<Letters>> made;
  const std::lock_guard lock(mutex);
  std::unique_ptr<Letters>& letters = made[scale];
  if (letters == nullptr) letters = std::make_unique<Letters>(text_height(scale) - 1);
  return *letters;
}

/// Calls `with` for the glyph of each character, and where it begins; returns where the last one ends.
template <class With>
int for_glyphs(const ImFont& font, std::string_view text, const With& with) {
  float x = 0.0f;
  for (const char *at = text.data(), *end = at + text.size(); at < end;) {
    unsigned int character = 0;
    at += std::max(1, ImTextCharFromUtf8(&character, at, end));
    const ImFontGlyph& glyph = *font.FindGlyph(static_cast<ImWchar>(character));
    with(glyph, static_cast<int>(x));
    x += glyph.AdvanceX;
  }
  return static_cast<int>(x);
}

void blend(std::uint8_t* pixel, Rgb colour, int alpha) {
  for (int c = 0; c < 3; ++c)
    pixel[c] = static_cast<std::uint8_t>((pixel[c] * (255 - alpha) + colour[c] * alpha + 127) / 255);
}

}  // namespace

int text_width(std::string_view text, int scale) {
  return for_glyphs(letters_of(scale).font(), text, [](const ImFontGlyph&, int) {});
}

std::string missing_letters(std::string_view text) {
  const ImFont& font = letters_of(1).font();
  std::string missing;
  for (const char *at = text.data(), *end = at + text.size(); at < end;) {
    unsigned int character = 0;
    const int length = std::max(1, ImTextCharFromUtf8(&character, at, end));
    const std::string own(at, at + length);
    at += length;
    const bool is_there = character < ' ' || (character <= IM_UNICODE_CODEPOINT_MAX && character != 0xFFFD &&
                                              font.FindGlyphNoFallback(static_cast<ImWchar>(character)) != nullptr);
    if (!is_there && missing.find(own) == std::string::npos) missing += own;
  }
  return missing;
}

void draw_text(Image& image, int x, int y, std::string_view text, Rgb colour, int scale) {
  const Letters& letters = letters_of(scale);
  for_glyphs(letters.font(), text, [&](const ImFontGlyph& glyph, int from) {
    const int u = static_cast<int>(std::lround(glyph.U0 * static_cast<float>(letters.width))),
              v = static_cast<int>(std::lround(glyph.V0 * static_cast<float>(letters.height)));
    const int left = x + from + static_cast<int>(glyph.X0), top = y + static_cast<int>(glyph.Y0),
              width = static_cast<int>(glyph.X1 - glyph.X0), height = static_cast<int>(glyph.Y1 - glyph.Y0);
    for (int j = std::max(0, -top); j < std::min(height, image.height - top); ++j)
      for (int i = std::max(0, -left); i < std::min(width, image.width - left); ++i)
        blend(image.pixel(left + i, top + j), colour, letters.alpha[(v + j) * letters.width + u + i]);
  });
}

void fill_rectangle(Image& image, int x, int y, int width, int height, Rgb colour) {
  const int x_end = std::min(x + width, image.width), y_end = std::min(y + height, image.height);
  for (int row = std::max(y, 0); row < y_end; ++row)
    for (int column = std::max(x, 0); column < x_end; ++column)
      std::copy(colour.begin(), colour.end(), image.pixel(column, row));
}

void draw_rectangle(Image& image, int x, int y, int width, int height, int thickness, Rgb colour) {
  const int t = std::min({thickness, width, height});
  fill_rectangle(image, x, y, width, t, colour);
  fill_rectangle(image, x, y + height - t, width, t, colour);
  fill_rectangle(image, x, y, t, height, colour);
  fill_rectangle(image, x + width - t, y, t, height, colour);
}

}  // namespace impinge
