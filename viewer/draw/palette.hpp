// Colours. Bodies take turns through colours that stay apart for colour-blind eyes (after [OkabeIto08]); what a
// mark means has one colour everywhere: in the layers, the legend and the panels.
#pragma once

#include <cstdint>

namespace impinge {

/// sRGB and opacity, 0..1.
struct Color {
  float r = 1.0f, g = 1.0f, b = 1.0f, a = 1.0f;
  friend bool operator==(const Color&, const Color&) = default;
};

constexpr Color hex(std::uint32_t rgb, float alpha = 1.0f) {
  return {static_cast<float>((rgb >> 16) & 255) / 255.0f, static_cast<float>((rgb >> 8) & 255) / 255.0f,
          static_cast<float>(rgb & 255) / 255.0f, alpha};
}
constexpr Color with_alpha(Color c, float alpha) { return {c.r, c.g, c.b, alpha}; }
constexpr Color mix(Color a, Color b, float t) {
  return {a.r + (b.r - a.r) * t, a.g + (b.g - a.g) * t, a.b + (b.b - a.b) * t, a.a + (b.a - a.a) * t};
}

/// The colour of the index-th body (or group), the same in every frame.
Color series_color(int index);
/// The same hue, nearly grey: a body at rest.
Color asleep_color(Color c);

namespace role {
constexpr Color kStatic = hex(0x9aa3ad), kScripted = hex(0xe8e4da), kScriptedStripe = hex(0x5b5f66);
constexpr Color kOpen = hex(0xf2f4f7), kStick = hex(0x35c08e), kSlip = hex(0xffb000);
constexpr Color kNormal = hex(0x56c1f5), kForce = hex(0xff6b3d), kGap = hex(0xff5fb0);
constexpr Color kOverlap = hex(0xff3b3b), kNearTriangle = hex(0xffd23b), kSpin = hex(0xc59bff),
                kMassCenter = hex(0xffffff);
constexpr Color kVelocity = hex(0xf5e663), kAabb = hex(0xa9c7e8), kPair = hex(0xd9a6ff), kTriangle = hex(0xff3b6b);
constexpr Color kFloor = hex(0x3a4048), kLightFloor = hex(0xd3d9e0), kWallEdge = hex(0xdfe6ee),
                kUngrouped = hex(0x8a9099), kNoValue = hex(0xa3a8ae);
constexpr Color kTetrahedron = hex(0xf4f1de), kHeld = hex(0xf2e9ff), kMoved = hex(0xffa23b), kCarried = hex(0x9be7d0),
                kOutside = hex(0xff5fb0), kAttachment = hex(0xffe14d), kPull = hex(0xb8f23c);
constexpr Color kAxisX = hex(0xe8604c), kAxisY = hex(0x5fbf4a), kAxisZ = hex(0x4c8df0);
constexpr Color kOutline = hex(0x0d1014), kInk = hex(0xf2f4f7);
}  // namespace role

/// Of the plots in the timeline, which take turns; apart for colour-blind eyes too.
constexpr std::uint32_t kPlotInks[] = {0x56b4e9, 0xe69f00, 0x2fbf93, 0xf0e442, 0xcc79a7, 0xd9dee6};

}  // namespace impinge
