// The letters of panels and labels: Roboto from Debian's font package, embedded, so that the program needs no font of the
// machine's. Its figures are of one width.
#pragma once

struct ImFontAtlas;

namespace impinge {

/// Height of a line of text, pixels of a picture at scale 1.
inline constexpr float kTextSize = 15.0f;

/// The atlas's one font, drawn for `scale` times that size: crisp, not enlarged.
void add_text_font(ImFontAtlas& atlas, float scale);

}  // namespace impinge
