#include "viewer/image/text_font.hpp"

#include <imgui.h>
#include <imgui_freetype.h>

#include <span>

namespace impinge {

std::span<const unsigned char> roboto_font();

void add_text_font(ImFontAtlas& atlas, float scale) {
  // Latin with its extensions, Greek, Cyrillic, punctuation, super- and subscripts, currency, arrows, operators
  static const ImWchar kRanges[] = {0x20, 0x17f, 0x370, 0x45f, 0x2010, 0x20bf, 0x2190, 0x2193, 0x2200, 0x2265, 0};
  const std::span<const unsigned char> bytes = roboto_font();
  ImFontConfig config;
  config.FontDataOwnedByAtlas = false;
  config.OversampleH = config.OversampleV = 1;
  config.PixelSnapH = true;
  // stems stay where the drawing has them, heights are snapped to pixels: sharp lines, even spaces
  atlas.FontBuilderIO = ImGuiFreeType::GetBuilderForFreeType();
  atlas.FontBuilderFlags = ImGuiFreeTypeBuilderFlags_LightHinting;
  atlas.AddFontFromMemoryTTF(const_cast<unsigned char*>(bytes.data()), static_cast<int>(bytes.size()),
                             kTextSize * scale, &config, kRanges);
  atlas.Flags |= ImFontAtlasFlags_NoMouseCursors;
}

}  // namespace impinge
