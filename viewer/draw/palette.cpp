#include "viewer/draw/palette.hpp"

#include <array>

namespace impinge {

Color series_color(int index) {
  // Okabe & Ito's eight without black and yellow (too near to outlines and to slip marks), softened for large areas
  constexpr std::array<Color, 7> kSeries = {hex(0x4f9fd0), hex(0xe08a4a), hex(0x3fa887), hex(0xcf86b0),
                                            hex(0xd8c06a), hex(0x7d8fd6), hex(0xc9645a)};
  constexpr int n = static_cast<int>(kSeries.size());
  const int turn = index < 0 ? 0 : index / n;
  const Color base = kSeries[index < 0 ? 0 : index % n];
  // later turns are lighter or darker, so that neighbours in the list stay apart
  if (turn % 3 == 1) return mix(base, hex(0xffffff), 0.28f);
  if (turn % 3 == 2) return mix(base, hex(0x101418), 0.28f);
  return base;
}

Color asleep_color(Color c) {
  const float grey = 0.3f * c.r + 0.59f * c.g + 0.11f * c.b;
  return mix(c, {0.75f * grey, 0.75f * grey, 0.78f * grey, c.a}, 0.78f);
}

}  // namespace impinge
